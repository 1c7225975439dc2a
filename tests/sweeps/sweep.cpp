// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "sweep.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "lower/detail/shapes.h"
#include "reference/from_scene.h"
#include "shared/kinds.h"
#include "support/test_device.h"

namespace caplet::test {

namespace {

using glm::dvec3;

constexpr std::uint32_t capacity = 24;
constexpr int rays_each = 50;

std::array<float, 3> floats(const dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
dvec3 perpendicular(const dvec3& n, CaseMaker& maker) {
  const dvec3 d = maker.direction();
  return glm::normalize(d - glm::dot(d, n) * n);
}

// Around the z axis of their own space: placed by an instance alone.
bool is_local(int shape) {
  return shape == shape_partial_sphere || shape == shape_open_cylinder ||
         shape == shape_partial_disk;
}

PlacedPrimitive placed_by(const FlatPrimitive& p, const glm::dmat4& m) {
  PlacedPrimitive out{p, true, {}, {}};
  const glm::dmat4 inverse = glm::inverse(m);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) {
      out.world_from_object[static_cast<std::size_t>(4 * r + c)] = static_cast<float>(m[c][r]);
      out.object_from_world[static_cast<std::size_t>(4 * r + c)] =
          static_cast<float>(inverse[c][r]);
    }
  return out;
}

glm::dmat4 turned(CaseMaker& maker, const dvec3& to) {
  return glm::rotate(glm::translate(glm::dmat4(1), to), maker.uniform(0, full_turn),
                     maker.direction());
}

// A long solid, and a ball or another one across it.
CsgShape long_csg(CaseMaker& maker, const Setting& s) {
  const double r = s.radius, half = 0.5 * s.aspect * s.radius;
  const auto operand = [](decltype(Shape::geometry) geometry, const glm::dmat4& m = glm::dmat4(1)) {
    Shape shape;
    shape.geometry = std::move(geometry);
    shape.world_from_object = m;
    return std::make_shared<const Shape>(shape);
  };
  CsgShape csg;
  csg.operation = static_cast<CsgShape::Operation>(maker.below(3));
  const dvec3 p0(0, 0, -half), p1(0, 0, half);
  switch (maker.below(3)) {
    case 0:
      csg.operands.push_back(operand(
          CapsulesShape{{glm::vec3(p0)}, {glm::vec3(p1)}, {static_cast<float>(r)}, {}, {}}));
      break;
    case 1:
      csg.operands.push_back(operand(CylinderShape{p0, p1, r, {Cap::flat, Cap::flat}}));
      break;
    default:
      csg.operands.push_back(operand(BoxShape{{-r, -r, -half}, {r, r, half}}));
  }
  const dvec3 across(maker.uniform(-r, r), maker.uniform(-r, r), maker.uniform(-half, half));
  if (maker.below(2) == 0)
    csg.operands.push_back(
        operand(SphereShape{r * maker.uniform(0.5, 1.5)}, glm::translate(glm::dmat4(1), across)));
  else
    csg.operands.push_back(
        operand(CylinderShape{{-3 * r, 0, 0}, {3 * r, 0, 0}, 0.7 * r, {Cap::flat, Cap::flat}},
                glm::translate(glm::dmat4(1), across)));
  return csg;
}

FlatPrimitive flat(int shape, const Setting& s, const CaseMaker::Frame& at, CaseMaker& maker,
                   std::vector<float>& leaves) {
  const auto r = static_cast<float>(s.radius);
  const dvec3 c = at.center;
  auto p0 = floats(c - 0.5 * at.length * at.axis), p1 = floats(c + 0.5 * at.length * at.axis);
  constexpr std::array caps = {CAPLET_CAP_FLAT, CAPLET_CAP_ROUND, CAPLET_CAP_OPEN};
  const auto cap0 = caps[static_cast<std::size_t>(maker.below(3))];
  auto cap1 = caps[static_cast<std::size_t>(maker.below(3))];
  // Whether a ball of radius L closes the open disk that it touches is rounding (docs/numerics.md,
  // "Cylinders and cones").
  if (cap0 != cap1 && s.aspect == 1) cap1 = CAPLET_CAP_FLAT;
  const auto thin_end =
      static_cast<float>(maker.below(5) == 0 ? 0 : s.radius * maker.uniform(0, 1));
  const auto phi_max =
      static_cast<float>(maker.below(2) == 0 ? full_turn : maker.uniform(0.5, full_turn));
  const dvec3 side = perpendicular(at.axis, maker);
  switch (shape) {
    case shape_sphere:
      return make_sphere(floats(c), r);
    case shape_capsule:
      return make_capsule(p0, p1, r);
    case shape_tapered_capsule:
      return make_tapered(p0, p1, r, thin_end);
    case shape_triangle:
      return make_triangle(
          p0, p1, floats(c + maker.uniform(-0.5, 0.5) * at.length * at.axis + 2 * s.radius * side));
    case shape_disk:
      return make_disk(floats(c), floats(at.axis), r);
    case shape_cylinder:
      return make_cylinder(p0, p1, r, cap0, cap1);
    case shape_cone:
      return maker.below(2) == 0 ? make_cone(p0, p1, r, thin_end, cap0, cap1)
                                 : make_cone(p0, p1, thin_end, r, cap0, cap1);
    case shape_box: {
      dvec3 half(s.radius);
      half[maker.below(3)] *= 0.5 * s.aspect;
      return make_box(floats(c - half), floats(c + half));
    }
    case shape_polyhedron:
      return maker.polyhedron(4 + maker.below(8), std::max(1.0, 0.5 * s.aspect), at, leaves);
    case shape_partial_sphere:
      return make_partial_sphere(r, static_cast<float>(-s.radius * maker.uniform(0, 1.2)),
                                 static_cast<float>(s.radius * maker.uniform(0.1, 1.2)), phi_max);
    case shape_open_cylinder:
      return make_open_cylinder(r, static_cast<float>(-0.5 * at.length),
                                static_cast<float>(0.5 * at.length), phi_max);
    case shape_partial_disk:
      return make_partial_disk(
          0, r, static_cast<float>(maker.below(2) == 0 ? 0 : s.radius * maker.uniform(0.1, 0.9)),
          phi_max);
    default: {
      const dvec3 u = at.length * at.axis, v = 2 * s.radius * side;
      return make_bilinear(
          p0, floats(c - 0.5 * u + u), floats(c - 0.5 * u + v),
          floats(c + 0.5 * u + v + s.radius * maker.uniform(0, 1) * maker.direction()));
    }
  }
}

void add_shape(int shape, const Setting& s, CaseMaker& maker, SweepCases& out) {
  CaseMaker::Frame at{s.radius, s.place * maker.direction(), maker.direction(),
                      s.aspect * s.radius};
  if (maker.below(8) == 0) at.axis = dvec3(0, 0, 1);
  if (shape == shape_instance) {
    out.cases.primitives.push_back(make_sphere({0, 0, 0}, 1));
    out.cases.references.push_back(reference_of(out.cases.primitives.back()));
    const dvec3 scale(s.radius, maker.below(2) == 0 ? s.radius : -s.radius,
                      0.5 * std::max(2.0, s.aspect) * s.radius);
    out.placed.push_back(
        placed_by(out.cases.primitives.back(), glm::scale(turned(maker, at.center), scale)));
    out.radius.push_back(1);
    return;
  }
  if (shape == shape_csg) {
    CsgShape csg;
    Shape whole;
    do {
      csg = placed_csg(long_csg(maker, s), turned(maker, at.center));
      whole.geometry = csg;
      // Intersections may be empty: tried where the second operand is.
      const dvec3 center = csg.operands[1]->world_from_object[3];
      const reference::Primitive reference = reference::primitives_of(whole).at(0);
      bool something = false;
      for (int i = 0; i < 20 && !something; ++i)
        something = reference::value(reference, center + s.radius * maker.uniform(0, 1) *
                                                             maker.direction()) < -0.05 * s.radius;
      if (something) break;
    } while (true);
    out.cases.primitives.push_back(flat_primitive(csg, glm::dmat4(1), out.cases.leaves));
    out.cases.references.push_back(reference::primitives_of(whole).at(0));
  } else {
    out.cases.primitives.push_back(flat(shape, s, at, maker, out.cases.leaves));
    out.cases.references.push_back(reference_of(out.cases.primitives.back(), out.cases.leaves));
  }
  const FlatPrimitive& p = out.cases.primitives.back();
  out.placed.push_back(is_local(shape) ? placed_by(p, turned(maker, at.center))
                                       : PlacedPrimitive{p, false, {}, {}});
  out.radius.push_back(s.radius);
}

glm::dmat4 world_from_object(const PlacedPrimitive& placed) {
  glm::dmat4 m(1);
  if (placed.placed)
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c)
        m[c][r] = placed.world_from_object[static_cast<std::size_t>(4 * r + c)];
  return m;
}

RayRecord ray_of(const Setting& s, double r, const FlatPrimitive& p,
                 const reference::Primitive& reference, CaseMaker& maker,
                 const PlacedPrimitive& placed) {
  // In object space, where r is the radius; `scale`: of the map, so that distances are the world's.
  const double scale = s.radius / r, size = reference::bounding_ball(reference).radius;
  dvec3 n;
  const dvec3 on = maker.surface_point(p, reference, &n);
  const dvec3 aim = on + (maker.below(2) == 0 ? 0.0 : std::pow(10.0, maker.uniform(-6, 0))) * 0.3 *
                             r * maker.direction();
  const dvec3 towards =
      maker.below(10) == 0 ? glm::normalize(maker.own_axis(p, reference)) : maker.direction();
  double distance = s.away * r;
  if (s.away < 0)
    distance =
        maker.below(2) == 0 ? r * std::pow(10.0, maker.uniform(0, 1)) : size * maker.uniform(1, 4);
  if (s.least_away > 0) distance = std::max(s.least_away, s.radius) / scale * maker.uniform(1, 10);
  dvec3 o = aim - distance * towards, d = aim - o;
  if (s.away == 0) {  // inside, or above and below open shapes
    o = on - r * std::pow(10.0, maker.uniform(-3, 0)) * n;
    d = maker.direction();
  }
  d = glm::normalize(d) * (maker.below(4) == 0 ? std::pow(10.0, maker.uniform(-3, 3)) : 1.0);
  const glm::dmat4 m = world_from_object(placed);
  return make_ray(dvec3(m * glm::dvec4(o, 1)), dvec3(m * glm::dvec4(d, 0)));
}

// Past the silhouette of a curved surface, inside or outside by `graze` radii, or past an edge of a
// flat one.
RayRecord passing_ray(const Setting& s, double r, const FlatPrimitive& p,
                      const reference::Primitive& reference, CaseMaker& maker,
                      const PlacedPrimitive& placed) {
  const double off = (maker.below(2) == 0 ? s.graze : -s.graze) * r;
  const auto rim = reference::boundary(reference);
  dvec3 o, d;
  if (!rim.empty() && (!is_local(static_cast<int>(p.shape)) || maker.below(2) == 0)) {
    const reference::Curve& curve =
        rim[static_cast<std::size_t>(maker.below(static_cast<int>(rim.size())))];
    d = maker.direction();
    o = curve.at(maker.uniform(0, 1)) + off * perpendicular(d, maker);
  } else {
    dvec3 n;
    o = maker.surface_point(p, reference, &n) + off * n;
    d = perpendicular(n, maker);
  }
  o -= r * maker.uniform(0.5, 4) * d;
  const glm::dmat4 m = world_from_object(placed);
  return make_ray(dvec3(m * glm::dvec4(o, 1)), dvec3(m * glm::dvec4(d, 0)));
}

// Meets the surface at an angle of `graze`, from either side.
RayRecord shallow_ray(const Setting& s, double r, const FlatPrimitive& p,
                      const reference::Primitive& reference, CaseMaker& maker,
                      const PlacedPrimitive& placed) {
  dvec3 n;
  const dvec3 on = maker.surface_point(p, reference, &n);
  const dvec3 d = perpendicular(n, maker) + (maker.below(2) == 0 ? s.graze : -s.graze) * n;
  const glm::dmat4 m = world_from_object(placed);
  return make_ray(dvec3(m * glm::dvec4(on - r * maker.uniform(0.5, 4) * d, 1)),
                  dvec3(m * glm::dvec4(d, 0)));
}

double ulp(double t) {
  const auto f = static_cast<float>(t);
  return double(std::nextafter(f, HUGE_VALF)) - double(f);
}

// The value that `part` of all is at most; reorders them.
double quantile(std::vector<double>& values, double part) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

struct Measured {
  bool hit = false, edge_on = false, expected = false, excused = false;
  double bound = 0, radius = 0, ulps = -1;
  std::string wrong;
};

Measured measure(const Case& c, const Listed& listed, double radius) {
  Measured out;
  const Judgement judgement = judge(c, listed, capacity);
  out.wrong = judgement.wrong;
  out.excused = judgement.excused;
  out.hit = listed.nearest.slot != CAPLET_NONE;
  const auto expected = reference::closest(*c.reference, c.ray);
  out.expected = expected.has_value();
  if (!out.hit) return out;
  const double off = std::abs(c.value(listed.nearest.t));
  out.edge_on = off > c.bound && judgement.wrong.empty();
  out.bound = off / c.bound;
  out.radius = off / radius;
  const bool leaving = (listed.nearest.surface & CAPLET_LEAVING) != 0;
  if (expected && !out.edge_on && !judgement.excused && judgement.wrong.empty() &&
      expected->leaving == leaving)
    out.ulps = std::abs(double(listed.nearest.t) - expected->t) / ulp(expected->t);
  return out;
}

}  // namespace

