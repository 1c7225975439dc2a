// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "surface_points.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace caplet::test {

namespace {

using glm::dvec3;

using std::numbers::pi;

using Map = std::function<dvec3(double, double)>;  // of [0, 1]^2, object space

struct Surface {
  std::vector<Map> parts;
  /// Where the emitting side at a point looks, object space, of any length.
  std::function<dvec3(const dvec3&)> outward;
};

std::function<dvec3(const dvec3&)> away_from(const dvec3& center) {
  return [=](const dvec3& p) { return p - center; };
}
std::function<dvec3(const dvec3&)> always(const dvec3& normal) {
  return [=](const dvec3&) { return normal; };
}

dvec3 across(const dvec3& z) {
  return glm::normalize(glm::cross(z, std::abs(z.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
}

dvec3 spherical(double polar, double turn) {
  return {std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar)};
}

/// A solid all of whose surface is seen from `center`, by how far it reaches in a unit direction.
Surface star(const dvec3& center, const std::function<double(const dvec3&)>& reach) {
  const Map map = [=](double u, double v) {
    const dvec3 d = spherical(pi * u, 2 * pi * v);
    return center + reach(d) * d;
  };
  return {{map}, away_from(center)};
}

Surface surface_of(const SphereShape& sphere, const Shape&) {
  return star(dvec3(0), [r = sphere.radius](const dvec3&) { return r; });
}

Surface surface_of(const CapsulesShape& capsules, const Shape&) {
  const dvec3 a(capsules.p0[0]), b(capsules.p1[0]);
  const double ra = capsules.radius0[0], rb = capsules.radius1.empty() ? ra : capsules.radius1[0];
  const dvec3 axis = b - a;
  const double length = glm::length(axis);
  const dvec3 z = length > 0 ? axis / length : dvec3(0, 0, 1), x = across(z), y = glm::cross(z, x);
  // A band of a sphere, from polar angle t0 to t1 against z.
  const auto band = [=](dvec3 at, double r, double t0, double t1) {
    return [=](double u, double v) {
      const dvec3 d = spherical(t0 + u * (t1 - t0), 2 * pi * v);
      return at + r * (d.x * x + d.y * y + d.z * z);
    };
  };
  if (length <= std::abs(ra - rb))
    return ra >= rb ? Surface{{band(a, ra, 0, pi)}, away_from(a)}
                    : Surface{{band(b, rb, 0, pi)}, away_from(b)};
  const double tangent =
      std::acos((ra - rb) / length);  // polar angle of the normals of the common tangent cone
  const Map from = band(a, ra, tangent, tangent), to = band(b, rb, tangent, tangent);
  const Map flank = [=](double u, double v) { return (1 - u) * from(0, v) + u * to(0, v); };
  return {{band(a, ra, tangent, pi), band(b, rb, 0, tangent), flank}, away_from((a + b) * 0.5)};
}

Surface surface_of(const TriangleMeshShape& mesh, const Shape&) {
  const dvec3 a(mesh.positions[0]), b(mesh.positions[1]), c(mesh.positions[2]);
  return {{[=](double u, double v) { return a + u * (b - a) + u * v * (c - b); }},
          always(glm::cross(b - a, c - a))};
}

Surface surface_of(const DiskShape& disk, const Shape&) {
  const Map map = [=](double u, double v) {
    const double r = disk.inner_radius + u * (disk.radius - disk.inner_radius),
                 turn = std::min(disk.phi_max, 2 * pi) * v;
    return dvec3(r * std::cos(turn), r * std::sin(turn), disk.height);
  };
  return {{map}, always({0, 0, 1})};
}

Surface surface_of(const CylinderShape& cylinder, const Shape& shape) {
  const dvec3 axis = cylinder.p1 - cylinder.p0, z = glm::normalize(axis),
              x = cylinder.radius * across(z), y = glm::cross(z, x);
  const auto around = [=](double v) { return std::cos(2 * pi * v) * x + std::sin(2 * pi * v) * y; };
  const dvec3 p0 = cylinder.p0, p1 = cylinder.p1;
  const Map surfaces[3] = {[=](double u, double v) { return p0 + u * axis + around(v); },
                           [=](double u, double v) { return p0 + u * around(v); },
                           [=](double u, double v) { return p1 + u * around(v); }};
  Surface out{{}, away_from(p0 + 0.5 * axis)};
  const auto& lit = shape.emission->surfaces;
  for (std::uint32_t i = 0; i < 3; ++i)
    if ((lit.empty() || std::ranges::find(lit, i) != lit.end()) &&
        (i == 0 || cylinder.caps[i - 1] == Cap::flat))
      out.parts.push_back(surfaces[i]);
  return out;
}

/// Flat ends. From the middle of the axis: the nearest of both ends' planes and of the flank, where
/// the distance from the axis is the radius there.
Surface surface_of(const ConeShape& cone, const Shape&) {
  const dvec3 axis = cone.p1 - cone.p0, z = glm::normalize(axis);
  const double half = 0.5 * glm::length(axis), middle = 0.5 * (cone.radius[0] + cone.radius[1]);
  const double slope = (cone.radius[1] - cone.radius[0]) / (2 * half);
  return star(cone.p0 + 0.5 * axis, [=](const dvec3& d) {
    const double along = glm::dot(d, z), off = glm::length(d - along * z) - slope * along;
    const double end = half / std::max(std::abs(along), 1e-300);
    return off > 0 ? std::min(end, middle / off) : end;
  });
}

Surface surface_of(const BoxShape& box, const Shape&) {
  const dvec3 low = box.p0, size = box.p1 - box.p0;
  Surface out{{}, away_from(low + 0.5 * size)};
  for (int face = 0; face < 6; ++face)
    out.parts.push_back([=](double u, double v) {
      dvec3 at(0);
      at[face / 2] = face % 2;
      at[(face / 2 + 1) % 3] = u;
      at[(face / 2 + 2) % 3] = v;
      return low + at * size;
    });
  return out;
}

/// One of a single ball.
Surface surface_of(const MolecularSurfaceShape& molecule, const Shape&) {
  return star(dvec3(molecule.centers[0]),
              [r = double(molecule.radii[0])](const dvec3&) { return r; });
}

/// One that holds the origin.
Surface surface_of(const PolyhedronShape& polyhedron, const Shape&) {
  return star(dvec3(0), [=](const dvec3& d) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < polyhedron.points.size(); ++i)
      if (const double along = glm::dot(polyhedron.normals[i], d); along > 0)
        nearest = std::min(nearest, glm::dot(polyhedron.normals[i], polyhedron.points[i]) / along);
    return nearest;
  });
}

Surface surface_of(const PartialSphereShape& sphere, const Shape&) {
  const double high = std::acos(std::clamp(sphere.z_max / sphere.radius, -1.0, 1.0)),
               low = std::acos(std::clamp(sphere.z_min / sphere.radius, -1.0, 1.0));
  const Map map = [=](double u, double v) {
    return sphere.radius * spherical(high + u * (low - high), sphere.phi_max * v);
  };
  return {{map}, away_from(dvec3(0))};
}

Surface surface_of(const OpenCylinderShape& tube, const Shape&) {
  const Map map = [=](double u, double v) {
    const double turn = tube.phi_max * v;
    return dvec3(tube.radius * std::cos(turn), tube.radius * std::sin(turn),
                 tube.z_min + u * (tube.z_max - tube.z_min));
  };
  return {{map}, [](const dvec3& p) { return dvec3(p.x, p.y, 0); }};
}

/// So nearly flat that its side is everywhere that of its middle: the cross product of the edges
/// along u and v.
Surface surface_of(const BilinearMeshShape& mesh, const Shape&) {
  const dvec3 p00(mesh.positions[0]), p10(mesh.positions[1]), p01(mesh.positions[2]),
      p11(mesh.positions[3]);
  const Map map = [=](double u, double v) {
    return (1 - v) * ((1 - u) * p00 + u * p10) + v * ((1 - u) * p01 + u * p11);
  };
  return {{map}, always(glm::cross(p10 - p00 + p11 - p01, p01 - p00 + p11 - p10))};
}

Surface surface_of(const CsgShape& csg, const Shape&) {
  std::vector<std::pair<dvec3, double>> balls;
  for (const auto& operand : csg.operands)
    balls.emplace_back(dvec3(operand->world_from_object[3]),
                       std::get<SphereShape>(operand->geometry).radius);
  const bool join = csg.operation == CsgShape::Operation::set_union;
  if (csg.operation == CsgShape::Operation::set_difference)
    throw std::logic_error("no coordinates of a difference");
  return star(dvec3(0), [=](const dvec3& d) {
    double reach = join ? 0 : std::numeric_limits<double>::infinity();
    for (const auto& [center, radius] : balls) {
      const double along = glm::dot(center, d);
      const double t =
          along + std::sqrt(along * along - glm::dot(center, center) + radius * radius);
      reach = join ? std::max(reach, t) : std::min(reach, t);
    }
    return reach;
  });
}

}  // namespace

