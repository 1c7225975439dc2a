// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
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

namespace {

/// Reads the pixels of an image before they are exposed.
class Pixels {
 public:
  /// A pixel of which `shapes` have the share `coverage`. Linear sRGB.
  struct Pixel {
    std::array<float, 3> shapes{}, behind{};
    float coverage = 1;
  };

  explicit Pixels(const LayeredImage& image)
      : image_(image), channels_{image.find("R"), image.find("G"), image.find("B")} {
    if (!channels_[0] || !channels_[1] || !channels_[2])
      throw std::logic_error("preview of an image without R G B");
    coverage_ = image.find("A");
    if (image.backdrop && !coverage_)
      throw std::logic_error("preview of an image without A over a backdrop");
    const Chromaticities from =
        image.chromaticities ? *image.chromaticities : chromaticities_of(image.space);
    if (from != chromaticities_of(ColorSpace::srgb))
      srgb_from_image_ =
          product(inverse(xyz_from_rgb(chromaticities_of(ColorSpace::srgb))), xyz_from_rgb(from));
  }

  std::size_t size() const { return channels_[0]->floats.size(); }

  /// Returns the channel A, clamped, because noise of the filter's negative lobes may leave it
  /// outside [0, 1]; 1 without it.
  float coverage(std::size_t i) const {
    return coverage_ ? std::clamp(coverage_->floats[i], 0.0f, 1.0f) : 1.0f;
  }

  Pixel operator[](std::size_t i) const {
    Pixel out;
    const std::array<float, 3> v{channels_[0]->floats[i], channels_[1]->floats[i],
                                 channels_[2]->floats[i]};
    std::array<float, 3> rgb = v;
    if (srgb_from_image_) {
      const std::array<double, 9>& m = *srgb_from_image_;
      for (std::size_t r = 0; r < 3; ++r)
        rgb[r] = static_cast<float>(m[3 * r] * v[0] + m[3 * r + 1] * v[1] + m[3 * r + 2] * v[2]);
    }
    if (!image_.backdrop) {
      out.shapes = rgb;
      return out;
    }
    out.coverage = coverage(i);
    const auto width = static_cast<std::size_t>(image_.data_width);
    out.behind =
        under(*image_.backdrop, image_.width, image_.height, image_.x + static_cast<int>(i % width),
              image_.y + static_cast<int>(i / width));
    if (out.coverage > 0)
      for (std::size_t c = 0; c < 3; ++c)
        out.shapes[c] = (rgb[c] - (1 - out.coverage) * out.behind[c]) / out.coverage;
    return out;
  }

 private:
  const LayeredImage& image_;
  std::array<const Channel*, 3> channels_;
  const Channel* coverage_ = nullptr;
  std::optional<std::array<double, 9>> srgb_from_image_;
};

}  // namespace

Shown shown(const LayeredImage& image) {
  const Pixels pixels(image);
  double stops = image.exposure.stops;
  if (image.exposure.is_automatic) {
    ExposureMeter meter;
    meter.add(image);
    stops = meter.stops();
  }
  const auto gain = static_cast<float>(std::exp2(stops));
  Shown out{image.data_width, image.data_height, {}, {}};
  const bool is_transparent = image.backdrop && image.backdrop->kind == Backdrop::Kind::transparent;
  out.rgb.resize(pixels.size());
  if (is_transparent) out.alpha.resize(out.rgb.size());
  for (std::size_t i = 0; i < out.rgb.size(); ++i) {
    Pixels::Pixel pixel = pixels[i];
    for (float& value : pixel.shapes) value *= gain;
    const std::array<float, 3> shapes = tone_map(pixel.shapes);
    const float a = pixel.coverage;
    if (is_transparent) out.alpha[i] = a;
    for (std::size_t c = 0; c < 3; ++c)
      out.rgb[i][c] =
          is_transparent || !image.backdrop ? shapes[c] : a * shapes[c] + (1 - a) * pixel.behind[c];
  }
  return out;
}

void ExposureMeter::add(const LayeredImage& image) {
  const Pixels pixels(image);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const std::array<float, 3> light = pixels[i].shapes;
    const float peak = std::max({light[0], light[1], light[2]});
    if (!(peak > 0) || std::isinf(peak)) continue;
    const int bin = static_cast<int>(std::floor((std::log2(peak) - lowest) * bins_per_stop));
    if (bin < 0) continue;
    weights_[std::min(static_cast<std::size_t>(bin), weights_.size() - 1)] += pixels.coverage(i);
  }
}

double ExposureMeter::stops() const {
  constexpr double above = 0.05;
  double all = 0;
  for (const double weight : weights_) all += weight;
  if (!(all > 0)) return 0;
  std::size_t bin = weights_.size();
  for (double sum = 0; sum < above * all && bin > 0;) sum += weights_[--bin];
  const double light = lowest + (static_cast<double>(bin) + 0.5) / bins_per_stop;
  return std::clamp(std::log2(exposure_target) - light, -most_stops, most_stops);
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
