// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/area.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "lower/flat_shapes.h"
#include "scene/scene.h"
#include "shared/kinds.h"

namespace caplet {

namespace {

using glm::dvec3;

constexpr double pi = std::numbers::pi;

double length3(const float* a, const float* b) { return glm::length(dvec3(b[0], b[1], b[2]) - dvec3(a[0], a[1], a[2])); }

}  // namespace

namespace {

struct End {
  double radius;
  float cap;
};

/// What a flat end adds. Round ones have no disk, open ones none that is seen.
double disk_area(const End& end) { return end.cap == CAPLET_CAP_FLAT ? pi * end.radius * end.radius : 0; }

/// The hull of a disk (or the rim of an open end) of radius `rim` and a ball at a distance `length` along its axis: tangents from
/// the rim touch the ball at `angle` to either side of the rim's direction, as seen from the centre.
double disk_and_ball_area(const End& disk, double length, double ball) {
  const double rim = disk.radius, apart = std::hypot(rim, length);
  if (apart <= ball) return 4 * pi * ball * ball;  // the ball holds the disk
  const double tangent = std::sqrt(apart * apart - ball * ball), c = ball / apart, s = tangent / apart;
  // Height and distance from the axis of the unit normals where the tangents touch.
  const double front = (-length * c + rim * s) / apart, front_off = (rim * c + length * s) / apart;
  double area = pi * (rim + ball * front_off) * tangent + 2 * pi * ball * ball * (1 - front);
  if (length >= ball) return area + disk_area(disk);
  // The ball reaches through the disk, which is inside then; behind it the hull has a second cone.
  const double back = (-length * c - rim * s) / apart, back_off = (rim * c - length * s) / apart;
  return area + pi * (rim + ball * back_off) * tangent + 2 * pi * ball * ball * (1 + back);
}

/// The hull of two balls: both caps, and the cone between the circles where it touches them. `s` and `c`: sine and cosine of its
/// half angle.
double two_balls_area(double length, double r0, double r1) {
  const double taper = r0 - r1;
  if (length <= std::abs(taper)) return 4 * pi * std::max(r0, r1) * std::max(r0, r1);
  const double s = taper / length, c = std::sqrt(1 - s * s);
  return 2 * pi * (r0 * r0 * (1 + s) + r1 * r1 * (1 - s)) + pi * (r0 + r1) * c * length * c;
}

/// Cylinders and cones.
double hull_area(double length, const End& end0, const End& end1) {
  const bool round0 = end0.cap == CAPLET_CAP_ROUND, round1 = end1.cap == CAPLET_CAP_ROUND;
  if (round0 && round1) return two_balls_area(length, end0.radius, end1.radius);
  if (round0) return disk_and_ball_area(end1, length, end0.radius);
  if (round1) return disk_and_ball_area(end0, length, end1.radius);
  return pi * (end0.radius + end1.radius) * std::hypot(length, end0.radius - end1.radius) + disk_area(end0) + disk_area(end1);
}

/// Along the normal, as long as the area is large.
dvec3 polygon_area(const std::vector<dvec3>& corners) {
  dvec3 sum(0);
  for (std::size_t i = 2; i < corners.size(); ++i) sum += glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
  return 0.5 * sum;
}

std::vector<std::vector<dvec3>> faces_of_polyhedron(const float* head) {
  PolyhedronShape planes;
  const auto count = std::bit_cast<std::uint32_t>(head[3]);
  for (std::uint32_t i = 0; i < count; ++i) {
    const float* plane = head + 8 + 4 * i;
    planes.normals.emplace_back(plane[0], plane[1], plane[2]);
    planes.points.push_back(double(plane[3]) * planes.normals.back());
  }
  return polyhedron_faces(planes);
}

double polyhedron_area(const float* head) {
  double area = 0;
  for (const auto& face : faces_of_polyhedron(head)) area += glm::length(polygon_area(face));
  return area;
}

/// dp/du x dp/dv is n0 + u n1 + v n2: its length, summed by Simpson's rule over 32 x 32 cells. Relative error 1e-8 where it
/// vanishes nowhere near the patch, 1e-3 where the patch is folded or has a corner of 180 degrees.
double bilinear_area(const float* d, const glm::dmat3& m) {
  const dvec3 p00(d[0], d[1], d[2]), p10(d[3], d[4], d[5]), p01(d[6], d[7], d[8]), p11(d[9], d[10], d[11]);
  const dvec3 u = m * (p10 - p00), v = m * (p01 - p00), twist = m * (p11 - p01) - u;
  const dvec3 n0 = glm::cross(u, v), n1 = glm::cross(u, twist), n2 = glm::cross(twist, v);
  constexpr int n = 64;
  const auto weight = [](int i) { return i == 0 || i == n ? 1.0 : i % 2 == 0 ? 2.0 : 4.0; };
  double sum = 0;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) sum += weight(i) * weight(j) * glm::length(n0 + (double(i) / n) * n1 + (double(j) / n) * n2);
  return sum / (9.0 * n * n);
}

}  // namespace

