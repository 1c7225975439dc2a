// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads and checks the fields of messages from the page. Each function throws InputError with the
// field as its place.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "view/parts.h"

namespace caplet::view::message {

using nlohmann::json;

[[noreturn]] inline void refuse(const std::string& field, const std::string& why) {
  throw InputError(SourceLocation{field}, why);
}

inline const json& field(const json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end()) refuse(name, "is missing");
  return *found;
}

inline double number(const json& value, const std::string& name, double least, double most) {
  if (!value.is_number()) refuse(name, "is not a number");
  const double out = value.get<double>();
  if (!(out >= least && out <= most))
    refuse(name, fmt::format("is {}, and not in {} to {}", out, least, most));
  return out;
}

inline int whole(const json& object, const char* name, int least, int most) {
  const double out = number(field(object, name), name, least, most);
  if (out != std::floor(out)) refuse(name, fmt::format("is {}, and no whole number", out));
  return static_cast<int>(out);
}

inline bool truth(const json& object, const char* name) {
  const json& value = field(object, name);
  if (!value.is_boolean()) refuse(name, "is not true or false");
  return value.get<bool>();
}

inline std::string text(const json& object, const char* name, std::size_t longest) {
  const json& value = field(object, name);
  if (!value.is_string()) refuse(name, "is no text");
  std::string out = value.get<std::string>();
  if (out.size() > longest) refuse(name, fmt::format("is longer than {} bytes", longest));
  return out;
}

inline glm::dmat4 matrix(const json& object, const char* name) {
  const json& rows = field(object, name);
  if (!rows.is_array() || rows.size() != 16) refuse(name, "is not a list of sixteen numbers");
  glm::dmat4 out;
  for (int i = 0; i < 16; ++i)
    out[i % 4][i / 4] =
        number(rows[static_cast<std::size_t>(i)], fmt::format("{}[{}]", name, i), -1e12, 1e12);
  return out;
}

constexpr double most_id = 4294967294.0;

inline std::uint32_t id(const json& value, const std::string& name) {
  const double out = number(value, name, 0, most_id);
  if (out != std::floor(out)) refuse(name, fmt::format("is {}, and no whole number", out));
  return static_cast<std::uint32_t>(out);
}

inline std::uint32_t id(const json& object, const char* name) {
  return id(field(object, name), std::string(name));
}

inline std::vector<std::uint32_t> ids(const json& object) {
  const json& list = field(object, "ids");
  if (!list.is_array() || list.empty() || list.size() > most_chosen)
    refuse("ids", fmt::format("is not a list of 1 to {} numbers", most_chosen));
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i < list.size(); ++i)
    out.push_back(id(list[i], fmt::format("ids[{}]", i)));
  std::ranges::sort(out);
  if (const auto twice = std::ranges::adjacent_find(out); twice != out.end())
    refuse("ids", fmt::format("names {} twice", *twice));
  return out;
}

inline glm::dvec3 point(const json& object, const char* name) {
  const json& list = field(object, name);
  if (!list.is_array() || list.size() != 3) refuse(name, "is not a list of three numbers");
  glm::dvec3 out;
  for (int i = 0; i < 3; ++i)
    out[i] = number(list[static_cast<std::size_t>(i)], fmt::format("{}[{}]", name, i), -1e30, 1e30);
  return out;
}

/// Reads a part of the scene: `of` and `part`.
FormSubject part(const json& object);
/// Reads a change of a form; returns none where `what` is another kind of message.
std::optional<FormChange> form_change(const json& object);
inline constexpr const char* form_changes = "set, add, remove, hide and show";

}  // namespace caplet::view::message
