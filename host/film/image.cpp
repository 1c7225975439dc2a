// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads images as importers need them: linear RGB.
#include "film/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/log.h"
#include "base/spelling.h"
#include "film/detail/image_files.h"
#include "film/detail/image_module.h"

namespace caplet {

namespace fs = std::filesystem;

namespace {

bool is_exr(const fs::path& path) { return lower_case(path.extension().string()) == ".exr"; }

/// Returns the channels for red, green and blue: the main layer's, else luminance, else the first
/// layer with all three, else a single channel.
std::array<const Channel*, 3> color_channels(const fs::path& path, const LayeredImage& image) {
  const auto triple = [&](const std::string& prefix) {
    return std::array{image.find(prefix + "R"), image.find(prefix + "G"), image.find(prefix + "B")};
  };
  const auto usable = [](const std::array<const Channel*, 3>& c) {
    return std::all_of(c.begin(), c.end(),
                       [](const Channel* one) { return one && !one->floats.empty(); });
  };
  if (const auto main = triple(""); usable(main)) return main;
  if (const Channel* grey = image.find("Y"); grey && !grey->floats.empty())
    return {grey, grey, grey};
  for (const Channel& channel : image.channels)
    if (channel.name.ends_with(".R"))
      if (const auto layer = triple(channel.name.substr(0, channel.name.size() - 1)); usable(layer))
        return layer;
  if (image.channels.size() == 1 && !image.channels[0].floats.empty())
    return {&image.channels[0], &image.channels[0], &image.channels[0]};
  throw InputError(path.string() + ": has no R G B channels");
}

EnvironmentImage rgb_of(const fs::path& path, const LayeredImage& image) {
  const std::array<const Channel*, 3> channels = color_channels(path, image);
  EnvironmentImage out;
  out.width = image.data_width;
  out.height = image.data_height;
  out.space = image.space;
  const std::size_t pixels = channels[0]->floats.size();
  out.rgb.resize(3 * pixels);
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < 3; ++c) out.rgb[3 * i + c] = channels[c]->floats[i];

  if (image.chromaticities && !color_space_of(*image.chromaticities)) {
    const std::array<double, 9> m =
        product(inverse(xyz_from_rgb(chromaticities_of(ColorSpace::srgb))),
                xyz_from_rgb(*image.chromaticities));
    out.space = ColorSpace::srgb;
    for (std::size_t i = 0; i < pixels; ++i) {
      const std::array<float, 3> v{out.rgb[3 * i], out.rgb[3 * i + 1], out.rgb[3 * i + 2]};
      for (std::size_t r = 0; r < 3; ++r)
        out.rgb[3 * i + r] =
            static_cast<float>(m[3 * r] * v[0] + m[3 * r + 1] * v[1] + m[3 * r + 2] * v[2]);
    }
  }
  return out;
}

EnvironmentImage rgb_of(const image_files::Pixels& pixels) {
  EnvironmentImage out;
  out.width = pixels.width;
  out.height = pixels.height;
  const std::size_t count =
      static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height);
  const std::size_t channels = static_cast<std::size_t>(pixels.channels);
  const bool grey = pixels.channels - (pixels.alpha >= 0 ? 1 : 0) < 3;
  out.rgb.resize(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const float* from = &pixels.values[i * channels];
    const float alpha = pixels.alpha >= 0 ? from[pixels.alpha] : 1.0f;
    for (std::size_t c = 0; c < 3; ++c) out.rgb[3 * i + c] = alpha * from[grey ? 0 : c];
  }
  return out;
}

/// Checks that radiance is finite and not negative.
void check_values(const fs::path& path, EnvironmentImage& image) {
  std::size_t negative = 0;
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    float& value = image.rgb[i];
    if (!std::isfinite(value)) {
      const std::size_t pixel = i / 3, width = static_cast<std::size_t>(image.width);
      throw InputError(fmt::format("{}: pixel ({}, {}) is not finite", path.string(), pixel % width,
                                   pixel / width));
    }
    if (value < 0) {
      value = 0;
      ++negative;
    }
  }
  if (negative > 0) log::warn("{}: {} negative values taken as 0", path.string(), negative);
}

