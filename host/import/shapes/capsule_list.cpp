// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads capsules from lists in a statement: the content of a .capsules file.
#include <algorithm>
#include <cmath>

#include "import/detail/pbrt/geometry.h"

namespace caplet::pbrt {

namespace {

std::string at_times(std::size_t times) {
  return times > 1 ? " at " + std::to_string(times) + " times" : "";
}

/// Reads one float from 0 up per capsule, or per capsule and time; none where the parameter is
/// missing or wrong (reported).
std::vector<float> radii(Parameters& parameters, const char* name, std::size_t count,
                         std::size_t times) {
  std::vector<float> out;
  const Parameter* given = parameters.values(name, {"float"});
  if (!given) return out;
  if (given->numbers.size() != count && given->numbers.size() != count * times) {
    parameters.error(name, "has " + std::to_string(given->numbers.size()) + " values for " +
                               std::to_string(count) + " capsules" + at_times(times));
    return out;
  }
  out.reserve(count * times);
  for (const double value : given->numbers) {
    out.push_back(to_float(parameters, name, value));
    if (value >= 0) continue;
    parameters.error(name, "must not be negative");
    return {};
  }
  // Radii that are given once stay the same.
  for (std::size_t i = 0; out.size() < count * times; ++i) out.push_back(out[i]);
  return out;
}

}  // namespace

std::vector<std::uint32_t> listed_materials(Parameters& parameters, const char* list,
                                            const MaterialIndex& material_index, std::size_t count,
                                            const char* things) {
  const Parameter* names = parameters.values(list, {"string"});
  const Parameter* indices = parameters.values("materialindices", {"integer"});
  if (!names && !indices) return {};
  if (!names || !indices) {
    parameters.error(
        names ? list : "materialindices",
        names ? "needs \"integer materialindices\"" : "needs \"string " + std::string(list) + "\"");
    return {};
  }
  if (indices->numbers.size() != count) {
    parameters.error("materialindices", "has " + std::to_string(indices->numbers.size()) +
                                            " values for " + std::to_string(count) + " " + things);
    return {};
  }
  std::vector<std::uint32_t> known, out;
  for (const std::string& name : names->strings)
    known.push_back(material_index(name, names->where));
  out.reserve(count);
  for (const double index : indices->numbers) {
    if (!(index >= 0 && index < static_cast<double>(known.size()))) {
      parameters.error("materialindices",
                       "must be below the number of \"" + std::string(list) + "\", from 0 up");
      return {};
    }
    out.push_back(known[static_cast<std::size_t>(index)]);
  }
  return out;
}

std::vector<glm::vec2> chain_u(Parameters& parameters, std::size_t capsules) {
  const Parameter* given = parameters.values("u", {"float"});
  if (!given) return {};
  const std::vector<double>& numbers = given->numbers;
  if (numbers.size() != 2 * capsules) {
    parameters.error("u", "takes two values a capsule, " + std::to_string(2 * capsules) + ", not " +
                              std::to_string(numbers.size()));
    return {};
  }
  std::vector<glm::vec2> out;
  out.reserve(capsules);
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    if (!(std::abs(numbers[i]) <= largest_length && std::abs(numbers[i + 1]) <= largest_length)) {
      parameters.error("u", "is too large a number (above 1e18)");
      return {};
    }
    out.emplace_back(numbers[i], numbers[i + 1]);
  }
  return out;
}

CapsulesShape make_capsule_list(Parameters& parameters, const MaterialIndex& material_index) {
  CapsulesShape capsules;
  for (const char* name : {"p1", "radius"})
    if (!parameters.has(name)) parameters.error("\"" + std::string(name) + "\" is missing");
  capsules.p0 = vectors3(parameters, parameters.values("p0", {"point3"}));
  capsules.p1 = vectors3(parameters, parameters.values("p1", {"point3"}));
  capsules.times = key_times(parameters);
  if (capsules.p0.empty() || capsules.p1.empty()) return {};
  if (capsules.p1.size() != capsules.p0.size()) {
    parameters.error("p1", "has " + std::to_string(capsules.p1.size()) + " points for " +
                               std::to_string(capsules.p0.size()) + " of \"p0\"");
    return {};
  }
  const std::size_t times = std::max<std::size_t>(1, capsules.times.size());
  if (capsules.p0.size() % times != 0) {
    parameters.error("p0", "has " + std::to_string(capsules.p0.size()) +
                               " points, which are not as many at each of " +
                               std::to_string(times) + " times");
    return {};
  }
  const std::size_t count = count_of(capsules);
  capsules.radius0 = radii(parameters, "radius", count, times);
  if (capsules.radius0.empty()) return {};
  capsules.radius1 = radii(parameters, "radius1", count, times);
  if (capsules.radius1 == capsules.radius0) capsules.radius1.clear();
  capsules.materials =
      listed_materials(parameters, "capsulematerials", material_index, count, "capsules");
  capsules.u = chain_u(parameters, count);
  return capsules;
}

}  // namespace caplet::pbrt