std::vector<SurfacePoint> surface_points(const Shape& shape, std::size_t count) {
  const Surface surface =
      std::visit([&](const auto& geometry) { return surface_of(geometry, shape); }, shape.geometry);
  const glm::dmat4& m = shape.world_from_object;
  const glm::dmat3 linear(m), normals = glm::transpose(glm::inverse(linear));
  const auto place = [&](const dvec3& p) { return dvec3(m * glm::dvec4(p, 1)); };
  std::vector<SurfacePoint> points;
  // Roberts' sequence: the plane's counterpart of the golden ratio's multiples.
  const double plastic = 1.32471795724474602596;
  for (const Map& part : surface.parts)
    for (std::size_t i = 0; i < count; ++i) {
      const double step = static_cast<double>(i) + 0.5, h = 1e-5;
      const double u = std::fmod(step / plastic, 1.0),
                   v = std::fmod(step / (plastic * plastic), 1.0);
      const dvec3 at = part(u, v);
      const dvec3 du = (part(u + h, v) - part(u - h, v)) / (2 * h),
                  dv = (part(u, v + h) - part(u, v - h)) / (2 * h);
      const dvec3 cross = glm::cross(du, dv), world_cross = glm::cross(linear * du, linear * dv);
      SurfacePoint point{place(at), glm::normalize(normals * cross),
                         glm::length(world_cross) / static_cast<double>(count)};
      if ((glm::dot(cross, surface.outward(at)) < 0) != shape.reverse_orientation)
        point.n = -point.n;
      points.push_back(point);
    }
  return points;
}

}  // namespace caplet::test
