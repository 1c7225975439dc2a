// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Draws scale bar, axes and colour bar.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "film/transfer.h"
#include "post/detail/parts.h"

namespace caplet::post {

namespace {

std::array<float, 3> srgb_of(const glm::dvec3& linear) {
  std::array<float, 3> out{};
  for (int c = 0; c < 3; ++c)
    out.at(static_cast<std::size_t>(c)) = srgb_from_linear(static_cast<float>(linear[c]));
  return out;
}

}  // namespace

double text_size(const Shown& picture) {
  return std::max(8.0, 0.024 * std::min(picture.width, picture.height));
}

double margin(const Shown& picture) { return std::round(1.4 * text_size(picture)); }

std::array<float, 3> ink_for(const Shown& picture, const LayeredImage& layers) {
  if (picture.has_alpha())
    return {0, 0, 0};  // a transparent picture is assumed to lie on white paper
  const std::vector<float>& coverage = layers.find("A")->floats;
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < coverage.size(); ++i) {
    if (coverage[i] > 0) continue;
    sum += 0.2126 * picture.rgb[i][0] + 0.7152 * picture.rgb[i][1] + 0.0722 * picture.rgb[i][2];
    ++count;
  }
  // The threshold has equal contrast to black and to white by WCAG 2: sqrt(1.05 * 0.05) - 0.05.
  const bool is_dark = count > 0 && sum / count < 0.179;
  const float ink = is_dark ? 1 : 0;
  return {ink, ink, ink};
}

void draw_scale_bar(Shown& picture, const BarOnPicture& bar, const std::array<float, 3>& ink) {
  const double size = text_size(picture), edge = margin(picture),
               thick = std::max(2.0, std::round(0.22 * size));
  // A bar that is nearly as wide as the picture gets a smaller margin, so that it is complete.
  const double right = std::max(picture.width - edge, bar.pixels), bottom = picture.height - edge;
  Mask mask(picture.width, picture.height);
  mask.box({right - bar.pixels, bottom - thick}, {right, bottom});
  const double wide = text_width(bar.label, size);
  const double left =
      std::min(right - 0.5 * (bar.pixels + wide), picture.width - 0.5 * edge - wide);
  text(mask, {left, bottom - thick - 0.6 * size}, bar.label, size);
  paint(picture, mask, ink);
}

void draw_axes(Shown& picture, const Scene& scene, const std::array<float, 3>& ink) {
  struct Arrow {
    int axis;
    glm::dvec2 tip;
    double depth;
  };
  const double size = text_size(picture), length = 3 * size, edge = margin(picture);
  const glm::dmat3 camera(scene.view.camera.world_from_camera);
  std::vector<Arrow> arrows;
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 along = scene.world_from_file[axis];
    const auto part = [&](int of) { return glm::dot(along, glm::normalize(camera[of])); };
    arrows.push_back({axis, length * glm::dvec2(part(0), -part(1)), part(2)});
  }
  // Arrows stay within the corner in any direction; those that point away are drawn first.
  std::ranges::sort(arrows, [](const Arrow& a, const Arrow& b) { return a.depth > b.depth; });
  const double reach = length + 1.2 * size;
  const glm::dvec2 origin(edge + reach, picture.height - edge - reach);
  static constexpr std::array<std::array<float, 3>, 3> colors = {
      {{0.86f, 0.16f, 0.16f}, {0.13f, 0.60f, 0.20f}, {0.16f, 0.38f, 0.90f}}};
  for (const Arrow& arrow : arrows) {
    const double seen = glm::length(arrow.tip);
    Mask mask(picture.width, picture.height);
    const glm::dvec2 end = origin + arrow.tip;
    mask.line(origin, end, 0.18 * size);
    if (seen > 0.5 * size) {
      const glm::dvec2 way = arrow.tip / seen, side(-way.y, way.x);
      for (const double s : {-1.0, 1.0})
        mask.line(end, end - 0.55 * size * way + s * 0.32 * size * side, 0.18 * size);
    }
    paint(picture, mask, colors.at(static_cast<std::size_t>(arrow.axis)));
    Mask letter(picture.width, picture.height);
    const std::string name(1, static_cast<char>('x' + arrow.axis));
    const glm::dvec2 away = seen > 0 ? arrow.tip / seen : glm::dvec2(0);
    const glm::dvec2 middle = end + (seen > 0.5 * size ? 0.85 * size : 0.6 * size) *
                                        (seen > 0 ? away : glm::dvec2(0.7, -0.7));
    text(letter, {middle.x - 0.5 * text_width(name, 0.85 * size), middle.y + 0.28 * size}, name,
         0.85 * size);
    paint(picture, letter, ink);
  }
}

