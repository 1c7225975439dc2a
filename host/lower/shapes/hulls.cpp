// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Cylinders, cones and capsules share these functions for hulls of two ends.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "lower/detail/shapes.h"

namespace caplet {

namespace {

using glm::dvec3;

using std::numbers::pi;

/// Returns the area that a flat end adds. Round ends have no disk, open ones none that is seen.
double disk_area_of(const HullEnd& end) {
  return end.cap == CAPLET_CAP_FLAT ? pi * end.radius * end.radius : 0;
}

/// Returns the area of the hull of a disk (or the rim of an open end) of radius `rim` and a ball at
/// a distance `length` along its axis: tangents from the rim touch the ball at `angle` to either
/// side of the rim's direction, as seen from the centre.
double disk_and_ball_area(const HullEnd& disk, double length, double ball) {
  const double rim = disk.radius, apart = std::hypot(rim, length);
  if (apart <= ball) return 4 * pi * ball * ball;  // the ball holds the disk
  const double tangent = std::sqrt(apart * apart - ball * ball), c = ball / apart,
               s = tangent / apart;
  // These are height and distance from the axis of the unit normals where the tangents touch.
  const double front = (-length * c + rim * s) / apart, front_off = (rim * c + length * s) / apart;
  double area = pi * (rim + ball * front_off) * tangent + 2 * pi * ball * ball * (1 - front);
  if (length >= ball) return area + disk_area_of(disk);
  // The ball reaches through the disk, which is then inside; behind it the hull has a second cone.
  const double back = (-length * c - rim * s) / apart, back_off = (rim * c - length * s) / apart;
  return area + pi * (rim + ball * back_off) * tangent + 2 * pi * ball * ball * (1 + back);
}

/// Returns by how much the radius of a flat end grows when the side of slope `k` (radius lost a
/// unit of height towards the other end) and the end itself move out by `b`: where the two moved
/// lines meet.
double rim_growth(double k, double b) { return b * (std::sqrt(1 + k * k) + k); }

/// Returns the radius lost a unit of height, seen from a flat end of radius `flat` across `length`
/// to a ball of radius `round`: the tangent from the rim to the ball.
double slope_to_ball(double flat, double round, double length) {
  const double distance = std::hypot(flat, length);
  return distance > round ? -std::tan(std::asin(round / distance) - std::atan2(flat, length)) : 0;
}

}  // namespace

/// Returns the area of the hull of two balls: both caps, and the cone between the circles where it
/// touches them. `s` and `c`: sine and cosine of its half angle.
double two_balls_area(double length, double r0, double r1) {
  const double taper = r0 - r1;
  if (length <= std::abs(taper)) return 4 * pi * std::max(r0, r1) * std::max(r0, r1);
  const double s = taper / length, c = std::sqrt(1 - s * s);
  return 2 * pi * (r0 * r0 * (1 + s) + r1 * r1 * (1 - s)) + pi * (r0 + r1) * c * length * c;
}

/// Returns the area of cylinders and cones.
double hull_area(double length, const HullEnd& end0, const HullEnd& end1) {
  const bool round0 = end0.cap == CAPLET_CAP_ROUND, round1 = end1.cap == CAPLET_CAP_ROUND;
  if (round0 && round1) return two_balls_area(length, end0.radius, end1.radius);
  if (round0) return disk_and_ball_area(end1, length, end0.radius);
  if (round1) return disk_and_ball_area(end0, length, end1.radius);
  return pi * (end0.radius + end1.radius) * std::hypot(length, end0.radius - end1.radius) +
         disk_area_of(end0) + disk_area_of(end1);
}

// A flat end is a disk across the axis.
ExactBox hull_box(const float* p0, const float* p1, const HullEnd& end0, const HullEnd& end1) {
  const double axis[3] = {double(p1[0]) - double(p0[0]), double(p1[1]) - double(p0[1]),
                          double(p1[2]) - double(p0[2])};
  const double squared = axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2];
  ExactBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    const double across =
        squared > 0 ? std::sqrt(std::max(0.0, 1 - axis[k] * axis[k] / squared)) : 1;
    const double half0 = end0.radius * (end0.cap == CAPLET_CAP_ROUND ? 1 : across);
    const double half1 = end1.radius * (end1.cap == CAPLET_CAP_ROUND ? 1 : across);
    box.min[k] = std::min(double(p0[k]) - half0, double(p1[k]) - half1);
    box.max[k] = std::max(double(p0[k]) + half0, double(p1[k]) + half1);
  }
  return box;
}

