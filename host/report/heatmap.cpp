// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "report/heatmap.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "film/image.h"
#include "lower/camera.h"

namespace caplet::report {

namespace {

using Color = std::array<float, 3>;

constexpr Color nothing = {0.02f, 0.02f, 0.02f}, wrong = {1, 0, 0};
constexpr std::array<Color, 5> ramp = {
    {{0, 0, 0}, {0, 0.05f, 0.4f}, {0.05f, 0.5f, 0.4f}, {0.9f, 0.7f, 0.1f}, {1, 1, 1}}};

constexpr float decades = 3;

Color color_of(const verify::HeatPixel& pixel) {
  if (pixel.disagrees) return wrong;
  if (!pixel.hit) return nothing;
  const float worst = *std::ranges::max_element(pixel.in_bounds);
  const float share = std::clamp(1 + std::log10(worst) / decades, 0.f, 1.f);
  const float at = share * static_cast<float>(ramp.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), ramp.size() - 2);
  const float part = at - static_cast<float>(low);
  Color out{};
  for (std::size_t k = 0; k < 3; ++k) out[k] = (1 - part) * ramp[low][k] + part * ramp[low + 1][k];
  return out;
}

}  // namespace

void write_heatmap(const std::filesystem::path& path, const Scene& scene,
                   const std::vector<verify::HeatPixel>& pixels) {
  FlatView frame;
  lower_camera(scene, frame);
  const ViewRecord& p = frame.view;
  LayeredImage image;
  image.width = static_cast<int>(p.width);
  image.height = static_cast<int>(p.height);
  image.x = static_cast<int>(p.crop_x);
  image.y = static_cast<int>(p.crop_y);
  image.data_width = static_cast<int>(p.crop_width);
  image.data_height = static_cast<int>(p.crop_height);
  const auto add = [&](const char* name, const auto& value) {
    Channel channel{name, {}, {}};
    channel.floats.reserve(pixels.size());
    for (const verify::HeatPixel& pixel : pixels) channel.floats.push_back(value(pixel));
    image.channels.push_back(std::move(channel));
  };
  for (std::size_t k = 0; k < 3; ++k)
    add(std::array{"R", "G", "B"}[k],
        [k](const verify::HeatPixel& pixel) { return color_of(pixel)[k]; });
  for (std::size_t q = 0; q < verify::quantity_names.size(); ++q)
    add(verify::quantity_names[q],
        [q](const verify::HeatPixel& pixel) { return pixel.in_bounds[q]; });
  add("grazing", [](const verify::HeatPixel& pixel) { return pixel.grazed ? 1.f : 0.f; });
  add("disagrees", [](const verify::HeatPixel& pixel) { return pixel.disagrees ? 1.f : 0.f; });
  image.metadata["caplet:picture"] = "caplet verify: errors in units of the stated bounds";
  write_exr(path, image);
}

}  // namespace caplet::report
