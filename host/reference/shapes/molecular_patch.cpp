// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Patches of molecular surfaces.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "reference/detail/parts.h"

namespace caplet::reference {

using glm::dvec2;
using glm::dvec3;

namespace {

bool is_torus(const MolecularPatch& patch) { return patch.major > 0; }
bool whole(const MolecularPatch& patch) { return patch.phi_max >= full_turn; }

bool is_whole_carrier(const MolecularPatch& patch) {
  return is_torus(patch) ? patch.theta_max - patch.theta_min >= full_turn : patch.planes.empty();
}

// Returns the unit vector across the torus' axis towards x.
dvec3 spoke_to(const MolecularPatch& patch, const dvec3& x) {
  const dvec3 w = x - patch.center, side = glm::cross(patch.axis, patch.start);
  const dvec2 across(glm::dot(w, patch.start), glm::dot(w, side));
  const double length = glm::length(across);
  return length > 0 ? (across.x * patch.start + across.y * side) / length : patch.start;
}

// Returns the point of the sphere's centre or of the tube's middle that is nearest to x.
dvec3 core_of(const MolecularPatch& patch, const dvec3& x) {
  return is_torus(patch) ? patch.center + patch.major * spoke_to(patch, x) : patch.center;
}

dvec3 spoke_at(const MolecularPatch& patch, double phi) {
  return std::cos(phi) * patch.start + std::sin(phi) * glm::cross(patch.axis, patch.start);
}

double wrapped(double angle) { return angle < 0 ? angle + full_turn : angle; }

double phi_of(const MolecularPatch& patch, const dvec3& x) {
  const dvec3 w = x - patch.center;
  return wrapped(
      std::atan2(glm::dot(w, glm::cross(patch.axis, patch.start)), glm::dot(w, patch.start)));
}

double theta_of(const MolecularPatch& patch, const dvec3& x) {
  const dvec3 spoke = spoke_to(patch, x), tube = x - (patch.center + patch.major * spoke);
  return wrapped(std::atan2(glm::dot(tube, patch.axis), glm::dot(tube, spoke)));
}

// Adds the arcs of plane `number`'s circle that lie within all other planes: its ends are among the
// places where it crosses them.
void add_arcs(const MolecularPatch& patch, std::size_t number, std::vector<Curve>& out) {
  const MolecularPatch::Plane& plane = patch.planes[number];
  const double radius2 = patch.minor * patch.minor - plane.offset * plane.offset;
  if (!(radius2 > 0)) return;
  const dvec3 e = any_perpendicular(plane.normal), f = glm::cross(plane.normal, e);
  const Curve circle{
      Curve::Kind::arc, patch.center + plane.offset * plane.normal, e, f, std::sqrt(radius2), 0,
      full_turn};
  std::vector<double> cuts = {0, full_turn};
  for (const MolecularPatch::Plane& other : patch.planes) {
    // a cos(angle) + b sin(angle) = room on the circle.
    const double a = circle.radius * glm::dot(other.normal, e),
                 b = circle.radius * glm::dot(other.normal, f),
                 room = other.offset - plane.offset * glm::dot(other.normal, plane.normal);
    const double size = std::hypot(a, b);
    if (&other == &plane || !(std::abs(room) < size)) continue;
    const double middle = std::atan2(b, a), half = std::acos(room / size);
    for (const double cut : {middle - half, middle + half})
      cuts.push_back(wrapped(std::fmod(cut, full_turn)));
  }
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    Curve arc = circle;
    arc.from = cuts[i];
    arc.to = cuts[i + 1];
    const dvec3 middle = arc.at(0.5) - patch.center;
    bool inside = arc.to > arc.from;
    for (std::size_t k = 0; k < patch.planes.size(); ++k)
      inside = inside &&
               (k == number || glm::dot(patch.planes[k].normal, middle) <= patch.planes[k].offset);
    if (inside) out.push_back(arc);
  }
}

MolecularPatch with_ball(MolecularPatch patch, const Bounds& bounds) {
  patch.ball_center = 0.5 * (bounds.min + bounds.max);
  patch.ball_radius = 0.5 * glm::length(bounds.max - bounds.min) * (1 + 1e-9);
  return patch;
}

// Returns how far x is beyond the furthest of the planes, or of the planes and cones around the
// tube that end the part of a torus.
double beyond_clips(const MolecularPatch& patch, const dvec3& x) {
  const dvec3 w = x - patch.center;
  double out = -HUGE_VAL;
  if (is_whole_carrier(patch)) return out;
  for (const auto& plane : patch.planes)
    out = std::max(out, glm::dot(plane.normal, w) - plane.offset);
  if (!is_torus(patch)) return out;
  const dvec3 spoke = spoke_to(patch, x), tube = w - patch.major * spoke;
  const double along = glm::dot(tube, patch.axis), across = glm::dot(tube, spoke);
  out = std::max(std::sin(patch.theta_min) * across - std::cos(patch.theta_min) * along,
                 std::cos(patch.theta_max) * along - std::sin(patch.theta_max) * across);
  if (whole(patch)) return out;
  const double a = glm::dot(w, patch.start), b = glm::dot(w, glm::cross(patch.axis, patch.start)),
               before = -b, behind = std::cos(patch.phi_max) * b - std::sin(patch.phi_max) * a;
  const double middle = -std::cos(0.5 * patch.phi_max) * a - std::sin(0.5 * patch.phi_max) * b;
  return std::max(out, std::sin(patch.phi_max) >= 0 ? std::max({before, behind, middle})
                                                    : std::min(before, behind));
}

}  // namespace

