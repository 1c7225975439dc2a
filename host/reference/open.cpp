// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Parts of spheres, tubes and disks around the z axis: predicates, and distances as those to the whole where its nearest point is
// kept and to the rims where it is not.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "reference/detail/parts.h"

namespace caplet::reference {

namespace {

using glm::dvec2;
using glm::dvec3;

double angle_of(const dvec3& x) {
  const double phi = std::atan2(x.y, x.x);
  return phi < 0 ? phi + full_turn : phi;
}

dvec3 at_angle(double phi) { return {std::cos(phi), std::sin(phi), 0}; }

const dvec3 up{0, 0, 1}, east{1, 0, 0}, north{0, 1, 0};

Curve segment(const dvec3& a, const dvec3& b) { return {Curve::Kind::segment, a, b, dvec3(0), 0, 0, 0}; }
Curve circle(double radius, double height, double phi_max) {
  return {Curve::Kind::arc, height * up, east, north, radius, 0, std::min(phi_max, full_turn)};
}

// Distance to an arc: to its circle where the nearest point's angle is kept, else to an end.
double distance_to(const Curve& c, const dvec3& x) {
  if (c.kind == Curve::Kind::segment) return distance_to_segment(x, c.p, c.q);
  const dvec3 w = x - c.p;
  const dvec2 plane{glm::dot(w, c.q), glm::dot(w, c.r)};
  double angle = std::atan2(plane.y, plane.x);
  if (angle < c.from) angle += full_turn;
  if (angle >= c.from && angle <= c.to) return std::hypot(glm::length(plane) - c.radius, glm::dot(w, glm::cross(c.q, c.r)));
  return std::min(glm::length(x - c.at(0)), glm::length(x - c.at(1)));
}

double distance_to(const std::vector<Curve>& curves, const dvec3& x) {
  double least = HUGE_VAL;
  for (const Curve& c : curves) least = std::min(least, distance_to(c, x));
  return least;
}

bool whole(double phi_max) { return phi_max >= full_turn; }

}  // namespace

dvec3 Curve::at(double s) const {
  if (kind == Kind::segment) return p + s * (q - p);
  const double a = from + s * (to - from);
  return p + radius * (std::cos(a) * q + std::sin(a) * r);
}

bool keeps_of(const PartialSphere& s, const dvec3& x) {
  return (s.z_min <= -s.radius || x.z >= s.z_min) && (s.z_max >= s.radius || x.z <= s.z_max) &&
         (whole(s.phi_max) || angle_of(x) <= s.phi_max);
}
bool keeps_of(const OpenCylinder& c, const dvec3& x) {
  return x.z >= c.z_min && x.z <= c.z_max && (whole(c.phi_max) || angle_of(x) <= c.phi_max);
}
bool keeps_of(const PartialDisk& d, const dvec3& x) {
  const double r = std::hypot(x.x, x.y);
  return r <= d.radius && r >= d.inner_radius && (whole(d.phi_max) || angle_of(x) <= d.phi_max);
}

std::vector<Curve> boundary_of(const PartialSphere& s) {
  std::vector<Curve> out;
  for (const double z : {s.z_min, s.z_max})
    if (std::abs(z) < s.radius) out.push_back(circle(std::sqrt((s.radius - z) * (s.radius + z)), z, s.phi_max));
  if (!whole(s.phi_max)) {
    const double low = std::asin(std::clamp(s.z_min / s.radius, -1.0, 1.0));
    const double high = std::asin(std::clamp(s.z_max / s.radius, -1.0, 1.0));
    for (const double phi : {0.0, s.phi_max}) out.push_back({Curve::Kind::arc, dvec3(0), at_angle(phi), up, s.radius, low, high});
  }
  return out;
}
std::vector<Curve> boundary_of(const OpenCylinder& c) {
  std::vector<Curve> out = {circle(c.radius, c.z_min, c.phi_max), circle(c.radius, c.z_max, c.phi_max)};
  if (!whole(c.phi_max))
    for (const double phi : {0.0, c.phi_max})
      out.push_back(segment(c.radius * at_angle(phi) + c.z_min * up, c.radius * at_angle(phi) + c.z_max * up));
  return out;
}
std::vector<Curve> boundary_of(const PartialDisk& d) {
  std::vector<Curve> out = {circle(d.radius, d.height, d.phi_max)};
  if (d.inner_radius > 0) out.push_back(circle(d.inner_radius, d.height, d.phi_max));
  if (!whole(d.phi_max))
    for (const double phi : {0.0, d.phi_max})
      out.push_back(segment(d.inner_radius * at_angle(phi) + d.height * up, d.radius * at_angle(phi) + d.height * up));
  return out;
}

double value_of(const PartialSphere& s, const dvec3& x) {
  const double size = glm::length(x);
  const dvec3 nearest = size > 0 ? x * (s.radius / size) : at_angle(0) * s.radius;
  const double to_rims = distance_to(boundary_of(s), x);
  return keeps_of(s, nearest) ? std::min(to_rims, std::abs(size - s.radius)) : to_rims;
}
double value_of(const OpenCylinder& c, const dvec3& x) {
  const double to_rims = distance_to(boundary_of(c), x);
  return keeps_of(c, x) ? std::min(to_rims, std::abs(std::hypot(x.x, x.y) - c.radius)) : to_rims;
}
double value_of(const PartialDisk& d, const dvec3& x) {
  return keeps_of(d, x) ? std::abs(x.z - d.height) : distance_to(boundary_of(d), x);
}

}  // namespace caplet::reference