std::vector<ShapeKind> sweep_kinds() {
  std::vector<ShapeKind> out(shape_kinds().begin(), shape_kinds().end());
  out.push_back({shape_instance, "instance"});
  return out;
}

const std::vector<Axis>& axes() {
  static const std::vector<Axis> all = {
      {AxisName::aspect, "length over radius", "aspect", {1, 10, 100, 1e3, 1e4, 1e5}},
      {AxisName::radius, "radius", "radius", {1e-4, 1e-3, 1e-2, 0.1, 1, 10, 100, 1e3, 1e4}},
      {AxisName::place,
       "distance of the shape from the origin",
       "place",
       {0, 1, 10, 100, 1e3, 1e4, 1e5, 1e6}},
      {AxisName::away,
       "distance of the ray's origin, in radii",
       "away",
       {0, 1, 10, 100, 1e3, 1e4, 1e5, 1e6}},
      {AxisName::graze,
       "grazing, in radii or radians",
       "graze",
       {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}}};
  return all;
}

bool has_axis(int shape, AxisName axis) {
  if (axis != AxisName::aspect) return true;
  return shape != shape_sphere && shape != shape_disk && shape != shape_partial_sphere &&
         shape != shape_partial_disk;
}

Setting setting_at(AxisName axis, double value) {
  Setting s;
  switch (axis) {
    case AxisName::aspect:
      s.aspect = value;
      break;
    case AxisName::radius:  // in a scene of a few units
      s.radius = value;
      s.place = s.least_away = 1;
      break;
    case AxisName::place:
      s.place = value;
      break;
    case AxisName::away:
      s.away = value;
      break;
    case AxisName::graze:
      s.graze = value;
  }
  return s;
}

