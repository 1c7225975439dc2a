// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "csg_cases.h"
#include "floats.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "reference/solver.h"

namespace caplet::test {
namespace {

using glm::dmat4;
using glm::dvec3;

dvec3 apply(const dmat4& m, const dvec3& p) { return dvec3(m * glm::dvec4(p, 1)); }

reference::Frustum::End end_of(double radius, Cap cap) {
  return {radius, cap == Cap::round, cap == Cap::open};
}

/// In the shape's own space.
struct ReferenceOf {
  using Primitive = reference::Primitive;
  Primitive operator()(const SphereShape& s) const { return reference::Sphere{dvec3(0), s.radius}; }
  Primitive operator()(const CapsulesShape& c) const {
    const double r0 = double(c.radius0[0]), r1 = c.radius1.empty() ? r0 : double(c.radius1[0]);
    return reference::Capsule{dvec3(c.p0[0]), dvec3(c.p1[0]), r0, r1};
  }
  Primitive operator()(const CylinderShape& c) const {
    return reference::make_frustum(c.p0, c.p1, end_of(c.radius, c.caps[0]),
                                   end_of(c.radius, c.caps[1]));
  }
  Primitive operator()(const ConeShape& c) const {
    return reference::make_frustum(c.p0, c.p1, end_of(c.radius[0], c.caps[0]),
                                   end_of(c.radius[1], c.caps[1]));
  }
  Primitive operator()(const BoxShape& b) const {
    return reference::Box{{glm::min(b.p0, b.p1), glm::max(b.p0, b.p1)}};
  }
  Primitive operator()(const PolyhedronShape& p) const {
    std::vector<dvec3> normals;
    std::vector<double> offsets;
    for (std::size_t i = 0; i < p.points.size(); ++i) {
      normals.push_back(glm::normalize(p.normals[i]));
      offsets.push_back(glm::dot(normals.back(), p.points[i]));
    }
    return reference::make_polyhedron(dvec3(0), normals, offsets);
  }
  Primitive operator()(const CsgShape& c) const {
    std::vector<reference::CsgPart> parts;
    for (const auto& one : c.operands)
      parts.push_back({std::visit(ReferenceOf{}, one->geometry), one->world_from_object});
    return reference::make_csg(static_cast<reference::Csg::Operation>(c.operation), parts);
  }
  template <class Open>
  Primitive operator()(const Open&) const {
    throw std::logic_error("not a solid");
  }
};
static_assert(static_cast<int>(reference::Csg::Operation::set_intersection) ==
              static_cast<int>(Operation::set_intersection));
static_assert(static_cast<int>(reference::Csg::Operation::set_difference) ==
              static_cast<int>(Operation::set_difference));

CapsulesShape one_capsule(const dvec3& p0, const dvec3& p1, double r0, double r1) {
  CapsulesShape c;
  c.p0 = {glm::vec3(p0)};
  c.p1 = {glm::vec3(p1)};
  c.radius0 = {static_cast<float>(r0)};
  if (r0 != r1) c.radius1 = {static_cast<float>(r1)};
  return c;
}

}  // namespace

std::shared_ptr<const Shape> operand(decltype(Shape::geometry) geometry, const dmat4& placed) {
  auto out = std::make_shared<Shape>();
  out->geometry = std::move(geometry);
  out->world_from_object = placed;
  return out;
}

Shape csg_shape(Operation operation, std::vector<std::shared_ptr<const Shape>> operands,
                const dmat4& placed) {
  Shape out;
  out.geometry = CsgShape{operation, std::move(operands)};
  out.world_from_object = placed;
  return out;
}

reference::Primitive reference_of_shape(const Shape& shape) {
  const reference::CsgPart part{std::visit(ReferenceOf{}, shape.geometry), shape.world_from_object};
  return reference::make_csg(reference::Csg::Operation::set_union, std::span(&part, 1));
}

std::vector<PlacedSolid> solids_of(const Shape& shape, const dmat4& parent) {
  const dmat4 m = parent * shape.world_from_object;
  const auto* csg = std::get_if<CsgShape>(&shape.geometry);
  if (!csg) return {{&shape, m}};
  std::vector<PlacedSolid> out;
  for (const auto& one : csg->operands) {
    const auto more = solids_of(*one, m);
    out.insert(out.end(), more.begin(), more.end());
  }
  return out;
}

FlatScene flat_scene(std::vector<Shape> shapes) {
  Scene scene;
  scene.materials.push_back({DiffuseMaterial{}, "", {}});
  scene.shapes = std::move(shapes);
  return lower(scene);
}
FlatScene flat_scene(const Shape& shape) {
  std::vector<Shape> shapes = {shape};
  if (bounds_of(shape).empty())
    shapes.push_back(*operand(SphereShape{1e-3}, glm::translate(dmat4(1), dvec3(1e7, -2e7, 3e7))));
  return flat_scene(shapes);
}

dvec3 CsgMaker::direction() {
  const double z = uniform(-1, 1), phi = uniform(0, 6.283185307179586),
               r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(phi), r * std::sin(phi), z};
}

