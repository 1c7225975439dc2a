// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/atomic_file.h"
#include "base/error.h"
#include "film/detail/image_files.h"
#include "film/detail/image_module.h"
#include "film/transfer.h"
#include "film/under.h"

namespace caplet {

namespace fs = std::filesystem;

namespace {

constexpr float knee = 0.5f;
constexpr float whitening = 0.125f;

std::uint8_t byte_from_linear(float value) {
  return static_cast<std::uint8_t>(
      std::lround(std::clamp(srgb_from_linear(value), 0.0f, 1.0f) * 255));
}

}  // namespace

std::array<float, 3> tone_map(const std::array<float, 3>& rgb) {
  std::array<float, 3> out{};
  for (std::size_t c = 0; c < 3; ++c) out[c] = rgb[c] > 0 ? rgb[c] : 0.0f;
  const float peak = std::max({out[0], out[1], out[2]});
  if (!(peak > knee)) return out;
  if (std::isinf(peak)) return {1, 1, 1};
  const float mapped = 1 - (1 - knee) * std::exp(-(peak - knee) / (1 - knee));
  const float white = 1 - 1 / (1 + whitening * (peak - mapped));
  for (float& value : out) value = value * (mapped / peak) * (1 - white) + mapped * white;
  return out;
}

double display_slope(double luminance) {
  const double over = std::max(0.0, (luminance - double{knee}) / (1 - double{knee}));
  const double mapped =
      over > 0 ? 1 - (1 - double{knee}) * std::exp(-over) : luminance;  // as tone_map has a grey
  const double encoding = mapped <= 0.0031308 ? 12.92 : 1.055 / 2.4 * std::pow(mapped, 1 / 2.4 - 1);
  return encoding * std::exp(-over);
}

Shown shown(const LayeredImage& image) {
  const std::array<const Channel*, 3> channels{image.find("R"), image.find("G"), image.find("B")};
  if (!channels[0] || !channels[1] || !channels[2])
    throw std::logic_error("preview of an image without R G B");
  const Channel* coverage = image.backdrop ? image.find("A") : nullptr;
  if (image.backdrop && !coverage)
    throw std::logic_error("preview of an image without A over a backdrop");
  const Chromaticities from =
      image.chromaticities ? *image.chromaticities : chromaticities_of(image.space);
  const std::array<double, 9> m =
      product(inverse(xyz_from_rgb(chromaticities_of(ColorSpace::srgb))), xyz_from_rgb(from));
  const bool convert = from != chromaticities_of(ColorSpace::srgb);

  Shown out{image.data_width, image.data_height, {}, {}};
  const bool is_transparent = image.backdrop && image.backdrop->kind == Backdrop::Kind::transparent;
  out.rgb.resize(channels[0]->floats.size());
  if (is_transparent) out.alpha.resize(out.rgb.size());
  for (std::size_t i = 0; i < out.rgb.size(); ++i) {
    const std::array<float, 3> v{channels[0]->floats[i], channels[1]->floats[i],
                                 channels[2]->floats[i]};
    std::array<float, 3> rgb = v;
    if (convert)
      for (std::size_t r = 0; r < 3; ++r)
        rgb[r] = static_cast<float>(m[3 * r] * v[0] + m[3 * r + 1] * v[1] + m[3 * r + 2] * v[2]);
    if (!coverage) {
      out.rgb[i] = tone_map(rgb);
      continue;
    }
    // Noise of the filter's negative lobes may leave coverage outside [0, 1]; it is clamped.
    const float a = std::clamp(coverage->floats[i], 0.0f, 1.0f);
    const auto width = static_cast<std::size_t>(image.data_width);
    const std::array<float, 3> behind =
        under(*image.backdrop, image.width, image.height, image.x + static_cast<int>(i % width),
              image.y + static_cast<int>(i / width));
    std::array<float, 3> shapes{};
    if (a > 0) {
      for (std::size_t c = 0; c < 3; ++c) shapes[c] = (rgb[c] - (1 - a) * behind[c]) / a;
      shapes = tone_map(shapes);
    }
    if (is_transparent) {
      out.rgb[i] = shapes;
      out.alpha[i] = a;
    } else {
      for (std::size_t c = 0; c < 3; ++c) out.rgb[i][c] = a * shapes[c] + (1 - a) * behind[c];
    }
  }
  return out;
}

std::vector<std::uint8_t> bytes_of(const Shown& shown) {
  std::vector<std::uint8_t> out;
  out.reserve((shown.has_alpha() ? 4 : 3) * shown.rgb.size());
  for (std::size_t i = 0; i < shown.rgb.size(); ++i) {
    for (const float value : shown.rgb[i]) out.push_back(byte_from_linear(value));
    if (shown.has_alpha())
      out.push_back(static_cast<std::uint8_t>(std::lround(255 * shown.alpha[i])));
  }
  return out;
}

std::vector<std::uint8_t> preview_rgb8(const LayeredImage& image) {
  Shown out = shown(image);
  for (std::size_t i = 0; i < out.alpha.size(); ++i)
    for (float& value : out.rgb[i]) value *= out.alpha[i];
  out.alpha.clear();
  return bytes_of(out);
}

void write_preview(const fs::path& path, const LayeredImage& image) {
  write_preview(path, shown(image));
}

void write_preview(const fs::path& path, const Shown& shown) {
  write_preview(path, shown.width, shown.height, bytes_of(shown));
}

void write_preview(const fs::path& path, int width, int height,
                   const std::vector<std::uint8_t>& bytes) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  write_bytes(path, image_files::encode_8bit(path, width, height,
                                             static_cast<int>(bytes.size() / pixels), bytes));
}

std::string png_bytes(const Shown& shown) {
  return image_files::encode_8bit("figure.png", shown.width, shown.height,
                                  shown.has_alpha() ? 4 : 3, bytes_of(shown));
}

void check_preview_alpha(const fs::path& path, const std::string& flag) {
  if (!image_files::can_write_alpha(path))
    throw InputError(SourceLocation{flag}, fmt::format("'{}' holds no transparency (try .png)",
                                                       path.extension().string()));
}

void check_preview_size(const fs::path& path, int width, int height, const std::string& flag) {
  if (!image_files::can_hold(path, width, height))
    throw InputError(
        SourceLocation{flag},
        fmt::format("'{}': a picture of {} x {} pixels is larger than its format can hold",
                    path.string(), width, height));
}

void check_preview_format(const fs::path& path, const std::string& flag) {
  const std::string extension = path.extension().string();
  if (extension.empty())
    throw InputError(
        SourceLocation{flag},
        fmt::format("'{}' has no extension to tell the format (try .png)", path.string()));
  if (!image_files::available() && !image_files::can_write(path))
    throw InputError(SourceLocation{flag},
                     "previews other than PNG need OpenImageIO, and this build is without it "
                     "(CAPLET_WITH_OIIO=OFF)");
  if (extension == ".exr" || !image_files::can_write(path))
    throw InputError(SourceLocation{flag},
                     fmt::format("'{}' is no preview format (try .png or .jpg)", extension));
}

}  // namespace caplet
