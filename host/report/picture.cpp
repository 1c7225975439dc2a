// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "report/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <vector>

#include "film/preview.h"

namespace caplet::report {

std::string of_devices(const RenderResult& result, std::string DeviceWork::*what) {
  std::string out;
  for (const DeviceWork& device : result.devices)
    if (!device.lost) out += (out.empty() ? "" : ", ") + device.*what;
  return out;
}

std::map<std::string, std::string> picture_metadata(const Scene& scene, const std::string& scene_file, const std::string& command,
                                                    const RenderResult& result) {
  return {{"software", "Caplet " CAPLET_VERSION},
          {"caplet.version", CAPLET_VERSION},
          {"caplet.scene", scene_file},
          {"caplet.command", command},
          {"caplet.samples_per_pixel", fmt::format("{}", result.samples_per_pixel)},
          {"caplet.seed", fmt::format("{}", scene.sampler.seed)},
          {"caplet.max_depth", fmt::format("{}", scene.integrator.max_depth)},
          {"caplet.device", of_devices(result, &DeviceWork::name)},
          {"caplet.driver", of_devices(result, &DeviceWork::driver)},
          {"caplet.platform", of_devices(result, &DeviceWork::platform)},
          {"caplet.render_seconds", fmt::format("{:.3f}", result.render_seconds)},
          {"caplet.interrupted", result.interrupted ? "yes" : "no"}};
}

void write_pictures(const std::filesystem::path& picture, const std::filesystem::path& preview, const BandedImage& image,
                    std::size_t channels, double render_seconds) {
  std::vector<std::uint8_t> bytes;
  BandedImage shown = image;
  if (!preview.empty())
    shown.band = [&](int first, int rows) {
      LayeredImage band = image.band(first, rows);
      const std::vector<std::uint8_t> rgb = preview_rgb8(band);
      bytes.insert(bytes.end(), rgb.begin(), rgb.end());
      return band;
    };
  const LayeredImage& whole = image.whole;
  if (!picture.empty()) {
    const std::uint64_t size =
        static_cast<std::uint64_t>(whole.data_width) * static_cast<std::uint64_t>(whole.data_height) * channels * sizeof(float);
    write_exr(picture, shown, compression_for(size, render_seconds, std::thread::hardware_concurrency()));
  } else if (!preview.empty()) {
    for (int first = 0; first < whole.data_height; first += shown.rows)
      shown.band(first, std::min(shown.rows, whole.data_height - first));
  }
  if (!preview.empty()) write_preview(preview, whole.data_width, whole.data_height, bytes);
}

}  // namespace caplet::report
