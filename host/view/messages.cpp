// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "view/detail/message_fields.h"

namespace caplet::view {

namespace {

using namespace message;

constexpr int deepest = 8;

std::optional<ClipPlane> clip(const json& of) {
  const json& plane = field(of, "clip");
  if (plane.is_null()) return std::nullopt;
  if (!plane.is_object()) refuse("clip", "is no object");
  ClipPlane out{point(plane, "normal"), number(field(plane, "offset"), "offset", -1e18, 1e18)};
  const double length = glm::length(out.normal);
  if (!(length > 0)) refuse("normal", "has no direction");
  out.normal /= length;
  return out;
}

ShowView look(const json& of) {
  ShowView out;
  out.width = whole(of, "width", 1, most_page_pixels);
  out.height = whole(of, "height", 1, most_page_pixels);
  out.world_from_camera = matrix(of, "world_from_camera");
  out.fov = number(field(of, "fov"), "fov", 1e-3, 3.14);
  out.lens_radius = number(field(of, "lens_radius"), "lens_radius", 0, 1e9);
  out.focal_distance = number(field(of, "focal_distance"), "focal_distance", 1e-9, 1e12);
  if (of.contains("separation")) out.separation = number(of["separation"], "separation", 0, 1e9);
  if (of.contains("convergence"))
    out.convergence = number(of["convergence"], "convergence", 0, 1e12);
  if (of.contains("orthographic"))
    out.orthographic = number(of["orthographic"], "orthographic", 0, 1e18);
  if (of.contains("clip")) out.clip = clip(of);
  return out;
}

Ask ask(const json& of) {
  Ask out;
  out.number = number(field(of, "number"), "number", 0, 1e15);
  out.x = whole(of, "x", 0, most_page_pixels - 1);
  out.y = whole(of, "y", 0, most_page_pixels - 1);
  out.all = truth(of, "all");
  out.reference = truth(of, "reference");
  if (of.contains("eye")) out.eye = whole(of, "eye", 0, 1);
  return out;
}

MakeFigure figure(const json& of) {
  constexpr std::size_t most_drawn = 16, longest = 100, longest_drawn = 4000;
  MakeFigure out;
  out.number = number(field(of, "number"), "number", 0, 1e15);
  out.look = look(of);
  out.look.separation = 0;
  out.samples = whole(of, "samples", 1, most_figure_samples);
  out.denoise = truth(of, "denoise");
  if (!field(of, "background").is_null()) out.background = text(of, "background", longest);
  if (of.contains("exposure") && !of["exposure"].is_null())
    out.exposure = text(of, "exposure", longest);
  const json& drawn = field(of, "drawn");
  if (!drawn.is_object() || drawn.size() > most_drawn)
    refuse("drawn", fmt::format("is no object of at most {} texts", most_drawn));
  for (const auto& [name, value] : drawn.items())
    out.drawn.emplace_back(name, text(drawn, name.c_str(), longest_drawn));
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
    return Paint{ids(of), all ? std::nullopt : std::optional(id(of, "surface")),
                 id(of, "material")};
  }
  if (what == "duplicate") return Duplicate{ids(of), point(of, "by")};
  if (what == "delete") return Delete{ids(of)};
  if (what == "redraw") {
    constexpr std::size_t most_options = 64, longest = 1000;
    const json& options = field(of, "options");
    if (!options.is_object() || options.size() > most_options)
      refuse("options", fmt::format("is no object of at most {} texts", most_options));
    Redraw out;
    for (const auto& [name, value] : options.items())
      out.options[name] = text(options, name.c_str(), longest);
    return out;
  }
  if (const auto of_form = form_change(of))
    return std::visit([](const auto& one) { return Change(one); }, *of_form);
  refuse("what", fmt::format("is none of move, reshape, paint, duplicate, delete, redraw, {}",
                             form_changes));
}

Save save(const json& of) {
  Save out;
  const json& name = field(of, "name");
  if (!name.is_null()) {
    if (!name.is_string()) refuse("name", "is no text");
    out.name = name.get<std::string>();
    if (out.name->size() > longest_name)
      refuse("name", fmt::format("is longer than {} bytes", longest_name));
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
  if (type == "denoise") return Denoise{truth(message, "on")};
  if (type == "seen") return Seen{truth(message, "seen")};
  if (type == "ask") return ask(message);
  if (type == "snapshot") return Snapshot{};
  if (type == "figure") return figure(message);
  if (type == "end_figure") return EndFigure{};
  if (type == "describe")
    return Describe{number(field(message, "number"), "number", 0, 1e15), id(message, "id"),
                    id(message, "primitive")};
  if (type == "form")
    return Form{number(field(message, "number"), "number", 0, 1e15), part(message)};
  if (type == "edit")
    return Edit{change(message), truth(message, "goes_on"),
                message.contains("number") ? number(message["number"], "number", 0, 1e15) : 0};
  if (type == "undo") return Undo{truth(message, "again")};
  if (type == "save") return save(message);
  if (type == "discard") return Discard{};
  if (type == "kept") return Kept{truth(message, "restore")};
  refuse("type",
         "is none of look, denoise, seen, ask, snapshot, figure, end_figure, describe, form, edit, "
         "undo, save, discard and kept");
}

}  // namespace caplet::view