/// Returns the channels of a texture: grey, three, or four where alpha is not 1 everywhere. `one`
/// is the value for 1.
template <class Value>
std::vector<Value> texture_channels(const std::vector<Value>& from, int channels, int alpha,
                                    Value one, int& kept) {
  const auto step = static_cast<std::size_t>(channels);
  const int colors = channels - (alpha >= 0 ? 1 : 0);
  bool has_alpha = false;
  if (alpha >= 0 && colors >= 3)
    for (std::size_t i = static_cast<std::size_t>(alpha); i < from.size() && !has_alpha; i += step)
      has_alpha = from[i] != one;
  kept = colors < 3 ? 1 : has_alpha ? 4 : 3;
  if (kept == channels) return from;
  std::vector<Value> out;
  out.reserve(from.size() / step * static_cast<std::size_t>(kept));
  for (std::size_t i = 0; i < from.size(); i += step)
    out.insert(out.end(), from.begin() + static_cast<std::ptrdiff_t>(i),
               from.begin() + static_cast<std::ptrdiff_t>(i) + kept);
  return out;
}

TextureImage texture_of(const image_files::StoredPixels& pixels, const ImageEncoding& encoding) {
  TextureImage out;
  out.width = pixels.width;
  out.height = pixels.height;
  if (!pixels.bytes.empty()) {
    out.bytes = texture_channels<std::uint8_t>(pixels.bytes, pixels.channels, pixels.alpha, 255,
                                               out.channels);
    for (std::size_t i = 0; i < 256; ++i)
      out.decoded[i] = static_cast<float>(decoded_value(encoding, static_cast<double>(i) / 255));
    return out;
  }
  out.floats =
      texture_channels<float>(pixels.floats, pixels.channels, pixels.alpha, 1, out.channels);
  if (pixels.is_whole)
    for (std::size_t i = 0; i < out.floats.size(); ++i)
      if (out.channels != 4 || i % 4 != 3)
        out.floats[i] = static_cast<float>(decoded_value(encoding, out.floats[i]));
  return out;
}

TextureImage texture_of(const fs::path& path, const LayeredImage& image) {
  TextureImage out;
  out.width = image.data_width;
  out.height = image.data_height;
  const std::array<const Channel*, 3> colors = color_channels(path, image);
  if (colors[0] == colors[1] && colors[1] == colors[2]) {
    out.floats = colors[0]->floats;
    return out;
  }
  const EnvironmentImage rgb = rgb_of(path, image);
  out.space = rgb.space;
  const Channel* alpha = colors[0]->name == "R" ? image.find("A") : nullptr;
  if (alpha &&
      (alpha->floats.empty() || std::ranges::all_of(alpha->floats, [](float a) { return a == 1; })))
    alpha = nullptr;
  out.channels = alpha ? 4 : 3;
  for (std::size_t i = 0; i < rgb.rgb.size() / 3; ++i) {
    out.floats.insert(out.floats.end(), {rgb.rgb[3 * i], rgb.rgb[3 * i + 1], rgb.rgb[3 * i + 2]});
    if (alpha) out.floats.push_back(alpha->floats[i]);
  }
  return out;
}

}  // namespace

const Channel* LayeredImage::find(const std::string& name) const {
  const auto found = std::find_if(channels.begin(), channels.end(),
                                  [&](const Channel& c) { return c.name == name; });
  return found == channels.end() ? nullptr : &*found;
}

bool has_image_io() { return image_files::available(); }

EnvironmentImage FileImageReader::read_rgb(const fs::path& path) const {
  EnvironmentImage image =
      is_exr(path) ? rgb_of(path, read_exr(path)) : rgb_of(image_files::read_linear(path));
  check_values(path, image);
  image.file = path.string();
  return image;
}

TextureImage FileImageReader::read_texture(const fs::path& path,
                                           const ImageEncoding& encoding) const {
  TextureImage image = is_exr(path) ? texture_of(path, read_exr(path))
                                    : texture_of(image_files::read_stored(path), encoding);
  for (std::size_t i = 0; i < image.floats.size(); ++i)
    if (!std::isfinite(image.floats[i])) {
      const std::size_t pixel = i / static_cast<std::size_t>(image.channels),
                        width = static_cast<std::size_t>(image.width);
      throw InputError(fmt::format("{}: pixel ({}, {}) is not finite", path.string(), pixel % width,
                                   pixel / width));
    }
  image.file = path.string();
  image.encoding = encoding;
  return image;
}

}  // namespace caplet