Case SweepCases::of(std::size_t ray) const {
  const std::uint32_t i = cases.which[ray];
  return placed[i].placed ? make_case(placed[i], cases.references[i], cases.rays[ray])
                          : make_case(cases.primitives[i], cases.references[i], cases.rays[ray]);
}

void add_cell(int shape, const Setting& setting, std::uint32_t cell, int rays, CaseMaker& maker,
              SweepCases& out) {
  for (int i = 0; i < rays; ++i) {
    if (i % rays_each == 0) add_shape(shape, setting, maker, out);
    const std::size_t which = out.cases.primitives.size() - 1;
    const FlatPrimitive& p = out.cases.primitives[which];
    const reference::Primitive& reference = out.cases.references[which];
    const bool passing = setting.graze > 0 && maker.below(2) == 0;
    const auto make = passing ? passing_ray : setting.graze > 0 ? shallow_ray : ray_of;
    out.cases.which.push_back(static_cast<std::uint32_t>(which));
    out.cases.rays.push_back(
        make(setting, out.radius[which], p, reference, maker, out.placed[which]));
    out.cell.push_back(cell);
    out.passing.push_back(passing);
  }
}

SweepCases sweep_cases(int shape, AxisName axis, std::span<const double> values, int rays,
                       std::uint32_t seed) {
  SweepCases out;
  for (std::uint32_t i = 0; i < values.size(); ++i) {
    CaseMaker maker(seed + 1000 * static_cast<std::uint32_t>(axis) +
                    100 * static_cast<std::uint32_t>(shape) + i);
    add_cell(shape, setting_at(axis, values[i]), i, rays, maker, out);
  }
  return out;
}

