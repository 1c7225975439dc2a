// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Spheres, disks, capsules, cylinders, cones, boxes and polyhedra.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "import/detail/pbrt_geometry.h"

namespace caplet::pbrt {

float to_float(Parameters& parameters, std::string_view name, double value) {
  if (std::abs(value) <= largest_length) return static_cast<float>(value);
  parameters.error(name, "is too large a number (above 1e18)");
  return 0;
}

std::vector<glm::vec3> vectors3(Parameters& parameters, const Parameter* values) {
  std::vector<glm::vec3> out;
  if (!values) return out;
  const auto& n = values->numbers;
  out.reserve(n.size() / 3);
  for (std::size_t i = 0; i + 2 < n.size(); i += 3)
    out.emplace_back(to_float(parameters, values->name, n[i]), to_float(parameters, values->name, n[i + 1]),
                     to_float(parameters, values->name, n[i + 2]));
  return out;
}

double length(Parameters& parameters, std::string_view name, double fallback) {
  const double value = parameters.number(name, fallback);
  if (std::abs(value) <= largest_length) return value;
  parameters.error(name, "is too large a number (above 1e18)");
  return fallback;
}

glm::dvec3 required_point(Parameters& parameters, std::string_view name) {
  if (!parameters.has(name)) parameters.error("\"point3 " + std::string(name) + "\" is missing");
  const glm::dvec3 p = parameters.point(name, glm::dvec3(0));
  if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= largest_length) return p;
  parameters.error(name, "is too large a number (above 1e18)");
  return glm::dvec3(0);
}

double positive_radius(Parameters& parameters, double fallback) {
  const double radius = length(parameters, "radius", fallback);
  if (static_cast<float>(radius) > 0) return radius;
  parameters.error("radius", radius > 0 ? "is too small for a 32-bit float" : "must be positive");
  return fallback;
}

double phi_max(Parameters& parameters) {
  const double degrees = parameters.number("phimax", 360);
  if (!(degrees > 0)) parameters.error("phimax", "must be above 0 degrees");
  return degrees > 0 && degrees < 360 ? degrees * std::numbers::pi / 180 : full_turn;
}

Geometry make_sphere(Parameters& parameters) {
  const double radius = positive_radius(parameters, 1);
  const double a = length(parameters, "zmin", -radius), b = length(parameters, "zmax", radius);
  const PartialSphereShape part{radius, std::clamp(std::min(a, b), -radius, radius), std::clamp(std::max(a, b), -radius, radius),
                                phi_max(parameters)};
  if (part.z_min == -radius && part.z_max == radius && part.phi_max == full_turn) return SphereShape{radius};
  if (part.z_min == part.z_max)
    parameters.error(parameters.has("zmin") ? "zmin" : "zmax", "leaves nothing of the sphere: it ends where it begins");
  return part;
}

DiskShape make_disk(Parameters& parameters) {
  DiskShape disk;
  disk.height = length(parameters, "height", 0);
  disk.radius = positive_radius(parameters, 1);
  disk.inner_radius = parameters.number("innerradius", 0);
  if (!(disk.inner_radius >= 0 && disk.inner_radius < disk.radius)) {
    parameters.error("innerradius", "must be from 0 up and below the radius");
    disk.inner_radius = 0;
  }
  disk.phi_max = phi_max(parameters);
  return disk;
}

namespace {

/// "float radius" of one or two values, from 0 up and not all 0; empty when wrong or missing (reported).
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
  if (name != "open") parameters.error("caps", "must be \"flat\", \"round\" or \"open\", not " + in_quotes(name));
  return Cap::open;
}

std::array<Cap, 2> caps_of(Parameters& parameters) {
  const Parameter* caps = parameters.values("caps", {"string"});
  if (!caps) return {Cap::flat, Cap::flat};
  const auto& names = caps->strings;
  if (names.size() > 2) parameters.error("caps", "takes 1 or 2 values, not " + std::to_string(names.size()));
  const Cap first = cap_of(parameters, names[0]);
  return {first, names.size() > 1 && names[1] != names[0] ? cap_of(parameters, names[1]) : first};
}

/// p0 and p1 of a cylinder or cone.
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
    parameters.error(parameters.has("zmin") ? "zmin" : "zmax", "leaves nothing of the cylinder: it ends where it begins");
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

BoxShape make_box(Parameters& parameters) {
  const glm::dvec3 p0 = required_point(parameters, "p0"), p1 = required_point(parameters, "p1");
  const BoxShape box{glm::min(p0, p1), glm::max(p0, p1)};
  if (!parameters.has("p0") || !parameters.has("p1")) return {};
  for (int k = 0; k < 3; ++k)
    if (static_cast<float>(p0[k]) == static_cast<float>(p1[k])) {
      parameters.error("p1", std::string("has the same ") + "xyz"[k] + " as \"p0\" (as 32-bit floats): the box is flat");
      return {};
    }
  return box;
}

PolyhedronShape make_polyhedron(Parameters& parameters) {
  const auto vectors = [&](const char* name, const char* type) {
    std::vector<glm::dvec3> out;
    if (!parameters.has(name)) parameters.error("\"" + std::string(type) + " " + name + "\" is missing");
    const Parameter* values = parameters.values(name, {type});
    if (!values) return out;
    const auto& n = values->numbers;
    for (std::size_t i = 0; i + 2 < n.size(); i += 3) out.emplace_back(n[i], n[i + 1], n[i + 2]);
    if (std::any_of(n.begin(), n.end(), [](double x) { return std::abs(x) > largest_length; })) {
      parameters.error(name, "is too large a number (above 1e18)");
      out.clear();
    }
    return out;
  };
  PolyhedronShape polyhedron{vectors("P", "point3"), vectors("N", "normal")};
  const std::size_t planes = polyhedron.points.size();
  if (planes == 0 || polyhedron.normals.empty()) return {};
  if (polyhedron.normals.size() != planes) {
    parameters.error("N",
                     "has " + std::to_string(polyhedron.normals.size()) + " entries for " + std::to_string(planes) + " points");
    return {};
  }
  if (planes > max_polyhedron_planes) {
    parameters.error(
        "P", "gives " + std::to_string(planes) + " planes; a polyhedron has at most " + std::to_string(max_polyhedron_planes));
    return {};
  }
  for (std::size_t i = 0; i < planes; ++i)
    if (!(glm::length(polyhedron.normals[i]) > 0)) {
      parameters.error("N", "has no direction for plane " + std::to_string(i) + ": it is zero");
      return {};
    }
  return polyhedron;
}

}  // namespace caplet::pbrt
