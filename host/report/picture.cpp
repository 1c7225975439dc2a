// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "report/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "base/threads.h"
#include "film/preview.h"

namespace caplet::report {

std::string of_devices(const RenderResult& result, std::string DeviceWork::*what) {
  std::string out;
  for (const DeviceWork& device : result.devices)
    if (!device.lost) out += (out.empty() ? "" : ", ") + device.*what;
  return out;
}

std::map<std::string, std::string> picture_metadata(const Scene& scene,
                                                    const std::string& scene_file,
                                                    const std::string& command,
                                                    const RenderResult& result) {
  return {{"software", "Caplet " CAPLET_VERSION},
          {"caplet.version", CAPLET_VERSION},
          {"caplet.scene", scene_file},
          {"caplet.command", command},
          {"caplet.samples_per_pixel", fmt::format("{}", result.samples_per_pixel)},
          {"caplet.seed", fmt::format("{}", scene.view.sampler.seed)},
          {"caplet.max_depth", fmt::format("{}", scene.view.integrator.max_depth)},
          {"caplet.device", of_devices(result, &DeviceWork::name)},
          {"caplet.driver", of_devices(result, &DeviceWork::driver)},
          {"caplet.platform", of_devices(result, &DeviceWork::platform)},
          {"caplet.render_seconds", fmt::format("{:.3f}", result.render_seconds)},
          {"caplet.interrupted", result.interrupted ? "yes" : "no"}};
}

namespace {

std::vector<std::string> names_of(Layers layers) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < layer_rows.size(); ++i) {
    if (!layers.has(static_cast<Layer>(i))) continue;
    for (std::string_view names = layer_rows[i].channels; !names.empty();) {
      const std::size_t comma = std::min(names.find(','), names.size());
      out.emplace_back(names.substr(0, comma));
      names.remove_prefix(std::min(comma + 1, names.size()));
    }
  }
  return out;
}

/// A preview that is made band after band.
class Preview {
 public:
  explicit Preview(const Finish& finish) : finish_(finish), looked_at_(names_of(finish.layers)) {}

  void add(const LayeredImage& band) {
    Shown part = shown(band);
    if (!finish_.draw) {
      const std::vector<std::uint8_t> more = bytes_of(part);
      bytes_.insert(bytes_.end(), more.begin(), more.end());
      return;
    }
    if (layers_.channels.empty()) {
      layers_ = band;
      layers_.channels.clear();
      for (const std::string& name : looked_at_) layers_.channels.push_back({name, {}, {}});
      layers_.data_height = 0;
      picture_.width = band.data_width;
    }
    layers_.data_height += band.data_height;
    picture_.height = layers_.data_height;
    picture_.rgb.insert(picture_.rgb.end(), part.rgb.begin(), part.rgb.end());
    picture_.alpha.insert(picture_.alpha.end(), part.alpha.begin(), part.alpha.end());
    for (Channel& channel : layers_.channels)
      if (const Channel* more = band.find(channel.name)) {
        channel.floats.insert(channel.floats.end(), more->floats.begin(), more->floats.end());
        channel.uints.insert(channel.uints.end(), more->uints.begin(), more->uints.end());
      }
  }

  std::vector<std::uint8_t> bytes() {
    if (!finish_.draw) return std::move(bytes_);
    finish_.draw(picture_, layers_);
    return bytes_of(picture_);
  }

 private:
  const Finish& finish_;
  std::vector<std::string> looked_at_;
  std::vector<std::uint8_t> bytes_;
  Shown picture_;
  LayeredImage layers_;
};

}  // namespace

void write_pictures(const std::filesystem::path& picture, const std::filesystem::path& preview,
                    const BandedImage& image, std::size_t channels, double render_seconds,
                    const Finish& finish) {
  Preview small(finish);
  const std::vector<std::string> written = names_of(finish.written);
  std::vector<std::string> unwanted = names_of(Layers::all());
  std::erase_if(unwanted, [&](const std::string& name) {
    return std::ranges::find(written, name) != written.end();
  });
  BandedImage shown = image;
  if (!preview.empty())
    shown.band = [&](int first, int rows) {
      LayeredImage band = image.band(first, rows);
      small.add(band);
      std::erase_if(band.channels, [&](const Channel& c) {
        return std::ranges::find(unwanted, c.name) != unwanted.end();
      });
      return band;
    };
  const LayeredImage& whole = image.whole;
  if (!picture.empty()) {
    const std::uint64_t size = static_cast<std::uint64_t>(whole.data_width) *
                               static_cast<std::uint64_t>(whole.data_height) * channels *
                               sizeof(float);
    write_exr(picture, shown, compression_for(size, render_seconds, usable_threads()));
  } else if (!preview.empty()) {
    for (int first = 0; first < whole.data_height; first += shown.rows)
      shown.band(first, std::min(shown.rows, whole.data_height - first));
  }
  if (!preview.empty()) write_preview(preview, whole.data_width, whole.data_height, small.bytes());
}

}  // namespace caplet::report