std::vector<Cell> sweep(const Device& device, int shape, AxisName axis,
                        std::span<const double> values, int rays, std::uint32_t seed) {
  const SweepCases all = sweep_cases(shape, axis, values, rays, seed);
  const auto listed = Probe(device, test_width(), all.placed, all.cases.leaves)
                          .list(all.cases.which, all.cases.rays, capacity);
  std::vector<Measured> measured(listed.size());
  tbb::parallel_for(std::size_t{0}, listed.size(), [&](std::size_t i) {
    measured[i] = measure(all.of(i), listed[i], all.radius[all.cases.which[i]]);
  });
  std::vector<Cell> out(values.size());
  for (std::uint32_t k = 0; k < out.size(); ++k) {
    Cell& cell = out[k];
    std::vector<double> bounds, radii, ulps;
    for (std::size_t i = 0; i < measured.size(); ++i) {
      const Measured& m = measured[i];
      if (all.cell[i] != k) continue;
      ++cell.rays;
      cell.hits += m.hit;
      cell.excused += m.excused;
      cell.edge_on += m.edge_on;
      if (!m.wrong.empty() && ++cell.wrong <= 3)
        cell.examples.push_back(m.wrong + "\n" +
                                described(all.cases.primitive(i), all.cases.rays[i]));
      if (m.hit && !m.edge_on) bounds.push_back(m.bound), radii.push_back(m.radius);
      if (m.ulps >= 0) ulps.push_back(m.ulps);
      cell.passing += all.passing[i];
      if (all.passing[i] && m.hit != m.expected) {
        ++cell.differ;
        // Csg shapes: the line may be deep inside behind the ray's origin; judge() has looked at
        // what lies ahead.
        if (shape == shape_csg) continue;
        const Case c = all.of(i);
        const double margin = std::abs(reference::margin(*c.reference, c.ray));
        cell.differ_radii = std::max(cell.differ_radii, margin / all.radius[all.cases.which[i]]);
        cell.differ_bound = std::max(cell.differ_bound, margin / c.bound);
      }
    }
    cell.bound_worst = quantile(bounds, 1);
    cell.bound_p99 = quantile(bounds, 0.99);
    cell.radius_worst = quantile(radii, 1);
    cell.radius_p99 = quantile(radii, 0.99);
    cell.ulps_worst = quantile(ulps, 1);
    cell.ulps_p99 = quantile(ulps, 0.99);
    cell.ulps_p50 = quantile(ulps, 0.5);
  }
  return out;
}

}  // namespace caplet::test