double carrier_value(const MolecularPatch& patch, const dvec3& x) {
  const double out = glm::length(x - core_of(patch, x)) - patch.minor;
  return is_torus(patch) || patch.of_probe ? -out : out;
}

bool keeps_of(const MolecularPatch& patch, const dvec3& x, int) {
  if (is_whole_carrier(patch)) return true;
  if (!is_torus(patch))
    return std::all_of(patch.planes.begin(), patch.planes.end(), [&](const auto& plane) {
      return glm::dot(plane.normal, x - patch.center) <= plane.offset;
    });
  const double theta = theta_of(patch, x);
  return theta >= patch.theta_min && theta <= patch.theta_max &&
         (whole(patch) || phi_of(patch, x) <= patch.phi_max);
}

std::vector<Curve> boundary_of(const MolecularPatch& patch) {
  std::vector<Curve> out;
  for (std::size_t i = 0; i < patch.planes.size(); ++i) add_arcs(patch, i, out);
  if (is_whole_carrier(patch) || !is_torus(patch)) return out;
  const dvec3 y = glm::cross(patch.axis, patch.start);
  for (const double theta : {patch.theta_min, patch.theta_max})
    out.push_back({Curve::Kind::arc, patch.center + patch.minor * std::sin(theta) * patch.axis,
                   patch.start, y, patch.major + patch.minor * std::cos(theta), 0,
                   std::min(patch.phi_max, full_turn)});
  if (whole(patch)) return out;
  for (const double phi : {0.0, patch.phi_max}) {
    const dvec3 spoke = spoke_at(patch, phi);
    out.push_back({Curve::Kind::arc, patch.center + patch.major * spoke, spoke, patch.axis,
                   patch.minor, patch.theta_min, patch.theta_max});
  }
  return out;
}

double value_of(const MolecularPatch& patch, const dvec3& x) {
  return std::max(std::abs(carrier_value(patch, x)), beyond_clips(patch, x));
}

double distance_from(const MolecularPatch& patch, const dvec3& x, int) {
  return std::abs(carrier_value(patch, x));
}

bool has_inside(const MolecularPatch&) { return false; }
Primitive carrier_from(const MolecularPatch& patch) {
  MolecularPatch out = patch;
  out.planes.clear();
  out.phi_max = out.theta_max = full_turn;
  out.theta_min = 0;
  out.ball_center = patch.center;
  out.ball_radius = patch.major + patch.minor;
  return out;
}
Ball ball_of(const MolecularPatch& patch) { return {patch.ball_center, patch.ball_radius}; }

dvec3 sheet_normal(const MolecularPatch& patch, const dvec3& x) {
  const dvec3 out = glm::normalize(x - core_of(patch, x));
  return is_torus(patch) || patch.of_probe ? -out : out;
}

dvec2 uv_of(const MolecularPatch& patch, const dvec3& x, int) {
  if (!is_torus(patch)) return uv_of(Sphere{patch.center, patch.minor}, x, 0);
  const auto share = [](double of, double whole) { return std::clamp(of / whole, 0.0, 1.0); };
  const double phi = phi_of(patch, x);
  const bool is_before = phi - patch.phi_max > full_turn - phi;  // beyond an end: the nearer one
  return {is_before ? 0 : share(phi, patch.phi_max),
          share(theta_of(patch, x) - patch.theta_min, patch.theta_max - patch.theta_min)};
}

std::vector<Primitive> references_of(const MolecularSurfaceShape& molecule) {
  std::vector<Primitive> out;
  const SurfacePatches& all = *molecule.patches;
  for (const auto& of : all.balls) {
    MolecularPatch patch;
    patch.center = of.center;
    patch.minor = of.radius;
    patch.of_probe = of.probe != 0;
    for (std::uint32_t i = 0; i < of.plane_count; ++i)
      patch.planes.push_back(
          {all.planes[of.plane_begin + i].normal, all.planes[of.plane_begin + i].offset});
    out.emplace_back(with_ball(std::move(patch), of.bounds));
  }
  for (const auto& of : all.tori) {
    MolecularPatch patch;
    patch.center = of.center;
    patch.minor = of.minor;
    patch.major = of.major;
    patch.axis = of.axis;
    patch.start = of.start;
    patch.phi_max = of.phi_max;
    patch.theta_min = of.theta_min;
    patch.theta_max = of.theta_max;
    out.emplace_back(with_ball(std::move(patch), of.bounds));
  }
  return out;
}

}  // namespace caplet::reference