GrownHull grown_hull(const float* end_p0, const float* end_p1, const HullEnd& end0,
                     const HullEnd& end1, double b) {
  const double r0 = end0.radius, r1 = end1.radius;
  const bool round0 = end0.cap == CAPLET_CAP_ROUND, round1 = end1.cap == CAPLET_CAP_ROUND;
  const dvec3 p0 = point3(end_p0), p1 = point3(end_p1);
  const double length = glm::length(p1 - p0);
  const dvec3 axis = length > 0 ? (p1 - p0) / length : dvec3(0);
  const double k = !(length > 0)      ? 0
                   : round0 == round1 ? (r0 - r1) / length
                   : round1           ? slope_to_ball(r0, r1, length)
                                      : -slope_to_ball(r1, r0, length);
  return {round0 ? p0 : p0 - b * axis, round1 ? p1 : p1 + b * axis,
          r0 + (round0 ? b : rim_growth(k, b)), r1 + (round1 ? b : rim_growth(-k, b))};
}

void Pieces::flat(std::uint32_t surface, const dvec3& area) {
  all_.push_back({Piece::flat, surface, area});
}

void Pieces::round(Piece::Kind kind, std::uint32_t surface, const dvec3& axis, double amount,
                   double low, double high) {
  if (!(amount > 0)) return;
  all_.push_back({kind, surface, axis, amount, low, high, 2 * pi, dvec3(0)});
}

void Pieces::part(Piece::Kind kind, double amount, double low, double high, double phi_max) {
  all_.push_back({kind, 0, dvec3(0, 0, 1), amount, low, high, phi_max, dvec3(1, 0, 0)});
}

void Pieces::balls(const float* p0, const float* p1, double r0, double r1,
                   const std::array<std::uint32_t, 3>& surfaces) {
  const dvec3 along = point3(p1) - point3(p0);
  const double length = glm::length(along);
  two_balls(length > 0 ? along / length : dvec3(0, 0, 1), length, r0, r1, surfaces);
}

/// Adds the pieces of two_balls_area, between centres `length` apart along `axis`.
void Pieces::two_balls(const dvec3& axis, double length, double r0, double r1,
                       const std::array<std::uint32_t, 3>& surfaces) {
  const double taper = r0 - r1;
  if (length <= std::abs(taper))
    return round(Piece::zone, surfaces[r0 >= r1 ? 1 : 2], axis, std::max(r0, r1) * std::max(r0, r1),
                 -1, 1);
  const double s = taper / length, c = std::sqrt(1 - s * s);
  round(Piece::zone, surfaces[1], axis, r0 * r0, -1, s);
  round(Piece::zone, surfaces[2], axis, r1 * r1, s, 1);
  round(Piece::side, surfaces[0], axis, pi * (r0 + r1) * c * length * c, s);
}

/// Adds the pieces of disk_and_ball_area; `axis` from the disk to the ball.
void Pieces::disk_and_ball(const dvec3& axis, double length, const HullEnd& disk,
                           std::uint32_t disk_surface, double ball, std::uint32_t ball_surface) {
  const double rim = disk.radius, apart = std::hypot(rim, length);
  if (apart <= ball) return round(Piece::zone, ball_surface, axis, ball * ball, -1, 1);
  const double tangent = std::sqrt(apart * apart - ball * ball), c = ball / apart,
               s = tangent / apart;
  const double front = (-length * c + rim * s) / apart, front_off = (rim * c + length * s) / apart;
  round(Piece::side, 0, axis, pi * (rim + ball * front_off) * tangent, front);
  round(Piece::zone, ball_surface, axis, ball * ball, front, 1);
  if (length >= ball) return flat(disk_surface, -disk_area_of(disk) * axis);
  const double back = (-length * c - rim * s) / apart, back_off = (rim * c - length * s) / apart;
  round(Piece::side, 0, axis, pi * (rim + ball * back_off) * tangent, back);
  round(Piece::zone, ball_surface, axis, ball * ball, -1, back);
}

void Pieces::hull(const float* p0, const float* p1, const HullEnd& end0, const HullEnd& end1) {
  const dvec3 along = point3(p1) - point3(p0);
  const double length = glm::length(along);
  const dvec3 axis = length > 0 ? along / length : dvec3(0, 0, 1);
  const bool round0 = end0.cap == CAPLET_CAP_ROUND, round1 = end1.cap == CAPLET_CAP_ROUND;
  if (round0 && round1) return two_balls(axis, length, end0.radius, end1.radius, {0, 1, 2});
  if (round0) return disk_and_ball(-axis, length, end1, 2, end0.radius, 1);
  if (round1) return disk_and_ball(axis, length, end0, 1, end1.radius, 2);
  const double taper = end0.radius - end1.radius, slant = std::hypot(length, taper);
  round(Piece::side, 0, axis, pi * (end0.radius + end1.radius) * slant,
        slant > 0 ? taper / slant : 0);
  flat(1, -disk_area_of(end0) * axis);
  flat(2, disk_area_of(end1) * axis);
}

}  // namespace caplet
