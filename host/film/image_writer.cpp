// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Writes images of scenes.
#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "base/atomic_file.h"
#include "base/content_hash.h"
#include "base/error.h"
#include "base/reading.h"
#include "film/detail/image_png.h"
#include "film/image.h"

namespace caplet {

namespace fs = std::filesystem;

namespace {

/// Calls `write` with the path of a file whose name tells its contents, unless it is there.
template <class Write>
ImageWriter::File file_of(const fs::path& stem, std::string_view contents, const char* extension,
                          const Write& write) {
  constexpr std::size_t digits = 12;  // 48 bits of the hash
  ImageWriter::File out;
  out.path = stem;
  out.path += "-" + content_hash(contents).substr(0, digits) + extension;
  if (is_there(out.path, {})) return out;
  write(out.path);
  out.is_new = true;
  return out;
}

/// Returns whether a PNG is read as the same values.
bool is_png_like(const TextureImage& image) {
  if (image.bytes.empty() || image.space != ColorSpace::srgb) return false;
  for (std::size_t i = 0; i < image.decoded.size(); ++i)
    if (image.decoded[i] !=
        static_cast<float>(decoded_value(image.encoding, static_cast<double>(i) / 255)))
      return false;
  return std::max(image.width, image.height) <= image_files::max_png_side;
}

ImageWriter::File write_floats(const fs::path& stem, int width, int height, ColorSpace space,
                               std::span<const float> values) {
  LayeredImage out;
  out.width = out.data_width = width;
  out.height = out.data_height = height;
  out.space = space;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                    channels = values.size() / pixels;
  const std::string_view names = channels == 1 ? "Y" : "RGBA";
  std::string contents(names.substr(0, channels));
  contents += std::to_string(width) + " " + std::to_string(static_cast<int>(space));
  contents.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  for (std::size_t c = 0; c < channels; ++c) {
    Channel channel{std::string(names.substr(c, 1)), {}, {}};
    channel.floats.reserve(pixels);
    for (std::size_t i = 0; i < pixels; ++i) channel.floats.push_back(values[i * channels + c]);
    out.channels.push_back(std::move(channel));
  }
  return file_of(stem, contents, ".exr", [&](const fs::path& path) { write_exr(path, out); });
}

}  // namespace

ImageWriter::File FileImageWriter::write(const fs::path& stem, const TextureImage& image) const {
  if (is_png_like(image)) {
    std::string png;
    const std::string why =
        image_files::encode_png(image.width, image.height, image.channels, image.bytes, png);
    if (!why.empty()) throw RunError(stem.string() + ".png: " + why);
    return file_of(stem, png, ".png", [&](const fs::path& path) { write_bytes(path, png); });
  }
  std::vector<float> floats = image.floats;
  for (std::size_t i = 0; i < image.bytes.size(); ++i) {
    const bool is_alpha = image.channels == 4 && i % 4 == 3;
    floats.push_back(is_alpha ? static_cast<float>(image.bytes[i]) / 255.0f
                              : image.decoded[image.bytes[i]]);
  }
  return write_floats(stem, image.width, image.height, image.space, floats);
}

ImageWriter::File FileImageWriter::write(const fs::path& stem,
                                         const EnvironmentImage& image) const {
  return write_floats(stem, image.width, image.height, image.space, image.rgb);
}

}  // namespace caplet
