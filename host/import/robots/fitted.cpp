// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Fits MuJoCo's solids to meshes: by the box with the mesh's inertia, or by the extent along the
// inertia's axes (XMLreference, geom/mesh, mesh/inertia, compiler/fitaabb).
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "import/detail/robot.h"
#include "scene/principal_axes.h"

namespace caplet {

namespace {

using glm::dvec3;

/// The mass of a mesh, its centre, and its second moments about the centre.
struct Moments {
  double amount = 0;
  dvec3 middle{0};
  glm::dmat3 second{0};
};

using Corners = std::array<dvec3, 3>;

/// Calls work with the corners of each triangle.
template <class Work>
void each_triangle(const MeshParts& parts, const glm::dmat4& m, const Work& work) {
  for (const TriangleMeshShape& part : parts)
    for (const auto& t : part.triangles) {
      Corners corners;
      for (std::size_t k = 0; k < 3; ++k)
        corners[k] = dvec3(m * glm::dvec4(dvec3(part.positions[t[k]]), 1));
      work(corners);
    }
}

double area_of(const Corners& c) { return glm::length(glm::cross(c[1] - c[0], c[2] - c[0])) / 2; }

/// Returns the mass of a tetrahedron with its apex at the origin, or of the triangle alone. `sign`:
/// -1 where the mesh is mirrored.
double amount_of(const Corners& c, MeshFit::Mass mass, double sign) {
  if (mass == MeshFit::Mass::shell) return area_of(c);
  const double volume = sign * glm::dot(glm::cross(c[0], c[1]), c[2]) / 6;
  return mass == MeshFit::Mass::legacy ? std::abs(volume) : volume;
}

Moments moments_of(const MeshParts& parts, const glm::dmat4& m, MeshFit::Mass mass) {
  // Tetrahedra have their apex at the centre of the faces.
  double area = 0;
  dvec3 origin(0);
  each_triangle(parts, m, [&](const Corners& c) {
    area += area_of(c);
    origin += area_of(c) * (c[0] + c[1] + c[2]) / 3.0;
  });
  Moments out;
  if (!(area > 0)) return out;
  origin /= area;
  const bool is_shell = mass == MeshFit::Mass::shell;
  const double sign = glm::determinant(glm::dmat3(m)) < 0 ? -1 : 1;
  const double corners = is_shell ? 3 : 4;
  each_triangle(parts, m, [&](Corners c) {
    for (dvec3& p : c) p -= origin;
    const double amount = amount_of(c, mass, sign);
    out.amount += amount;
    out.middle += amount * (c[0] + c[1] + c[2]) / corners;
  });
  if (!(out.amount > 0)) return out;
  out.middle = origin + out.middle / out.amount;
  // For a simplex of n corners (a tetrahedron has the origin as one) the mean of x y is (sum of x_i
  // y_i + sum x_i sum y_i) / (n (n + 1)). The mass is recounted with the apex at the centre of
  // mass, because it changes if all volumes count as positive.
  out.amount = 0;
  each_triangle(parts, m, [&](Corners c) {
    for (dvec3& p : c) p -= out.middle;
    const double whole = amount_of(c, mass, sign), amount = whole / (corners * (corners + 1));
    out.amount += whole;
    const dvec3 sum = c[0] + c[1] + c[2];
    out.second += amount * glm::outerProduct(sum, sum);
    for (const dvec3& p : c) out.second += amount * glm::outerProduct(p, p);
  });
  return out;
}

/// Returns the principal axes as a rotation, the one of the least value first.
glm::dmat3 axes_of(const glm::dmat3& symmetric, dvec3& values) {
  const PrincipalAxes found = principal_axes(symmetric);
  std::array<int, 3> order{0, 1, 2};
  std::ranges::sort(order, {}, [&](int k) { return found.values[k]; });
  glm::dmat3 out;
  for (int k = 0; k < 3; ++k) {
    const int from = order[static_cast<std::size_t>(k)];
    out[k] = found.world_from_axes[from];
    values[k] = found.values[from];
  }
  if (glm::determinant(out) < 0) out[2] = -out[2];
  return out;
}

}  // namespace

bool fit(RobotGeom& geom, const MeshParts& parts) {
  const MeshFit how = *geom.fit;
  const Moments moments = moments_of(parts, geom.geom_from_mesh, how.mass);
  if (!(moments.amount > 0)) return false;
  // A box's second moment along an axis is its mass times a third of the squared half length.
  dvec3 second;
  const glm::dmat3 axes = axes_of(moments.second, second);
  dvec3 half;
  for (int k = 0; k < 3; ++k) half[k] = std::sqrt(std::max(0.0, 3 * second[k] / moments.amount));
  dvec3 middle = moments.middle;
  if (how.by_extent) {
    dvec3 low(1e300), high(-1e300);
    each_triangle(parts, geom.geom_from_mesh, [&](const Corners& c) {
      for (const dvec3& p : c) {
        const dvec3 local = glm::transpose(axes) * (p - moments.middle);
        low = glm::min(low, local);
        high = glm::max(high, local);
      }
    });
    half = (high - low) / 2.0;
    middle += axes * (low + high) / 2.0;
  }
  switch (geom.kind) {
    case GeomKind::sphere:
      geom.size =
          dvec3(how.by_extent ? std::max({half.x, half.y, half.z}) : (half.x + half.y + half.z) / 3,
                0, 0);
      break;
    case GeomKind::capsule:
    case GeomKind::cylinder: {
      const double radius = how.by_extent ? std::max(half.x, half.y) : (half.x + half.y) / 2;
      const double caps = geom.kind == GeomKind::cylinder ? 0 : how.by_extent ? radius : radius / 2;
      geom.size = {radius, std::max(0.0, half.z - caps), 0};
      break;
    }
    default:
      geom.size = half;
  }
  geom.size *= how.scale;
  glm::dmat4 place(axes);
  place[3] = glm::dvec4(middle, 1);
  geom.world = geom.world * place;
  geom.fit.reset();
  const int needed = geom.kind == GeomKind::sphere || geom.kind == GeomKind::capsule ? 1
                     : geom.kind == GeomKind::cylinder                               ? 2
                                                                                     : 3;
  for (int k = 0; k < needed; ++k)
    if (!(geom.size[k] > 0)) return false;
  return true;
}

}  // namespace caplet
