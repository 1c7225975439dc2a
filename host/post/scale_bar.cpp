// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "post/scale_bar.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "post/detail/joined.h"
#include "present/least_width.h"

namespace caplet::post {

namespace {

constexpr double kMostOfWidth = 0.25;  // of the film: the limit of an automatic bar

struct Unit {
  double metres;
  const char* label;
};

std::optional<Unit> unit_named(const std::string& name) {
  static const std::map<std::string, Unit> units = {{"pm", {1e-12, "pm"}},
                                                    {"A", {1e-10, "\u00c5"}},
                                                    {"\u00c5", {1e-10, "\u00c5"}},
                                                    {"angstrom", {1e-10, "\u00c5"}},
                                                    {"nm", {1e-9, "nm"}},
                                                    {"um", {1e-6, "\u00b5m"}},
                                                    {"\u00b5m", {1e-6, "\u00b5m"}},
                                                    {"\u03bcm", {1e-6, "\u00b5m"}},
                                                    {"micron", {1e-6, "\u00b5m"}},
                                                    {"mm", {1e-3, "mm"}},
                                                    {"cm", {1e-2, "cm"}},
                                                    {"m", {1, "m"}},
                                                    {"km", {1e3, "km"}}};
  const auto found = units.find(name);
  return found == units.end() ? std::nullopt : std::optional(found->second);
}

/// Returns the longest of 1, 2 and 5 times a power of ten that is at most `most`.
double round_length(double most) {
  const double power = std::pow(10, std::floor(std::log10(most)));
  for (const double digit : {5.0, 2.0})
    if (digit * power <= most * (1 + 1e-9)) return digit * power;
  return power;
}

}  // namespace

Sight::Sight(const Scene& of) : bounds(bounds_of(of)), joined(joined_objects(of.shapes)) {
  scene.view.camera = of.view.camera;
  scene.view.film = of.view.film;
  scene.world_from_file = of.world_from_file;
  scene.unit = of.unit;
  scene.legend = of.legend;
}

ScaleBar parse_scale_bar(const std::string& text, const std::string& flag) {
  ScaleBar out;
  if (text.empty()) return out;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out.length);
  const std::string_view rest(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (error != std::errc() || !(out.length > 0) || !std::isfinite(out.length))
    throw InputError(SourceLocation{flag},
                     fmt::format("'{}' is no length above 0, like \"50 um\"", text));
  const std::size_t begin = rest.find_first_not_of(' ');
  if (begin != std::string_view::npos)
    out.unit = rest.substr(begin, rest.find_last_not_of(' ') + 1 - begin);
  return out;
}

BarOnPicture bar_of(const ScaleBar& asked, const Sight& sight, const std::string& flag) {
  const Scene& scene = sight.scene;
  const Bounds& bounds = sight.bounds;
  if (bounds.empty())
    throw InputError(SourceLocation{flag}, "the scene has no shapes that a bar could measure");
  if (!has_image_plane(scene.view.camera))
    throw InputError(SourceLocation{flag},
                     fmt::format("the picture of a {} camera has no scale",
                                 projection_names.at(scene.view.camera.projection.index())));
  const glm::dvec3 middle = 0.5 * (bounds.min + bounds.max);
  const double footprint = pixel_footprint(scene.view.camera, scene.view.film, middle);
  if (!(footprint > 0))
    throw InputError(SourceLocation{flag}, "what is seen lies behind the camera");
  const auto own = unit_named(scene.unit);
  double per_unit = 1;  // scene units per unit of the label
  std::string label = scene.unit;
  if (!asked.unit.empty()) {
    const auto wanted = unit_named(asked.unit);
    if (own && !wanted)
      throw InputError(
          SourceLocation{flag},
          fmt::format("'{}' is no unit of length (pm, A, nm, um, mm, cm, m, km)", asked.unit));
    label = wanted ? wanted->label : asked.unit;
    if (own) per_unit = wanted->metres / own->metres;
  }
  BarOnPicture out;
  const double length =
      asked.length > 0 ? asked.length
                       : round_length(kMostOfWidth * scene.view.film.width * footprint / per_unit);
  out.pixels = length * per_unit / footprint;
  out.label = label.empty() ? fmt::format("{:g}", length) : fmt::format("{:g} {}", length, label);
  if (!is_orthographic(scene.view.camera)) {
    const glm::dmat4& m = scene.view.camera.world_from_camera;
    out.distance = glm::dot(middle - glm::dvec3(m[3]), glm::normalize(glm::dvec3(m[2])));
  }
  const auto crop = scene.view.film.crop.value_or(
      std::array<int, 4>{0, scene.view.film.width, 0, scene.view.film.height});
  if (out.pixels > crop[1] - crop[0])
    throw InputError(SourceLocation{flag},
                     fmt::format("{} are {:.0f} pixels, more than the picture's {}", out.label,
                                 out.pixels, crop[1] - crop[0]));
  return out;
}

}  // namespace caplet::post