dmat4 CsgMaker::placement(double reach, bool affine) {
  dmat4 m = glm::translate(dmat4(1), point(reach));
  if (below(3) == 0 && !affine) return m;
  m = glm::rotate(m, uniform(0, 6.3), direction());
  if (!affine) return m;
  m = glm::scale(
      m, dvec3(uniform(0.5, 2), uniform(0.5, 2), uniform(0.5, 2) * (below(2) == 0 ? 1 : -1)));
  return glm::rotate(m, uniform(0, 6.3), direction());
}

std::shared_ptr<const Shape> CsgMaker::solid(bool affine) {
  const dmat4 placed = placement(0.7, affine && below(2) == 0);
  const dvec3 p0 = point(0.7), p1 = point(0.7);
  const double r0 = uniform(0.2, 0.8), r1 = uniform(0.2, 0.8);
  const auto cap = [&] { return below(2) == 0 ? Cap::flat : Cap::round; };
  switch (below(7)) {
    case 0:
      return operand(SphereShape{uniform(0.4, 1)}, placed);
    case 1:
      return operand(one_capsule(p0, p1, r0, r0), placed);
    case 2:
      return operand(one_capsule(p0, p1, r0, r1), placed);
    case 3:
      return operand(BoxShape{point(1) - dvec3(0.3), point(1) + dvec3(0.3)}, placed);
    case 5:
      return operand(CylinderShape{p0, p1, r0, {cap(), cap()}}, placed);
    case 6:
      return operand(ConeShape{p0, p1, {r0, below(3) == 0 ? 0 : r1}, {cap(), cap()}}, placed);
    default: {
      PolyhedronShape p;
      for (int i = 0; i < 6; ++i) {  // a bent box, so that it is bounded
        const dvec3 n = glm::normalize(
            dvec3(i / 2 == 0, i / 2 == 1, i / 2 == 2) * (i % 2 == 0 ? 1.0 : -1.0) + point(0.3));
        p.normals.push_back(n * uniform(0.5, 3));
        p.points.push_back(n * uniform(0.4, 0.9));
      }
      for (int i = below(4); i > 0; --i) {
        p.normals.push_back(direction());
        p.points.push_back(p.normals.back() * uniform(0.4, 0.9));
      }
      return operand(p, placed);
    }
  }
}

std::shared_ptr<const Shape> CsgMaker::csg(int depth, int most, bool affine) {
  const int count = std::min(most, 2 + below(3));
  CsgShape out;
  out.operation = static_cast<Operation>(below(3));
  for (int i = 0; i < count; ++i) {
    const int rest = most / count;
    if (depth > 1 && rest >= 2 && (i == 0 || below(2) == 0))
      out.operands.push_back(csg(depth - 1, rest, affine));
    else
      out.operands.push_back(solid(affine));
  }
  return operand(out, placement(0.3, affine && below(3) == 0));
}

