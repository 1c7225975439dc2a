// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// These are parts of spheres, tubes and disks around the z axis. The distance is that to the whole
// where its nearest point is kept, and to the rims where it is not.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "reference/detail/angles.h"
#include "reference/detail/parts.h"

namespace caplet::reference {

using glm::dvec2;
using glm::dvec3;

namespace {

double angle_of(const dvec3& x) {
  const double phi = std::atan2(x.y, x.x);
  return phi < 0 ? phi + full_turn : phi;
}

dvec3 at_angle(double phi) { return {std::cos(phi), std::sin(phi), 0}; }

const dvec3 up{0, 0, 1}, east{1, 0, 0}, north{0, 1, 0};

Curve circle(double radius, double height, double phi_max) {
  return {Curve::Kind::arc, height * up, east, north, radius, 0, std::min(phi_max, full_turn)};
}

// Returns the distance to an arc: to its circle where the nearest point's angle is kept, else to an
// end.
double distance_to(const Curve& c, const dvec3& x) {
  if (c.kind == Curve::Kind::segment) return distance_to_segment(x, c.p, c.q);
  const dvec3 w = x - c.p;
  const dvec2 plane{glm::dot(w, c.q), glm::dot(w, c.r)};
  double angle = std::atan2(plane.y, plane.x);
  if (angle < c.from) angle += full_turn;
  if (angle >= c.from && angle <= c.to)
    return std::hypot(glm::length(plane) - c.radius, glm::dot(w, glm::cross(c.q, c.r)));
  return std::min(glm::length(x - c.at(0)), glm::length(x - c.at(1)));
}

double distance_to(const std::vector<Curve>& curves, const dvec3& x) {
  double least = HUGE_VAL;
  for (const Curve& c : curves) least = std::min(least, distance_to(c, x));
  return least;
}

bool whole(double phi_max) { return phi_max >= full_turn; }

}  // namespace

bool keeps_of(const PartialSphere& s, const dvec3& x, int) {
  return (s.z_min <= -s.radius || x.z >= s.z_min) && (s.z_max >= s.radius || x.z <= s.z_max) &&
         (whole(s.phi_max) || angle_of(x) <= s.phi_max);
}
bool keeps_of(const OpenCylinder& c, const dvec3& x, int) {
  return x.z >= c.z_min && x.z <= c.z_max && (whole(c.phi_max) || angle_of(x) <= c.phi_max);
}
bool keeps_of(const PartialDisk& d, const dvec3& x, int) {
  const double r = std::hypot(x.x, x.y);
  return r <= d.radius && r >= d.inner_radius && (whole(d.phi_max) || angle_of(x) <= d.phi_max);
}

std::vector<Curve> boundary_of(const PartialSphere& s) {
  std::vector<Curve> out;
  for (const double z : {s.z_min, s.z_max})
    if (std::abs(z) < s.radius)
      out.push_back(circle(std::sqrt((s.radius - z) * (s.radius + z)), z, s.phi_max));
  if (!whole(s.phi_max)) {
    const double low = std::asin(std::clamp(s.z_min / s.radius, -1.0, 1.0));
    const double high = std::asin(std::clamp(s.z_max / s.radius, -1.0, 1.0));
    for (const double phi : {0.0, s.phi_max})
      out.push_back({Curve::Kind::arc, dvec3(0), at_angle(phi), up, s.radius, low, high});
  }
  return out;
}
std::vector<Curve> boundary_of(const OpenCylinder& c) {
  std::vector<Curve> out = {circle(c.radius, c.z_min, c.phi_max),
                            circle(c.radius, c.z_max, c.phi_max)};
  if (!whole(c.phi_max))
    for (const double phi : {0.0, c.phi_max})
      out.push_back(segment(c.radius * at_angle(phi) + c.z_min * up,
                            c.radius * at_angle(phi) + c.z_max * up));
  return out;
}
std::vector<Curve> boundary_of(const PartialDisk& d) {
  std::vector<Curve> out = {circle(d.radius, d.height, d.phi_max)};
  if (d.inner_radius > 0) out.push_back(circle(d.inner_radius, d.height, d.phi_max));
  if (!whole(d.phi_max))
    for (const double phi : {0.0, d.phi_max})
      out.push_back(segment(d.inner_radius * at_angle(phi) + d.height * up,
                            d.radius * at_angle(phi) + d.height * up));
  return out;
}

double value_of(const PartialSphere& s, const dvec3& x) {
  const double size = glm::length(x);
  const dvec3 nearest = size > 0 ? x * (s.radius / size) : at_angle(0) * s.radius;
  const double to_rims = distance_to(boundary_of(s), x);
  return keeps_of(s, nearest, 0) ? std::min(to_rims, std::abs(size - s.radius)) : to_rims;
}
double value_of(const OpenCylinder& c, const dvec3& x) {
  const double to_rims = distance_to(boundary_of(c), x);
  return keeps_of(c, x, 0) ? std::min(to_rims, std::abs(std::hypot(x.x, x.y) - c.radius)) : to_rims;
}
double value_of(const PartialDisk& d, const dvec3& x) {
  return keeps_of(d, x, 0) ? std::abs(x.z - d.height) : distance_to(boundary_of(d), x);
}

bool has_inside(const PartialSphere&) { return false; }
bool has_inside(const OpenCylinder&) { return false; }
bool has_inside(const PartialDisk&) { return false; }

Ball ball_of(const PartialSphere& s) { return {dvec3(0), s.radius}; }
Ball ball_of(const OpenCylinder& c) {
  return {dvec3(0, 0, 0.5 * (c.z_min + c.z_max)), std::hypot(c.radius, 0.5 * (c.z_max - c.z_min))};
}
Ball ball_of(const PartialDisk& d) { return {dvec3(0, 0, d.height), d.radius}; }

dvec3 sheet_normal(const PartialDisk&, const dvec3&) { return {0, 0, 1}; }

Primitive carrier_from(const PartialSphere& s) { return Sphere{dvec3(0), s.radius}; }
Primitive carrier_from(const OpenCylinder& c) {
  // The tube is longer, so that its caps never matter.
  const double more = c.radius + 0.5 * (c.z_max - c.z_min);
  return make_frustum({0, 0, c.z_min - more}, {0, 0, c.z_max + more}, {c.radius, false, false},
                      {c.radius, false, false});
}

dvec2 uv_of(const PartialSphere& s, const dvec3& x, int) {
  const auto latitude = [](double z, double across) { return std::atan2(z, across); };
  const auto at_height = [&](double z) { return std::asin(std::clamp(z / s.radius, -1.0, 1.0)); };
  const double low = at_height(s.z_min), high = at_height(s.z_max);
  return {share(angle_within(x, s.phi_max), s.phi_max),
          share(latitude(x.z, std::hypot(x.x, x.y)) - low, high - low)};
}
dvec2 uv_of(const OpenCylinder& c, const dvec3& x, int) {
  return {share(angle_within(x, c.phi_max), c.phi_max), share(x.z - c.z_min, c.z_max - c.z_min)};
}
dvec2 uv_of(const PartialDisk& d, const dvec3& x, int) {
  return {share(angle_within(x, d.phi_max), d.phi_max),
          share(d.radius - std::hypot(x.x, x.y), d.radius - d.inner_radius)};
}

std::vector<Primitive> references_of(const PartialSphereShape& s) {
  return {PartialSphere{s.radius, s.z_min, s.z_max, s.phi_max}};
}
std::vector<Primitive> references_of(const OpenCylinderShape& c) {
  return {OpenCylinder{c.radius, c.z_min, c.z_max, c.phi_max}};
}

}  // namespace caplet::reference
