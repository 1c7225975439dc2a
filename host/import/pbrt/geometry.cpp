// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Readers of points and lengths, and of shapes whose model names its fields.
#include "import/detail/pbrt/geometry.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>

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
    out.emplace_back(to_float(parameters, values->name, n[i]),
                     to_float(parameters, values->name, n[i + 1]),
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

double positive_length(Parameters& parameters, std::string_view name, double fallback) {
  const double value = length(parameters, name, fallback);
  if (static_cast<float>(value) > 0) return value;
  parameters.error(name, value > 0 ? "is too small for a 32-bit float" : "must be positive");
  return fallback;
}

double positive_radius(Parameters& parameters, double fallback) {
  return positive_length(parameters, "radius", fallback);
}

double phi_max(Parameters& parameters) {
  const double degrees = parameters.number("phimax", 360);
  if (!(degrees > 0)) parameters.error("phimax", "must be above 0 degrees");
  return degrees > 0 && degrees < 360 ? degrees * std::numbers::pi / 180 : full_turn;
}

ReadFields::ReadFields(Parameters& parameters) : parameters_(parameters) {}

void ReadFields::corners(const char* name0, const char* name1, glm::dvec3& p0, glm::dvec3& p1) {
  const glm::dvec3 a = required_point(parameters_, name0), b = required_point(parameters_, name1);
  complete_ = complete_ && parameters_.has(name0) && parameters_.has(name1);
  p0 = glm::min(a, b);
  p1 = glm::max(a, b);
}

void ReadFields::positive(const char* name, double& value) {
  value = positive_length(parameters_, name, value);
}

FieldCheck::FieldCheck(Parameters& parameters) : parameters_(parameters) {}

void FieldCheck::error(const std::string& message) {
  good_ = false;
  parameters_.error(message);
}
void FieldCheck::error(std::string_view field, const std::string& message) {
  good_ = false;
  parameters_.error(field, message);
}

}  // namespace caplet::pbrt