void draw_color_bar(Shown& picture, const Legend& legend, const std::array<float, 3>& ink) {
  const double size = text_size(picture), edge = margin(picture);
  const std::string low = fmt::format("{:.4g}", legend.low),
                    high = fmt::format("{:.4g}", legend.high);
  const std::string title =
      legend.unit.empty() ? legend.title : legend.title + " (" + legend.unit + ")";
  const double wide = std::round(0.9 * size),
               tall = std::round(std::min(12 * size, 0.4 * picture.height));
  const double number = std::max(text_width(low, size), text_width(high, size));
  const double right = picture.width - edge - number - 0.6 * size, top = edge + 2 * size;
  for (int y = 0; y < static_cast<int>(tall); ++y) {
    const double part = 1 - (y + 0.5) / tall;
    const auto steps = static_cast<double>(legend.colors.size());
    const glm::dvec3 color =
        legend.colors.at(static_cast<std::size_t>(std::min(part * steps, steps - 1)));
    for (int x = 0; x < static_cast<int>(wide); ++x) {
      const auto column = static_cast<std::size_t>(std::max(0.0, right - wide + x)),
                 row = static_cast<std::size_t>(top + y);
      if (row >= static_cast<std::size_t>(picture.height) ||
          column >= static_cast<std::size_t>(picture.width))
        continue;
      const std::size_t pixel = row * static_cast<std::size_t>(picture.width) + column;
      for (int c = 0; c < 3; ++c)
        picture.rgb[pixel][static_cast<std::size_t>(c)] = static_cast<float>(color[c]);
      if (picture.has_alpha()) picture.alpha[pixel] = 1;
    }
  }
  Mask mask(picture.width, picture.height);
  text(mask, {right + 0.6 * size, top + 0.5 * size}, high, size);
  text(mask, {right + 0.6 * size, top + tall + 0.5 * size}, low, size);
  const double title_width = text_width(title, size);
  text(mask, {std::max(edge, picture.width - edge - title_width), top - 1.2 * size}, title, size);
  paint(picture, mask, ink);
}

void draw_names(Shown& picture, const Legend& legend, const std::array<float, 3>& ink) {
  const double size = text_size(picture), edge = margin(picture), side = std::round(0.9 * size),
               step = std::round(1.6 * size), top = edge + (legend.title.empty() ? 0.5 : 2) * size;
  std::vector<std::string> names = legend.names;
  // Rows end above the scale bar.
  const auto rows =
      static_cast<std::size_t>(std::max(1.0, (picture.height - top - edge - 3 * size) / step));
  if (names.size() > rows) {
    const std::size_t rest = names.size() - (rows - 1);
    names.resize(rows - 1);
    names.push_back(fmt::format("and {} more", rest));
  }
  double wide = text_width(legend.title, size);
  for (const std::string& name : names) wide = std::max(wide, side + size + text_width(name, size));
  const double left = std::max(edge, picture.width - edge - wide);
  Mask words(picture.width, picture.height);
  text(words, {left, top - 1.2 * size}, legend.title, size);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double y = top + static_cast<double>(i) * step;
    text(words, {left + side + size, y + side}, names[i], size);
    if (i + 1 == names.size() && names.size() < legend.names.size()) break;
    Mask square(picture.width, picture.height);
    square.box({left, y}, {left + side, y + side});
    paint(picture, square, srgb_of(legend.colors.at(i)));
  }
  paint(picture, words, ink);
}

void draw_directions(Shown& picture, const Scene& scene, const std::array<float, 3>& ink) {
  const double size = text_size(picture), edge = margin(picture), radius = 3 * size;
  const glm::dmat3 camera(scene.view.camera.world_from_camera);
  // The axes of the camera within the file: to the right, up and toward the viewer.
  std::array<glm::dvec3, 3> axes{};
  for (int k = 0; k < 3; ++k)
    axes.at(static_cast<std::size_t>(k)) =
        glm::transpose(scene.world_from_file) * ((k == 2 ? -1.0 : 1.0) * glm::normalize(camera[k]));
  const glm::dvec2 middle(picture.width - edge - radius, edge + 2 * size + radius);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const glm::dvec2 at = (glm::dvec2(x + 0.5, y + 0.5) - middle) / radius;
      const double square = glm::dot(at, at);
      const double share = std::clamp(radius * (1 - std::sqrt(square)) + 0.5, 0.0, 1.0);
      const glm::dvec3 unit =
          at.x * axes[0] - at.y * axes[1] + std::sqrt(std::max(0.0, 1 - square)) * axes[2];
      paint(picture,
            static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                static_cast<std::size_t>(x),
            static_cast<float>(share), srgb_of(direction_color(unit)));
    }
  Mask letters(picture.width, picture.height);
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec2 way(axes[0][axis], -axes[1][axis]);
    const std::string name(1, static_cast<char>('x' + axis));
    const glm::dvec2 at = middle + 0.72 * radius * way * (axes[2][axis] < 0 ? -1.0 : 1.0);
    text(letters, {at.x - 0.5 * text_width(name, 0.85 * size), at.y + 0.28 * size}, name,
         0.85 * size);
  }
  paint(picture, letters, {1, 1, 1});
  Mask title(picture.width, picture.height);
  const std::string& words = scene.legend->title;
  text(title, {std::max(edge, picture.width - edge - text_width(words, size)), edge + 0.8 * size},
       words, size);
  paint(picture, title, ink);
}

}  // namespace caplet::post