double primitive_area(const FlatPrimitive& p, const std::vector<float>& leaves) {
  const float* d = p.data;
  switch (p.shape) {
    case shape_sphere:
      return 4 * pi * d[3] * d[3];
    case shape_capsule:
      return 2 * pi * d[6] * length3(d, d + 3) + 4 * pi * d[6] * d[6];
    case shape_tapered_capsule:
      return two_balls_area(length3(d, d + 3), d[6], d[7]);
    case shape_cylinder:
      return hull_area(length3(d, d + 3), {d[6], d[7]}, {d[6], d[8]});
    case shape_cone:
      return hull_area(length3(d, d + 3), {d[6], d[8]}, {d[7], d[9]});
    case shape_polyhedron:
      return polyhedron_area(&leaves[std::bit_cast<std::uint32_t>(d[0])]);
    case shape_bilinear:
      return bilinear_area(d, glm::dmat3(1));
    case shape_triangle: {
      const dvec3 a(d[0], d[1], d[2]), b(d[3], d[4], d[5]), c(d[6], d[7], d[8]);
      return 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    case shape_disk:
      return pi * d[6] * d[6];
    case shape_partial_sphere:
      return d[3] * d[0] * (std::min(d[2], d[0]) - std::max(d[1], -d[0]));
    case shape_open_cylinder:
      return d[3] * d[0] * (d[2] - d[1]);
    case shape_partial_disk:
      return 0.5 * d[3] * (d[1] * d[1] - d[2] * d[2]);
    case shape_box: {
      const double x = d[3] - d[0], y = d[4] - d[1], z = d[5] - d[2];
      return 2 * (x * y + y * z + z * x);
    }
    default:
      return 0;
  }
}

namespace {

/// A part of a primitive's surface whose image has an area of its own kind. With d = `axis` (unit), e(phi) around it from
/// `start`:
struct Piece {
  enum Kind {
    flat,  // of area and normal `axis` (not unit)
    side,  // of a cone or cylinder: area `amount`, normals low d + sqrt(1 - low^2) e(phi)
    zone   // of a sphere of squared radius `amount`: normals h d + sqrt(1 - h^2) e(phi), low <= h <= high
  } kind;
  std::uint32_t surface;
  dvec3 axis;
  double amount = 0, low = 0, high = 0, phi_max = 2 * pi;
  dvec3 start{0};
};

dvec3 point3(const float* d) { return {d[0], d[1], d[2]}; }

class Pieces {
 public:
  Pieces(const FlatPrimitive& p, const std::vector<float>& leaves) { add(p, leaves); }
  const std::vector<Piece>& all() const { return all_; }

 private:
  void flat(std::uint32_t surface, const dvec3& area) { all_.push_back({Piece::flat, surface, area}); }
  void round(Piece::Kind kind, std::uint32_t surface, const dvec3& axis, double amount, double low, double high = 0) {
    if (!(amount > 0)) return;
    all_.push_back({kind, surface, axis, amount, low, high, 2 * pi, dvec3(0)});
  }
  void part(Piece::Kind kind, double amount, double low, double high, double phi_max) {
    all_.push_back({kind, 0, dvec3(0, 0, 1), amount, low, high, phi_max, dvec3(1, 0, 0)});
  }

  /// As two_balls_area, between centres `length` apart along `axis`.
  void two_balls(const dvec3& axis, double length, double r0, double r1, const std::array<std::uint32_t, 3>& surfaces) {
    const double taper = r0 - r1;
    if (length <= std::abs(taper))
      return round(Piece::zone, surfaces[r0 >= r1 ? 1 : 2], axis, std::max(r0, r1) * std::max(r0, r1), -1, 1);
    const double s = taper / length, c = std::sqrt(1 - s * s);
    round(Piece::zone, surfaces[1], axis, r0 * r0, -1, s);
    round(Piece::zone, surfaces[2], axis, r1 * r1, s, 1);
    round(Piece::side, surfaces[0], axis, pi * (r0 + r1) * c * length * c, s);
  }

  /// As disk_and_ball_area; `axis` from the disk to the ball.
  void disk_and_ball(const dvec3& axis, double length, const End& disk, std::uint32_t disk_surface, double ball,
                     std::uint32_t ball_surface) {
    const double rim = disk.radius, apart = std::hypot(rim, length);
    if (apart <= ball) return round(Piece::zone, ball_surface, axis, ball * ball, -1, 1);
    const double tangent = std::sqrt(apart * apart - ball * ball), c = ball / apart, s = tangent / apart;
    const double front = (-length * c + rim * s) / apart, front_off = (rim * c + length * s) / apart;
    round(Piece::side, 0, axis, pi * (rim + ball * front_off) * tangent, front);
    round(Piece::zone, ball_surface, axis, ball * ball, front, 1);
    if (length >= ball) return flat(disk_surface, -disk_area(disk) * axis);
    const double back = (-length * c - rim * s) / apart, back_off = (rim * c - length * s) / apart;
    round(Piece::side, 0, axis, pi * (rim + ball * back_off) * tangent, back);
    round(Piece::zone, ball_surface, axis, ball * ball, -1, back);
  }

  void hull(const float* d, const End& end0, const End& end1) {
    const dvec3 along = point3(d + 3) - point3(d);
    const double length = glm::length(along);
    const dvec3 axis = length > 0 ? along / length : dvec3(0, 0, 1);
    const bool round0 = end0.cap == CAPLET_CAP_ROUND, round1 = end1.cap == CAPLET_CAP_ROUND;
    if (round0 && round1) return two_balls(axis, length, end0.radius, end1.radius, {0, 1, 2});
    if (round0) return disk_and_ball(-axis, length, end1, 2, end0.radius, 1);
    if (round1) return disk_and_ball(axis, length, end0, 1, end1.radius, 2);
    const double taper = end0.radius - end1.radius, slant = std::hypot(length, taper);
    round(Piece::side, 0, axis, pi * (end0.radius + end1.radius) * slant, slant > 0 ? taper / slant : 0);
    flat(1, -disk_area(end0) * axis);
    flat(2, disk_area(end1) * axis);
  }

  void add(const FlatPrimitive& p, const std::vector<float>& leaves) {
    const float* d = p.data;
    switch (p.shape) {
      case shape_sphere:
        return round(Piece::zone, 0, {0, 0, 1}, double(d[3]) * d[3], -1, 1);
      case shape_capsule:
      case shape_tapered_capsule: {
        const dvec3 along = point3(d + 3) - point3(d);
        const double length = glm::length(along);
        return two_balls(length > 0 ? along / length : dvec3(0, 0, 1), length, d[6], p.shape == shape_capsule ? d[6] : d[7],
                         {0, 0, 0});
      }
      case shape_cylinder:
        return hull(d, {d[6], d[7]}, {d[6], d[8]});
      case shape_cone:
        return hull(d, {d[6], d[8]}, {d[7], d[9]});
      case shape_polyhedron: {
        const auto faces = faces_of_polyhedron(&leaves[std::bit_cast<std::uint32_t>(d[0])]);
        for (std::size_t i = 0; i < faces.size(); ++i) flat(static_cast<std::uint32_t>(i), polygon_area(faces[i]));
        return;
      }
      case shape_triangle:
        return flat(0, 0.5 * glm::cross(point3(d + 3) - point3(d), point3(d + 6) - point3(d)));
      case shape_disk:
        return flat(0, pi * d[6] * d[6] * point3(d + 3));
      case shape_partial_sphere: {
        const double r = d[0];
        return part(Piece::zone, r * r, std::max<double>(d[1], -r) / r, std::min<double>(d[2], r) / r, d[3]);
      }
      case shape_open_cylinder:
        return part(Piece::side, d[3] * d[0] * (d[2] - d[1]), 0, 0, d[3]);
      case shape_partial_disk:
        return flat(0, {0, 0, 0.5 * d[3] * (d[1] * d[1] - d[2] * d[2])});
      case shape_box: {
        const dvec3 size = point3(d + 3) - point3(d);
        for (std::uint32_t face = 0; face < 6; ++face) {
          const int k = static_cast<int>(face / 2);
          dvec3 area(0);
          area[k] = size[(k + 1) % 3] * size[(k + 2) % 3];
          flat(face, area);
        }
        return;
      }
      default:
        return;
    }
  }

  std::vector<Piece> all_;
};

/// Nodes and weights of Gauss's rule of 2^k points on [-1, 1], by Newton's method on Legendre's polynomials.
struct GaussRule {
  std::vector<double> x, w;
  explicit GaussRule(int n) {
    for (int i = 0; i < n; ++i) {
      double at = std::cos(pi * (i + 0.75) / (n + 0.5)), slope = 1;
      for (int step = 0; step < 100; ++step) {
        double last = 1, value = at;
        for (int k = 2; k <= n; ++k) {
          const double next = ((2 * k - 1) * at * value - (k - 1) * last) / k;
          last = value;
          value = next;
        }
        slope = n * (at * value - last) / (at * at - 1);
        const double move = value / slope;
        at -= move;
        if (std::abs(move) < 1e-15) break;
      }
      x.push_back(at);
      w.push_back(2 / ((1 - at * at) * slope * slope));
    }
  }
};
constexpr int least_points = 8, most_points = 512;
const GaussRule& gauss_rule(int points) {
  static const std::vector<GaussRule> rules = [] {
    std::vector<GaussRule> all;
    for (int n = least_points; n <= most_points; n *= 2) all.emplace_back(n);
    return all;
  }();
  return rules[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(points / least_points)))];
}

