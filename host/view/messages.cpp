// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace caplet::view {

namespace {

using nlohmann::json;

constexpr int deepest = 8;

[[noreturn]] void refuse(const std::string& field, const std::string& why) { throw InputError(SourceLocation{field}, why); }

const json& field(const json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end()) refuse(name, "is missing");
  return *found;
}

double number(const json& value, const std::string& name, double least, double most) {
  if (!value.is_number()) refuse(name, "is not a number");
  const double out = value.get<double>();
  if (!(out >= least && out <= most)) refuse(name, fmt::format("is {}, and not in {} to {}", out, least, most));
  return out;
}

int whole(const json& object, const char* name, int least, int most) {
  const double out = number(field(object, name), name, least, most);
  if (out != std::floor(out)) refuse(name, fmt::format("is {}, and no whole number", out));
  return static_cast<int>(out);
}

bool truth(const json& object, const char* name) {
  const json& value = field(object, name);
  if (!value.is_boolean()) refuse(name, "is not true or false");
  return value.get<bool>();
}

glm::dmat4 matrix(const json& object, const char* name) {
  const json& rows = field(object, name);
  if (!rows.is_array() || rows.size() != 16) refuse(name, "is not a list of sixteen numbers");
  glm::dmat4 out;
  for (int i = 0; i < 16; ++i)
    out[i % 4][i / 4] = number(rows[static_cast<std::size_t>(i)], fmt::format("{}[{}]", name, i), -1e12, 1e12);
  return out;
}

Look look(const json& of) {
  Look out;
  out.width = whole(of, "width", 1, most_page_pixels);
  out.height = whole(of, "height", 1, most_page_pixels);
  out.world_from_camera = matrix(of, "world_from_camera");
  out.fov = number(field(of, "fov"), "fov", 1e-3, 3.14);
  out.lens_radius = number(field(of, "lens_radius"), "lens_radius", 0, 1e9);
  out.focal_distance = number(field(of, "focal_distance"), "focal_distance", 1e-9, 1e12);
  return out;
}

Ask ask(const json& of) {
  Ask out;
  out.number = number(field(of, "number"), "number", 0, 1e15);
  out.x = whole(of, "x", 0, most_page_pixels - 1);
  out.y = whole(of, "y", 0, most_page_pixels - 1);
  out.all = truth(of, "all");
  out.reference = truth(of, "reference");
  return out;
}

constexpr double most_id = 4294967294.0;

std::uint32_t id(const json& value, const std::string& name) {
  const double out = number(value, name, 0, most_id);
  if (out != std::floor(out)) refuse(name, fmt::format("is {}, and no whole number", out));
  return static_cast<std::uint32_t>(out);
}

std::uint32_t id(const json& object, const char* name) { return id(field(object, name), std::string(name)); }

std::vector<std::uint32_t> ids(const json& object) {
  const json& list = field(object, "ids");
  if (!list.is_array() || list.empty() || list.size() > most_chosen)
    refuse("ids", fmt::format("is not a list of 1 to {} numbers", most_chosen));
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i < list.size(); ++i) out.push_back(id(list[i], fmt::format("ids[{}]", i)));
  std::ranges::sort(out);
  if (const auto twice = std::ranges::adjacent_find(out); twice != out.end())
    refuse("ids", fmt::format("names {} twice", *twice));
  return out;
}

glm::dvec3 point(const json& object, const char* name) {
  const json& list = field(object, name);
  if (!list.is_array() || list.size() != 3) refuse(name, "is not a list of three numbers");
  glm::dvec3 out;
  for (int i = 0; i < 3; ++i) out[i] = number(list[static_cast<std::size_t>(i)], fmt::format("{}[{}]", name, i), -1e30, 1e30);
  return out;
}

Change change(const json& of) {
  const json& what = field(of, "what");
  if (what == "move") return Move{ids(of), matrix(of, "matrix")};
  if (what == "reshape")
    return Reshape{id(of, "id"),
                   id(of, "capsule"),
                   point(of, "p0"),
                   point(of, "p1"),
                   number(field(of, "radius0"), "radius0", 0, 1e30),
                   number(field(of, "radius1"), "radius1", 0, 1e30)};
  if (what == "paint") {
    const bool all = field(of, "surface").is_null();
    return Paint{ids(of), all ? std::nullopt : std::optional(id(of, "surface")), id(of, "material")};
  }
  if (what == "duplicate") return Duplicate{ids(of), point(of, "by")};
  if (what == "delete") return Delete{ids(of)};
  refuse("what", "is none of move, reshape, paint, duplicate and delete");
}

Save save(const json& of) {
  Save out;
  const json& name = field(of, "name");
  if (!name.is_null()) {
    if (!name.is_string()) refuse("name", "is no text");
    out.name = name.get<std::string>();
    if (out.name->size() > longest_name) refuse("name", fmt::format("is longer than {} bytes", longest_name));
  }
  out.camera = truth(of, "camera");
  out.replace = truth(of, "replace");
  return out;
}

}  // namespace

Message parse_message(std::string_view text) {
  int depth = 0;
  const json::parser_callback_t shallow = [&depth](int at, json::parse_event_t, json&) {
    depth = std::max(depth, at);
    if (depth > deepest) throw InputError("the message is nested too deeply");
    return true;
  };
  json message;
  try {
    message = json::parse(text, shallow);
  } catch (const json::exception&) {
    throw InputError("the message is no JSON");
  }
  if (!message.is_object()) throw InputError("the message is no object");
  const json& type = field(message, "type");
  if (type == "look") return look(message);
  if (type == "seen") return Seen{truth(message, "seen")};
  if (type == "ask") return ask(message);
  if (type == "snapshot") return Snapshot{};
  if (type == "describe")
    return Describe{number(field(message, "number"), "number", 0, 1e15), id(message, "id"), id(message, "primitive")};
  if (type == "edit") return Edit{change(message), truth(message, "goes_on")};
  if (type == "undo") return Undo{truth(message, "again")};
  if (type == "save") return save(message);
  if (type == "discard") return Discard{};
  if (type == "kept") return Kept{truth(message, "restore")};
  refuse("type", "is none of look, seen, ask, snapshot, describe, edit, undo, save, discard and kept");
}

}  // namespace caplet::view