std::vector<RayRecord> CsgMaker::rays(const Shape& shape, int count) {
  Bounds box;
  const std::vector<PlacedSolid> solids = solids_of(shape);
  for (const PlacedSolid& solid : solids) {
    Shape moved = *solid.shape;
    moved.world_from_object = solid.world_from_solid;
    box.extend(bounds_of(moved));
  }
  const dvec3 center = 0.5 * (box.min + box.max);
  const double size = glm::length(box.max - box.min);
  const auto anywhere = [&] { return center + 0.5 * (box.max - box.min) * point(1); };
  std::vector<RayRecord> out;
  for (int i = 0; i < count; ++i) {
    const dvec3 aim = anywhere();
    dvec3 o, d;
    switch (below(6)) {
      case 0:
        o = anywhere();
        d = direction();
        break;
      case 1:
        o = center + size * std::pow(10.0, uniform(0, 3)) * direction();
        d = (aim - o) * std::pow(10.0, uniform(-3, 3));
        break;
      case 2: {
        d = dvec3(0);
        d[below(3)] = below(2) == 0 ? 1 : -1;
        o = aim - uniform(0, 2) * size * d;
        break;
      }
      case 3: {  // along an axis of one of the solids
        const dmat4& m = solids[static_cast<std::size_t>(below(static_cast<int>(solids.size())))]
                             .world_from_solid;
        d = dvec3(m[below(3)]);
        o = aim - uniform(0, 2) * d;
        break;
      }
      case 4: {  // through the place of a solid's own origin
        const dmat4& m = solids[static_cast<std::size_t>(below(static_cast<int>(solids.size())))]
                             .world_from_solid;
        o = center + size * uniform(0.5, 2) * direction();
        d = apply(m, dvec3(0)) - o;
        break;
      }
      default:
        o = center + size * uniform(0.5, 2) * direction();
        d = aim - o;
    }
    out.push_back(make_ray(o, d));
  }
  return out;
}

CsgBound::CsgBound(const Shape& shape) {
  // Operand by operand, in its own space where it is placed: 16 eps (distance of the origin + size)
  // and 8 eps of the terms of the way there; taken back by the largest stretch. Both the computed
  // crossing and the one it is merged with are off by that.
  Bounds whole = bounds_of(shape);
  if (whole.empty()) whole = Bounds{dvec3(-1), dvec3(1)};
  center_ = 0.5 * (whole.min + whole.max);
  const double radius = 0.5 * glm::length(whole.max - whole.min);
  double bound = 0;
  for (const PlacedSolid& solid : solids_of(shape)) {
    Shape own = *solid.shape;
    own.world_from_object = dmat4(1);
    const Bounds box = bounds_of(own);
    const double extent = glm::length(glm::max(glm::abs(box.min), glm::abs(box.max)));
    const dmat4& m = solid.world_from_solid;
    const dmat4 inverse = glm::inverse(m);
    const double forth =
        glm::length(dvec3(m[0])) + glm::length(dvec3(m[1])) + glm::length(dvec3(m[2]));
    const double back = glm::length(dvec3(inverse[0])) + glm::length(dvec3(inverse[1])) +
                        glm::length(dvec3(inverse[2]));
    const double away = glm::length(center_ - dvec3(m[3]));
    bound = std::max(bound, 24 * eps * forth * (back * (radius + away) + 3 * extent));
  }
  // Coordinates of the world.
  fixed_ =
      bound + 16 * eps * (radius + glm::length(glm::max(glm::abs(whole.min), glm::abs(whole.max))));
}

// The way to the centre.
double CsgBound::operator()(const dvec3& origin) const {
  return fixed_ + 16 * eps * glm::length(origin - center_);
}

