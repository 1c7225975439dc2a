// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "present/picture_options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <map>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/spelling.h"
#include "present/lights.h"
#include "scene/texture_image.h"
#include "scene/transform.h"

namespace caplet {

namespace {

[[noreturn]] void refuse(const std::string& flag, const std::string& text, const std::string& why) {
  throw InputError(SourceLocation{flag}, "'" + text + "' " + why);
}

/// Normalises as scene files do.
glm::dvec3 normalized(const glm::dvec3& v) {
  return is_unit(glm::length(v)) ? v : v / glm::length(v);
}

glm::dvec3 linear(const glm::dvec3& srgb) {
  return {decoded_value({}, srgb.x), decoded_value({}, srgb.y), decoded_value({}, srgb.z)};
}

const std::map<std::string, glm::dvec3>& named_colors() {
  static const std::map<std::string, glm::dvec3> colors = {
      {"white", glm::dvec3(1)},
      {"black", glm::dvec3(0)},
      {"grey", linear(glm::dvec3(128 / 255.0))},
      {"gray", linear(glm::dvec3(128 / 255.0))},
      {"lightgrey", linear(glm::dvec3(211 / 255.0))},
      {"lightgray", linear(glm::dvec3(211 / 255.0))},
      {"darkgrey", linear(glm::dvec3(48 / 255.0))},
      {"darkgray", linear(glm::dvec3(48 / 255.0))}};
  return colors;
}

}  // namespace

std::optional<glm::dvec3> three_numbers(std::string_view text) {
  glm::dvec3 out(0);
  for (int i = 0; i < 3; ++i) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out[i]);
    if (error != std::errc() || !std::isfinite(out[i])) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (i == 2) break;
    if (text.empty() || text.front() != ',') return std::nullopt;
    text.remove_prefix(1);
  }
  return text.empty() ? std::optional(out) : std::nullopt;
}

glm::dvec3 parse_axis(const std::string& text, const std::string& flag) {
  const bool is_negative = text.starts_with('-');
  const std::string axis = text.substr(is_negative || text.starts_with('+') ? 1 : 0);
  if (axis.size() != 1 || axis[0] < 'x' || axis[0] > 'z')
    refuse(flag, text, "is none of: x, y, z, -x, -y, -z");
  glm::dvec3 out(0);
  out[axis[0] - 'x'] = is_negative ? -1 : 1;
  return out;
}

glm::dmat3 turned_up(const glm::dvec3& up) {
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), u = glm::normalize(up);
  // The columns are the images of x, y and z.
  if (u == y) return glm::dmat3(1);
  if (u == -y) return {x, -y, -z};
  if (u == z) return {x, -z, y};
  if (u == -z) return {x, z, -y};
  if (u == x) return {y, -x, z};
  if (u == -x) return {-y, x, z};
  // This is Rodrigues' rotation about u x y.
  const glm::dvec3 v = glm::cross(u, y);
  const glm::dmat3 k(glm::dvec3(0, v.z, -v.y), glm::dvec3(-v.z, 0, v.x), glm::dvec3(v.y, -v.x, 0));
  return glm::dmat3(1) + k + k * k * (1 / (1 + u.y));
}

glm::dvec3 parse_view(const std::string& text, const glm::dvec3& up, const std::string& flag) {
  static const std::map<std::string, glm::dvec3> views = {
      {"front", {0, 0, 1}}, {"back", {0, 0, -1}},   {"right", {1, 0, 0}}, {"left", {-1, 0, 0}},
      {"top", {0, 1, 0}},   {"bottom", {0, -1, 0}}, {"iso", {1, 1, 1}}};
  if (const auto found = views.find(text); found != views.end())
    return normalized(glm::transpose(turned_up(up)) * found->second);
  if (const auto direction = three_numbers(text)) {
    if (!(glm::length(*direction) > 0) || !std::isfinite(glm::length(*direction)))
      refuse(flag, text, "has no direction");
    return normalized(*direction);
  }
  std::vector<std::string> names;
  for (const auto& [name, direction] : views) names.push_back(name);
  refuse(flag, text,
         "is no view (front, back, left, right, top, bottom, iso, or x,y,z toward the viewer); the "
         "nearest is '" +
             nearest_name(text, names) + "'");
}

std::optional<glm::dvec3> hex_color(std::string_view text) {
  if (text.size() != 7 || text.front() != '#') return std::nullopt;
  glm::dvec3 out(0);
  for (int i = 0; i < 3; ++i) {
    int value = 0;
    const char* begin = text.data() + 1 + 2 * i;
    const auto [end, error] = std::from_chars(begin, begin + 2, value, 16);
    if (error != std::errc() || end != begin + 2 || value < 0) return std::nullopt;
    out[i] = value / 255.0;
  }
  return linear(out);
}

Backdrop parse_backdrop(const std::string& text, const ImageReader& images,
                        const std::string& flag) {
  Backdrop out;
  if (text == "transparent") return out;
  out.kind = Backdrop::Kind::color;
  if (const auto found = named_colors().find(text); found != named_colors().end()) {
    out.color = found->second;
    return out;
  }
  if (const auto color = hex_color(text)) {
    out.color = *color;
    return out;
  }
  if (const auto color = three_numbers(text)) {
    for (int i = 0; i < 3; ++i)
      if (!((*color)[i] >= 0 && (*color)[i] <= 1))
        refuse(flag, text, "must have numbers from 0 to 1");
    out.color = linear(*color);
    return out;
  }
  std::error_code error;
  if (!std::filesystem::exists(text, error)) {
    std::vector<std::string> names{"transparent"};
    for (const auto& [name, color] : named_colors()) names.push_back(name);
    refuse(flag, text,
           "is no file, and no colour (a name, #rrggbb or r,g,b); the nearest name is '" +
               nearest_name(text, names) + "'");
  }
  out.kind = Backdrop::Kind::image;
  try {
    out.image = std::make_shared<const EnvironmentImage>(images.read_rgb(text));
  } catch (const InputError& wrong) {
    throw InputError(SourceLocation{flag}, wrong.what());
  }
  return out;
}

PreviewExposure parse_exposure(const std::string& text, const std::string& flag) {
  if (text == "auto") return {0, true};
  double stops = 0;
  const char* const end = text.data() + text.size();
  const std::from_chars_result read = std::from_chars(text.data(), end, stops);
  if (read.ec != std::errc() || read.ptr != end || !(std::abs(stops) <= most_stops))
    refuse(flag, text, "is neither auto nor a number from -32 to 32");
  static_assert(most_stops == 32);
  return {stops, false};
}

void set_light(Scene& scene, const std::string& name, const std::string& flag) {
  InfiniteLight light;
  light.image = light_preset(name);
  if (light.image)
    light.world_from_light = around(scene.view.camera);
  else if (name == "flat")
    light.radiance = RgbSpectrum{glm::dvec3(1)};
  else
    refuse(flag, name, "is none of: studio, flat, dramatic");
  scene.lights.clear();
  scene.lights.push_back({light, 1, {}, {}, {scene.source, 0, 0}});
}

void turn_lights_to_camera(Scene& scene) {
  for (Light& light : scene.lights)
    if (is_preset(light))
      std::get<InfiniteLight>(light.model).world_from_light = around(scene.view.camera);
}

}  // namespace caplet
