// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/placement.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/reading.h"
#include "base/spelling.h"

namespace caplet {

namespace fs = std::filesystem;

namespace {

/// Returns finite numbers between commas; none where one of them is no number.
std::vector<double> numbers_of(std::string_view text) {
  std::vector<double> out;
  while (true) {
    const std::size_t comma = std::min(text.find(','), text.size());
    double value = 0;
    const char* const end = text.data() + comma;
    const auto [at, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || at != end || !std::isfinite(value)) return {};
    out.push_back(value);
    if (comma == text.size()) return out;
    text.remove_prefix(comma + 1);
  }
}

/// Returns one step of a placement. `given`: the whole argument, for messages.
glm::dmat4 step_of(std::string_view step, const std::string& given) {
  const std::size_t equals = std::min(step.find('='), step.size());
  const std::string name(step.substr(0, equals));
  const std::vector<double> v =
      equals < step.size() ? numbers_of(step.substr(equals + 1)) : std::vector<double>{};
  const auto refuse = [&](const std::string& why) {
    throw InputError({given}, fmt::format("'@{}': {}", step, why));
  };
  const glm::dmat4 one(1);
  if (name == "translate") {
    if (v.size() != 3) refuse("wants three numbers, such as @translate=10,0,0");
    return glm::translate(one, glm::dvec3(v[0], v[1], v[2]));
  }
  if (name == "rotate") {
    if (v.size() != 4 || !(glm::length(glm::dvec3(v[1], v[2], v[3])) > 0))
      refuse("wants degrees and an axis, such as @rotate=90,0,0,1");
    return glm::rotate(one, glm::radians(v[0]), glm::normalize(glm::dvec3(v[1], v[2], v[3])));
  }
  if (name == "scale") {
    if ((v.size() != 1 && v.size() != 3) || v[0] == 0 || v[v.size() / 2] == 0 || v.back() == 0)
      refuse("wants a factor or three, none of them 0, such as @scale=0.001");
    return glm::scale(one, v.size() == 1 ? glm::dvec3(v[0]) : glm::dvec3(v[0], v[1], v[2]));
  }
  refuse(fmt::format("is no step; the nearest is '@{}='",
                     nearest_name(name, {"translate", "rotate", "scale"})));
  return one;
}

}  // namespace

PlacedFile placed_file(const fs::path& given) {
  const std::string text = given.string();
  const std::size_t slash = text.rfind('/'),
                    at = text.find('@', slash == std::string::npos ? 0 : slash);
  if (at == std::string::npos || is_there(given, {text})) return {given, std::nullopt};
  glm::dmat4 placement(1);
  std::string_view rest = std::string_view(text).substr(at + 1);
  while (true) {
    const std::size_t end = std::min(rest.find('@'), rest.size());
    placement = step_of(rest.substr(0, end), text) * placement;
    if (end == rest.size()) break;
    rest.remove_prefix(end + 1);
  }
  return {text.substr(0, at), placement};
}

void place(Scene& scene, const glm::dmat4& placement) {
  for (Shape& shape : scene.shapes) shape.world_from_object = placement * shape.world_from_object;
  for (Instance& instance : scene.instances) {
    instance.world_from_object = placement * instance.world_from_object;
    for (TransformKey& key : instance.motion) key.matrix = placement * key.matrix;
  }
}

}  // namespace caplet
