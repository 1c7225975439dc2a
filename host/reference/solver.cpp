// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The solver, shape by shape only where a surface is open.
#include "reference/solver.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace caplet::reference {

namespace {

using glm::dvec3;

bool usable(const Ray& ray) {
  for (int i = 0; i < 3; ++i)
    if (!std::isfinite(ray.origin[i]) || !std::isfinite(ray.direction[i])) return false;
  return ray.direction != dvec3(0);
}

// The line, measured in lengths from its point nearest to the shape's ball.
struct Line {
  dvec3 foot, unit;
  double t_foot, speed, reach;  // the shape lies within [-reach, reach] of the foot
  double miss_distance;         // between the line and the ball; <= 0: it goes through
};

Line line_near(const Primitive& primitive, const Ray& ray) {
  const Ball ball = bounding_ball(primitive);
  Line line;
  // Scaled first, so that no direction's square overflows or vanishes.
  const double largest = std::max({std::abs(ray.direction.x), std::abs(ray.direction.y), std::abs(ray.direction.z)});
  const dvec3 scaled = ray.direction / largest;
  line.unit = scaled / glm::length(scaled);
  line.speed = glm::length(scaled) * largest;
  double along = glm::dot(ball.center - ray.origin, line.unit);
  line.foot = ray.origin + along * line.unit;
  along += glm::dot(ball.center - line.foot, line.unit);
  line.foot = ray.origin + along * line.unit;
  line.t_foot = along / line.speed;
  line.reach = ball.radius * (1 + 1e-9) + 1e-12 * (std::abs(along) + glm::length(ball.center)) + 1e-300;
  line.miss_distance = glm::length(line.foot - ball.center) - line.reach;
  return line;
}

// Halves the bracket around the least value until it is <= `enough`, surely above it (the Lipschitz bound), or cannot be
// narrowed. Returns where, and the value there.
std::pair<double, double> descend(const Primitive& primitive, const Line& line, double enough) {
  const auto f = [&](double s) { return value(primitive, line.foot + s * line.unit); };
  double low = -line.reach, middle = 0, high = line.reach, at_middle = f(0);
  while (at_middle > enough) {
    if (at_middle - std::max(high - middle, middle - low) > enough && enough > -HUGE_VAL) break;
    const double left = 0.5 * (low + middle), right = 0.5 * (middle + high);
    if (left <= low || left >= middle || right <= middle || right >= high) break;
    const double at_left = f(left), at_right = f(right);
    if (at_left < at_middle && at_left <= at_right) {
      high = std::exchange(middle, left);
      at_middle = at_left;
    } else if (at_right < at_middle) {
      low = std::exchange(middle, right);
      at_middle = at_right;
    } else {
      low = left;
      high = right;
    }
  }
  return {middle, at_middle};
}

// Where the value changes sign between `outside` (> 0) and `inside` (<= 0).
double bisect(const Primitive& primitive, const Line& line, double outside, double inside) {
  for (;;) {
    const double middle = 0.5 * (outside + inside);
    if (middle == outside || middle == inside) return inside;
    (value(primitive, line.foot + middle * line.unit) > 0 ? outside : inside) = middle;
  }
}

std::vector<Crossing> solid_crossings(const Primitive& primitive, const Ray& ray) {
  const Line line = line_near(primitive, ray);
  if (line.miss_distance > 0) return {};
  const auto [inside, least] = descend(primitive, line, 0);
  if (least > 0) return {};
  const double enter = bisect(primitive, line, -line.reach, inside);
  const double leave = bisect(primitive, line, line.reach, inside);
  return {{line.t_foot + enter / line.speed, false}, {line.t_foot + leave / line.speed, true}};
}

// Six times the signed volume of the tetrahedron a b c and the origin.
double volume(const dvec3& a, const dvec3& b, const dvec3& c) { return glm::dot(a, glm::cross(b, c)); }

std::vector<Crossing> triangle_crossings(const Triangle& triangle, const Ray& ray) {
  const Line line = line_near(triangle, ray);
  if (line.miss_distance > 0) return {};
  const dvec3 a = triangle.v0 - line.foot, b = triangle.v1 - line.foot, c = triangle.v2 - line.foot;
  const double edge[3] = {volume(line.unit, a, b), volume(line.unit, b, c), volume(line.unit, c, a)};
  const bool positive = edge[0] >= 0 && edge[1] >= 0 && edge[2] >= 0;
  const bool negative = edge[0] <= 0 && edge[1] <= 0 && edge[2] <= 0;
  const double sum = edge[0] + edge[1] + edge[2];
  // Seen edge-on as far as doubles can tell (each volume is a sum of six products of three rounded factors): no crossing.
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  if (!(positive || negative) || std::abs(sum) <= 0x1p-49 * (la * lb + lb * lc + lc * la)) return {};
  return {{line.t_foot + volume(a, b, c) / sum / line.speed, false}};
}

std::vector<Crossing> disk_crossings(const Disk& disk, const Ray& ray) {
  const Line line = line_near(disk, ray);
  const double slope = glm::dot(disk.normal, line.unit);
  if (line.miss_distance > 0 || slope == 0) return {};
  const double s = glm::dot(disk.normal, disk.center - line.foot) / slope;
  if (!(glm::length(line.foot + s * line.unit - disk.center) <= disk.radius)) return {};
  return {{line.t_foot + s / line.speed, false}};
}

double distance_line_to_segment(const Line& line, const dvec3& a, const dvec3& b) {
  // Seen along the line, the segment is one in the plane and the line its origin.
  const dvec3 pa = a - line.foot - glm::dot(a - line.foot, line.unit) * line.unit;
  const dvec3 pb = b - line.foot - glm::dot(b - line.foot, line.unit) * line.unit;
  return value(Capsule{pa, pb, 0, 0}, dvec3(0));
}

// Distance between the line and a circle: sampled, then refined around the best sample.
double distance_line_to_circle(const Line& line, const Disk& disk) {
  const dvec3 n = glm::normalize(disk.normal);
  const dvec3 u = glm::normalize(glm::cross(n, std::abs(n.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0))), v = glm::cross(n, u);
  const auto distance = [&](double angle) {
    const dvec3 p = disk.center + disk.radius * (std::cos(angle) * u + std::sin(angle) * v) - line.foot;
    return glm::length(p - glm::dot(p, line.unit) * line.unit);
  };
  constexpr int samples = 4096;
  constexpr double step = 6.283185307179586 / samples;
  double best = 0;
  for (int i = 1; i < samples; ++i)
    if (distance(i * step) < distance(best)) best = i * step;
  for (double width = step; width > 1e-15; width *= 0.5)
    for (const double angle : {best - width, best + width})
      if (distance(angle) < distance(best)) best = angle;
  return distance(best);
}

}  // namespace