/// The image of a piece by `points` directions around the axis: trapezoids around the whole circle, whose error falls
/// geometrically for periodic analytic functions, and Gauss's rule elsewhere.
double round_area(const Piece& piece, const glm::dmat3& cofactor, int points) {
  const dvec3 s = piece.start != dvec3(0)
                      ? piece.start
                      : glm::normalize(glm::cross(piece.axis, std::abs(piece.axis.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
  const dvec3 axis = cofactor * piece.axis, x = cofactor * s, y = cofactor * glm::cross(piece.axis, s);
  const GaussRule& rule = gauss_rule(points);
  const double from = std::acos(piece.high), to = std::acos(piece.low);
  // The integral over the piece's unit normals at phi, or their mean.
  const auto along = [&](const dvec3& across) {
    if (piece.kind == Piece::side) return glm::length(piece.low * axis + std::sqrt(1 - piece.low * piece.low) * across);
    double sum = 0;
    for (std::size_t i = 0; i < rule.x.size(); ++i) {
      const double theta = 0.5 * (from + to + (to - from) * rule.x[i]), sine = std::sin(theta);
      sum += rule.w[i] * sine * glm::length(std::cos(theta) * axis + sine * across);
    }
    return 0.5 * (to - from) * sum;
  };
  const bool whole = piece.phi_max >= full_turn * (1 - 1e-6);
  double sum = 0;
  for (int j = 0; j < points; ++j) {
    const auto i = static_cast<std::size_t>(j);
    const double phi = whole ? 2 * pi * j / points : 0.5 * piece.phi_max * (1 + rule.x[i]);
    sum += (whole ? 1.0 / points : 0.5 * rule.w[i]) * along(std::cos(phi) * x + std::sin(phi) * y);
  }
  return piece.amount * sum * (piece.kind == Piece::zone ? std::min(piece.phi_max, 2 * pi) : 1);
}

double image_area(const Piece& piece, const glm::dmat3& cofactor) {
  if (piece.kind == Piece::flat) return glm::length(cofactor * piece.axis);
  double last = round_area(piece, cofactor, least_points);
  for (int points = 2 * least_points; points <= most_points; points *= 2) {
    const double next = round_area(piece, cofactor, points);
    if (std::abs(next - last) <= 1e-10 * next) return next;
    last = next;
  }
  return last;
}

}  // namespace

double placed_area(const FlatPrimitive& p, const std::vector<float>& leaves, const glm::dmat4& m,
                   std::span<const std::uint32_t> surfaces) {
  const glm::dmat3 a(m);
  if (const double scale = similarity_scale(m); scale > 0 && surfaces.empty()) return primitive_area(p, leaves) * (scale * scale);
  const auto counted = [&](std::uint32_t surface) {
    return surfaces.empty() || std::ranges::find(surfaces, surface) != surfaces.end();
  };
  if (p.shape == shape_bilinear) return counted(0) ? bilinear_area(p.data, a) : 0;
  const glm::dmat3 cofactor = glm::transpose(glm::inverse(a)) * std::abs(glm::determinant(a));
  const Pieces pieces(p, leaves);
  double area = 0;
  for (const Piece& piece : pieces.all())
    if (counted(piece.surface)) area += image_area(piece, cofactor);
  return area;
}

}  // namespace caplet
