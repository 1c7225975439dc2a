// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "import/detail/pbrt/geometry.h"

namespace caplet::pbrt {

PolyhedronShape make_polyhedron(Parameters& parameters) {
  const auto vectors = [&](const char* name, const char* type) {
    std::vector<glm::dvec3> out;
    if (!parameters.has(name))
      parameters.error("\"" + std::string(type) + " " + name + "\" is missing");
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
    parameters.error("N", "has " + std::to_string(polyhedron.normals.size()) + " entries for " +
                              std::to_string(planes) + " points");
    return {};
  }
  if (planes > max_polyhedron_planes) {
    parameters.error("P", "gives " + std::to_string(planes) + " planes; a polyhedron has at most " +
                              std::to_string(max_polyhedron_planes));
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