std::vector<Crossing> crossings(const Primitive& primitive, const Ray& ray) {
  if (!usable(ray)) return {};
  if (const auto* triangle = std::get_if<Triangle>(&primitive)) return triangle_crossings(*triangle, ray);
  if (const auto* disk = std::get_if<Disk>(&primitive)) return disk_crossings(*disk, ray);
  return solid_crossings(primitive, ray);
}

std::optional<Crossing> closest(const Primitive& primitive, const Ray& ray) {
  for (const Crossing& crossing : crossings(primitive, ray))
    if (crossing.t > ray.t_min && crossing.t < ray.t_max) return crossing;
  return std::nullopt;
}

double margin(const Primitive& primitive, const Ray& ray) {
  const Line line = line_near(primitive, ray);
  double distance;
  if (const auto* triangle = std::get_if<Triangle>(&primitive)) {
    distance = std::min({distance_line_to_segment(line, triangle->v0, triangle->v1),
                         distance_line_to_segment(line, triangle->v1, triangle->v2),
                         distance_line_to_segment(line, triangle->v2, triangle->v0)});
  } else if (const auto* disk = std::get_if<Disk>(&primitive)) {
    distance = distance_line_to_circle(line, *disk);
  } else {
    return -descend(primitive, line, -HUGE_VAL).second;
  }
  return crossings(primitive, ray).empty() ? -distance : distance;
}

Verdict referee(const Primitive& primitive, const Ray& ray, double tolerance) {
  if (!usable(ray)) return Verdict::miss;
  if (!is_solid(primitive)) {
    const double m = margin(primitive, ray);
    return m > tolerance ? Verdict::hit : m < -tolerance ? Verdict::miss : Verdict::tangent;
  }
  const Line line = line_near(primitive, ray);
  // Everywhere first, then ever closer around the least sample.
  double least = HUGE_VAL, where = 0, low = -line.reach, high = line.reach;
  for (const int samples : {2048, 64, 64, 64, 64, 64}) {
    const double step = (high - low) / samples;
    for (int i = 0; i <= samples; ++i) {
      const double s = low + i * step, f = value(primitive, line.foot + s * line.unit);
      if (f < least) least = f, where = s;
    }
    low = where - 2 * step;
    high = where + 2 * step;
  }
  return least < -tolerance ? Verdict::hit : least > tolerance ? Verdict::miss : Verdict::tangent;
}

}  // namespace caplet::reference
