// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Random primitives and rays.
#include "cases.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>

#include "shared/kinds.h"

namespace caplet::test {

namespace {

using glm::dvec3;

dvec3 point(const float* p) { return {p[0], p[1], p[2]}; }
std::array<float, 3> floats(const dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
dvec3 any_perpendicular(const dvec3& n) {
  return glm::normalize(glm::cross(n, std::abs(n.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
}

}  // namespace

dvec3 CaseMaker::direction() {
  const double z = uniform(-1, 1), phi = uniform(0, 6.283185307179586), r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(phi), r * std::sin(phi), z};
}

FlatPrimitive CaseMaker::primitive(int shape, bool hard) {
  const double r = std::pow(10.0, hard ? uniform(-3, 3) : uniform(-1, 1));
  const double place = !hard || below(3) == 0 ? 3 * r : std::pow(10.0, uniform(0, 5));
  const dvec3 c = place * dvec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
  dvec3 axis = direction();
  if (below(8) == 0) axis = dvec3(below(3) == 0, 0, 0) + dvec3(0, 0, 1) * double(axis.x < 0);
  axis = axis == dvec3(0) ? dvec3(0, 1, 0) : glm::normalize(axis);
  const double length = r * std::pow(10.0, hard ? uniform(-2, 4) : uniform(-1, 1.5));
  const auto p0 = floats(c - 0.5 * length * axis), p1 = floats(c + 0.5 * length * axis);
  const auto radius = static_cast<float>(r);
  switch (shape) {
    case shape_sphere:
      return make_sphere(floats(c), radius);
    case shape_capsule:
      return make_capsule(p0, p1, radius);
    case shape_tapered_capsule: {
      const auto r1 = static_cast<float>(r * (below(6) == 0 ? 0.0 : uniform(0, 1)));
      return below(2) == 0 ? make_tapered(p0, p1, radius, r1) : make_tapered(p0, p1, r1, radius);
    }
    case shape_triangle: {
      const double thin = hard ? std::pow(10.0, uniform(-3, 0)) : 1;
      const dvec3 side = any_perpendicular(axis);
      return make_triangle(floats(c), floats(c + r * direction()), floats(c + r * thin * (side + 0.3 * direction())));
    }
    default: {
      auto n = floats(axis);
      return make_disk(floats(c), n, radius);
    }
  }
}

int test_scale() {
  const char* text = std::getenv("CAPLET_TEST_SCALE");
  return text ? std::clamp(std::atoi(text), 1, 1000) : 1;
}

Extent extent_of(const FlatPrimitive& p) {
  const reference::Ball ball = reference::bounding_ball(witness_of(p));
  double reach = 2 * ball.radius;
  if (p.shape == shape_triangle)
    reach = glm::length(point(p.data + 3) - point(p.data)) + glm::length(point(p.data + 6) - point(p.data));
  return {ball.center, ball.radius, reach};
}

dvec3 CaseMaker::surface_point(const FlatPrimitive& p, dvec3* normal) {
  const float* d = p.data;
  *normal = direction();
  switch (p.shape) {
    case shape_sphere:
      return point(d) + double(d[3]) * *normal;
    case shape_triangle: {
      double b1 = uniform(0, 1), b2 = uniform(0, 1);
      if (b1 + b2 > 1) b1 = 1 - b1, b2 = 1 - b2;
      if (below(4) == 0) b1 = 0;
      if (below(4) == 0) b2 = 1 - b1;
      const dvec3 e1 = point(d + 3) - point(d), e2 = point(d + 6) - point(d);
      *normal = glm::normalize(glm::cross(e1, e2));
      return point(d) + b1 * e1 + b2 * e2;
    }
    case shape_disk: {
      *normal = glm::normalize(point(d + 3));
      const dvec3 u = any_perpendicular(*normal), v = glm::cross(*normal, u);
      const double phi = uniform(0, 6.283185307179586), r = double(d[6]) * (below(3) == 0 ? 1 : std::sqrt(uniform(0, 1)));
      return point(d) + r * (std::cos(phi) * u + std::sin(phi) * v);
    }
    default: {
      // A ball of the hull touches it where its normal has the tangent cone's angle; at the ends anywhere beyond.
      const double r0 = d[6], r1 = p.shape == shape_capsule ? r0 : double(d[7]);
      const dvec3 axis = point(d + 3) - point(d);
      const double length = glm::length(axis), k = length > 0 ? (r0 - r1) / length : 2;
      if (std::abs(k) >= 1) return r0 > r1 ? point(d) + r0 * *normal : point(d + 3) + r1 * *normal;
      const dvec3 m = axis / length;
      const double along = glm::dot(*normal, m);
      double s = below(4) == 0 ? 0 : below(3) == 0 ? 1 : uniform(0, 1);
      if (s == 0 && along < k && below(2) == 0) return point(d) + r0 * *normal;
      if (s == 1 && along > k && below(2) == 0) return point(d + 3) + r1 * *normal;
      *normal = k * m + std::sqrt(1 - k * k) * glm::normalize(*normal - along * m);
      return point(d) + s * axis + (r0 + s * (r1 - r0)) * *normal;
    }
  }
}

RayRecord CaseMaker::ray(const FlatPrimitive& p) {
  const Extent extent = extent_of(p);
  dvec3 n;
  const dvec3 on = surface_point(p, &n);
  const double size = std::max(extent.radius, 1e-30);
  // Shapes are thin: aim near a surface point, within the local radius or so.
  const dvec3 aim = on + (below(2) == 0 ? 0.0 : std::pow(10.0, uniform(-6, 0))) * 0.3 * size * direction();
  dvec3 o, d;
  switch (below(8)) {
    case 0:  // from outside
      o = extent.center + size * uniform(1, 10) * direction();
      d = aim - o;
      break;
    case 1:  // far
      o = extent.center + size * std::pow(10.0, uniform(1, 4)) * direction();
      d = on - o;
      break;
    case 2:  // inside (above or below open shapes)
      o = on - size * std::pow(10.0, uniform(-4, 0)) * n;
      d = direction();
      break;
    case 3:  // the surface
      o = on;
      d = direction();
      break;
    case 4: {  // along a coordinate axis, with zeros of both signs
      d = dvec3(0);
      d[below(3)] = below(2) == 0 ? 1 : -1;
      if (below(2) == 0) d[below(3)] -= 0.0;
      o = aim - uniform(0, 4) * size * d;
      break;
    }
    case 5: {  // touching, or nearly
      const dvec3 across = glm::normalize(glm::cross(n, direction()));
      d = across;
      const double off = below(3) == 0 ? 0 : std::pow(10.0, uniform(-8, -1)) * (below(2) == 0 ? 1 : -1);
      o = on + off * size * n - uniform(0.1, 4) * size * across;
      break;
    }
    case 6:  // along the shape's own axis
      d = p.shape == shape_sphere ? dvec3(0, 0, 1) : point(p.data + 3) - (p.shape == shape_disk ? dvec3(0) : point(p.data));
      o = aim - uniform(0, 4) * d;
      break;
    default:  // any length of direction
      o = extent.center + size * uniform(0, 3) * direction();
      d = (aim - o) * std::pow(10.0, uniform(-3, 3));
  }
  if (glm::length(d) == 0) d = dvec3(0, 1, 0);
  return make_ray(o, d);
}

CaseSet CaseMaker::set(int shape, bool hard, int primitives, int rays_each) {
  CaseSet out;
  for (int i = 0; i < primitives; ++i) {
    out.primitives.push_back(primitive(shape, hard));
    for (int j = 0; j < rays_each; ++j) {
      out.which.push_back(static_cast<std::uint32_t>(i));
      out.rays.push_back(ray(out.primitives.back()));
    }
  }
  return out;
}

}  // namespace caplet::test
