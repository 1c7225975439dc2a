// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Readers of capsules, cylinders and cones.
#include <algorithm>
#include <limits>

#include "import/detail/pbrt/geometry.h"

namespace caplet::pbrt {

namespace {

/// Reads "float radius" of one or two values, from 0 up and not all 0; empty when wrong or missing
/// (reported).
std::vector<double> end_radii(Parameters& parameters) {
  if (!parameters.has("radius")) parameters.error("\"float radius\" is missing");
  const Parameter* radius = parameters.values("radius", {"float"});
  if (!radius) return {};
  const auto& r = radius->numbers;
  const auto [least, most] = std::minmax_element(r.begin(), r.end());
  if (r.size() > 2)
    parameters.error("radius", "takes 1 or 2 values, not " + std::to_string(r.size()));
  else if (*least < 0 || *most <= 0)
    parameters.error("radius", "must be positive (of two radii one may be 0)");
  else if (*most < std::numeric_limits<float>::denorm_min())
    parameters.error("radius", "is too small a number");
  else if (*most > largest_length)
    parameters.error("radius", "is too large a number (above 1e18)");
  else
    return r;
  return {};
}

Cap cap_of(Parameters& parameters, const std::string& name) {
  if (name == "flat") return Cap::flat;
  if (name == "round") return Cap::round;
  if (name != "open")
    parameters.error("caps", "must be \"flat\", \"round\" or \"open\", not " + in_quotes(name));
  return Cap::open;
}

std::array<Cap, 2> caps_of(Parameters& parameters) {
  const Parameter* caps = parameters.values("caps", {"string"});
  if (!caps) return {Cap::flat, Cap::flat};
  const auto& names = caps->strings;
  if (names.size() > 2)
    parameters.error("caps", "takes 1 or 2 values, not " + std::to_string(names.size()));
  const Cap first = cap_of(parameters, names[0]);
  return {first, names.size() > 1 && names[1] != names[0] ? cap_of(parameters, names[1]) : first};
}

/// Reads p0 and p1 of a cylinder or cone.
template <class Solid>
void read_ends(Parameters& parameters, Solid& solid) {
  const glm::dvec3 p0 = required_point(parameters, "p0"), p1 = required_point(parameters, "p1");
  if (glm::vec3(p0) != glm::vec3(p1)) {
    solid.p0 = p0;
    solid.p1 = p1;
  } else if (parameters.has("p0") && parameters.has("p1")) {
    parameters.error("p1", "is the same point as \"p0\" (as 32-bit floats): the solid has no axis");
  }
}

}  // namespace

CapsulesShape make_capsule(Parameters& parameters) {
  const glm::vec3 p0(required_point(parameters, "p0")), p1(required_point(parameters, "p1"));
  const std::vector<double> r = end_radii(parameters);
  if (r.empty()) return {};
  CapsulesShape capsule{{p0}, {p1}, {static_cast<float>(r[0])}, {}, {}};
  if (r.size() == 2 && r[1] != r[0]) capsule.radius1 = {static_cast<float>(r[1])};
  capsule.u = chain_u(parameters, 1);
  return capsule;
}

Geometry make_cylinder(Parameters& parameters) {
  if (parameters.has("p0") || parameters.has("p1")) {
    CylinderShape cylinder;
    read_ends(parameters, cylinder);
    if (!parameters.has("radius")) parameters.error("\"float radius\" is missing");
    cylinder.radius = positive_radius(parameters, 1);
    cylinder.caps = caps_of(parameters);
    return cylinder;
  }
  OpenCylinderShape cylinder;
  cylinder.radius = positive_radius(parameters, 1);
  const double a = length(parameters, "zmin", -1), b = length(parameters, "zmax", 1);
  cylinder.z_min = std::min(a, b);
  cylinder.z_max = std::max(a, b);
  if (static_cast<float>(a) == static_cast<float>(b))
    parameters.error(parameters.has("zmin") ? "zmin" : "zmax",
                     "leaves nothing of the cylinder: it ends where it begins");
  cylinder.phi_max = phi_max(parameters);
  return cylinder;
}

ConeShape make_cone(Parameters& parameters) {
  ConeShape cone;
  read_ends(parameters, cone);
  const std::vector<double> r = end_radii(parameters);
  if (!r.empty()) cone.radius = {r[0], r.size() > 1 ? r[1] : 0};
  cone.caps = caps_of(parameters);
  return cone;
}

}  // namespace caplet::pbrt