std::string csg_disagreement(const Shape& shape, const reference::Primitive& reference,
                             const CsgBound& allowed, const RayRecord& record,
                             const RayList& list) {
  const reference::Ray ray{{record.ox, record.oy, record.oz},
                           {record.dx, record.dy, record.dz},
                           double(record.t_min),
                           HUGE_VAL};
  const auto at = [&](double t) { return ray.origin + t * ray.direction; };
  const double bound = allowed(ray.origin);
  if (list.overflow) return "more crossings than the list holds";
  if (list.any != !list.hits.empty()) return "any hit is not whether the list has one";
  if ((list.closest.slot == CAPLET_NONE) != list.hits.empty())
    return "the nearest hit is not whether the list has one";
  if (!list.hits.empty() &&
      (list.closest.t != list.hits[0].t || list.closest.surface != list.hits[0].surface))
    return fmt::format("the nearest hit at {} is not the first of the list at {}", list.closest.t,
                       list.hits[0].t);

  bool inside = !list.hits.empty() && is_leaving(list.hits[0]);
  double last = 0;
  const auto claims = [&](double t, bool in) {
    const double f = reference::value(reference, at(t));
    return in ? f <= bound : f >= -bound;
  };
  const std::vector<PlacedSolid> solids = solids_of(shape);
  for (std::size_t i = 0; i <= list.hits.size(); ++i) {
    const double next =
        i < list.hits.size() ? double(list.hits[i].t) : last + 1e3 / glm::length(ray.direction);
    if (!(next > last || (i > 0 && next >= last)))
      return fmt::format("crossing {} at {} is not behind {}", i, next, last);
    for (int k = 1; k < 16; ++k)
      if (const double t = last + (next - last) * k / 16; !claims(t, inside))
        return fmt::format("{} said to be {} at t {}, the value is {}, the bound {}", i,
                           inside ? "inside" : "outside", t, reference::value(reference, at(t)),
                           bound);
    if (i == list.hits.size()) break;
    const HitRecord& hit = list.hits[i];
    if (is_leaving(hit) != inside) return fmt::format("crossing {} does not take turns", i);
    inside = !inside;
    last = next;
    if (const double f = reference::value(reference, at(next)); std::abs(f) > bound)
      return fmt::format("crossing {} is {} off the shape, the bound is {}", i, f, bound);

    // The surface: of the operand it names, at a point of it, its normal out of the whole.
    std::size_t solid = 0;
    std::uint32_t number = surface_number(hit);
    while (solid + 1 < solids.size() && number >= surface_count(*solids[solid].shape))
      number -= static_cast<std::uint32_t>(surface_count(*solids[solid++].shape));
    if (number >= surface_count(*solids[solid].shape))
      return fmt::format("there is no surface {}", surface_number(hit));
    const CrossingSurface& s = list.surfaces[i];
    const dvec3 p(s.p[0], s.p[1], s.p[2]), n(s.ng[0], s.ng[1], s.ng[2]);
    const dmat4& m = solids[solid].world_from_solid;
    const reference::Primitive own = std::visit(ReferenceOf{}, solids[solid].shape->geometry);
    const dvec3 local = apply(glm::inverse(m), p);
    const reference::CsgPart placed{own, m};
    const reference::Primitive in_world =
        reference::make_csg(reference::Csg::Operation::set_union, std::span(&placed, 1));
    if (const double off = std::abs(reference::value(in_world, p));
        off > double(s.error) + 4 * eps * glm::length(p))
      return fmt::format("the surface point of crossing {} is {} off its operand, stated {}", i,
                         off, s.error);
    if (std::abs(glm::length(n) - 1) > 1e-6) return "the normal is no unit vector";
    const reference::SurfaceAt named = reference::surface_at(own, local);
    const double stretch =
        glm::length(dvec3(m[0])) + glm::length(dvec3(m[1])) + glm::length(dvec3(m[2]));
    if (named.surface != static_cast<int>(number) && named.margin > 4 * bound * stretch)
      return fmt::format(
          "crossing {} names surface {} of its operand, the reference {} (margin {})", i, number,
          named.surface, named.margin);
    // Away from rims the solid lies behind the surface and air before it.
    const double step = std::max(1e-4, 8 * bound);
    if (reference::surface_at(reference, p).margin > 2 * step &&
        !(reference::value(reference, p - step * n) < 0 &&
          reference::value(reference, p + step * n) > 0))
      return fmt::format("the normal of crossing {} does not point out of the solid", i);
  }
  return {};
}

}  // namespace caplet::test
