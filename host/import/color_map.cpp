// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/color_map.h"

#include <algorithm>
#include <array>
#include <utility>

#include "scene/texture_image.h"

namespace caplet {

namespace {

/// Every 32nd of matplotlib's 256 colours, sRGB; the map is linear between them.
const std::array<glm::dvec3, 9> knots = {{{0.267004, 0.004874, 0.329415},
                                          {0.278826, 0.175490, 0.483397},
                                          {0.229739, 0.322361, 0.545706},
                                          {0.172719, 0.448791, 0.557885},
                                          {0.127568, 0.566949, 0.550556},
                                          {0.157851, 0.683765, 0.501686},
                                          {0.369214, 0.788888, 0.382914},
                                          {0.678489, 0.863742, 0.189503},
                                          {0.993248, 0.906157, 0.143936}}};

}  // namespace

glm::dvec3 viridis(double part) {
  const double at = std::clamp(part, 0.0, 1.0) * (knots.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), knots.size() - 2);
  const double f = at - static_cast<double>(i);
  const glm::dvec3 c = knots.at(i) * (1 - f) + knots.at(i + 1) * f;
  return {decoded_value({}, c.x), decoded_value({}, c.y), decoded_value({}, c.z)};
}

glm::dvec3 red_white_blue(double part) {
  const double at = 2 * std::clamp(part, 0.0, 1.0), faded = decoded_value({}, at < 1 ? at : 2 - at);
  return at < 1 ? glm::dvec3(1, faded, faded) : glm::dvec3(faded, faded, 1);
}

Legend map_legend(std::string title, std::string unit, double low, double high, ColorMap map) {
  Legend out{std::move(title), std::move(unit), low, high, {}};
  for (int step = 0; step < map_steps; ++step)
    out.colors.push_back(map(static_cast<double>(step) / (map_steps - 1)));
  return out;
}

std::optional<Legend> names_legend(std::string title, const std::vector<Material>& all,
                                   const std::vector<std::uint32_t>& materials) {
  if (materials.empty()) return std::nullopt;
  Legend out{std::move(title), "", 0, 1, {}};
  for (const std::uint32_t i : materials) {
    out.names.push_back(all[i].name);
    out.colors.push_back(
        std::get<RgbSpectrum>(std::get<DiffuseMaterial>(all[i].model).reflectance).rgb);
  }
  return out;
}

void add_names(Legend& legend, const Legend& more) {
  if (legend.names.empty()) return;
  if (legend.title != more.title) legend.title.clear();
  for (std::size_t i = 0; i < more.names.size(); ++i) {
    if (std::ranges::find(legend.names, more.names[i]) != legend.names.end()) continue;
    legend.names.push_back(more.names[i]);
    legend.colors.push_back(more.colors[i]);
  }
}

}  // namespace caplet
