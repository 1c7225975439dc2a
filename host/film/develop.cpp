// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/develop.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/log.h"
#include "lower/spectrum.h"

namespace caplet {

namespace {

/// A compensated sum's value: Kahan's c is what the running sum has too much.
double total(float sum, float compensation) { return static_cast<double>(sum) - static_cast<double>(compensation); }

using Vector = std::array<double, 3>;

Vector total(const float (&sums)[3], const float (&compensations)[3]) {
  return {total(sums[0], compensations[0]), total(sums[1], compensations[1]), total(sums[2], compensations[2])};
}

Vector operator*(double factor, const Vector& v) { return {factor * v[0], factor * v[1], factor * v[2]}; }
Vector operator*(const std::array<double, 9>& m, const Vector& v) {
  return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
          m[6] * v[0] + m[7] * v[1] + m[8] * v[2]};
}

/// Rounded to the float that is no further from 0.
float towards_zero(double value) {
  const auto rounded = static_cast<float>(value);
  return std::abs(double{rounded}) > std::abs(value) ? std::nextafter(rounded, 0.0f) : rounded;
}

/// Channels of one layer (none where it is not wanted), filled pixel by pixel.
class Planes {
 public:
  Planes(LayeredImage& image, bool wanted, std::vector<std::string> names, std::size_t pixels)
      : image_(image), first_(image.channels.size()), wanted_(wanted) {
    if (!wanted) return;
    for (std::string& name : names) image_.channels.push_back({std::move(name), std::vector<float>(pixels), {}});
  }
  explicit operator bool() const { return wanted_; }

  /// When a value is infinite or NaN as a float: puts `instead` into all of the planes and returns false.
  bool set(std::size_t pixel, const Vector& values, float instead = 0) const {
    std::array<float, 3> floats{};
    std::ranges::transform(values, floats.begin(), to_float);
    const bool finite = std::ranges::all_of(floats, [](float v) { return std::isfinite(v); });
    if (wanted_)
      for (std::size_t k = 0; k < 3; ++k) plane(k)[pixel] = finite ? floats[k] : instead;
    return finite || !wanted_;
  }
  bool set(std::size_t pixel, double value) const {
    if (!wanted_) return true;
    const float rounded = to_float(value);
    plane(0)[pixel] = std::isfinite(rounded) ? rounded : 0.0f;
    return std::isfinite(rounded);
  }

 private:
  static float to_float(double value) {
    if (std::abs(value) > double{std::numeric_limits<float>::max()}) return std::numeric_limits<float>::infinity();
    return static_cast<float>(value);
  }
  std::vector<float>& plane(std::size_t k) const { return image_.channels[first_ + k].floats; }

  LayeredImage& image_;
  std::size_t first_;
  bool wanted_;
};

class IdPlane {
 public:
  IdPlane(LayeredImage& image, bool wanted, const char* name, std::size_t pixels)
      : image_(image), index_(image.channels.size()), wanted_(wanted) {
    if (wanted_) image_.channels.push_back({name, {}, std::vector<std::uint32_t>(pixels)});
  }
  void set(std::size_t pixel, std::uint32_t id) const {
    if (wanted_) image_.channels[index_].uints[pixel] = id;
  }

 private:
  LayeredImage& image_;
  std::size_t index_;
  bool wanted_;
};

LayeredImage window_of(const ParamsRecord& params, ColorSpace space) {
  LayeredImage image;
  image.width = narrow<int>(params.width);
  image.height = narrow<int>(params.height);
  image.x = narrow<int>(params.crop_x);
  image.y = narrow<int>(params.crop_y);
  image.data_width = narrow<int>(params.crop_width);
  image.data_height = narrow<int>(params.crop_height);
  image.space = space;
  return image;
}

}  // namespace

LayeredImage develop(const std::vector<FilmRecord>& film, const ParamsRecord& params, const Scene& scene, Layers layers,
                     NotFinite& not_finite) {
  const std::size_t pixels = static_cast<std::size_t>(params.crop_width) * params.crop_height;
  CHECK_EQ_(film.size(), pixels);
  const double exposure = scene.film.exposure_time * scene.film.iso / 100;
  const double limit = scene.film.max_component_value;
  const std::array<double, 9> m = rgb_from_xyz(scene.film.space);

  LayeredImage image = window_of(params, scene.film.space);
  const Planes color(image, true, {"R", "G", "B"}, pixels), coverage(image, true, {"A"}, pixels);
  const Planes depth(image, layers.has(Layer::depth), {"Z"}, pixels);
  const Planes albedo(image, layers.has(Layer::albedo), {"albedo.R", "albedo.G", "albedo.B"}, pixels);
  const Planes normal(image, layers.has(Layer::normal), {"N.X", "N.Y", "N.Z"}, pixels);
  const Planes position(image, layers.has(Layer::position), {"P.X", "P.Y", "P.Z"}, pixels);
  const Planes variance(image, layers.has(Layer::variance), {"variance.R", "variance.G", "variance.B"}, pixels);
  const IdPlane object(image, layers.has(Layer::object), "object.id", pixels);
  const IdPlane primitive(image, layers.has(Layer::primitive), "primitive.id", pixels);

  not_finite.of += pixels;
  for (std::size_t i = 0; i < pixels; ++i) {
    const FilmRecord& record = film[i];
    const double per_sample = record.samples > 0 ? 1.0 / record.samples : 0.0;
    const double per_hit = record.hits > 0 ? 1.0 / record.hits : 0.0;
    const Vector rgb = m * (per_sample * total(record.xyz, record.xyz_low));
    const double peak = exposure * std::max({rgb[0], rgb[1], rgb[2]});
    const double gain = exposure * (limit > 0 && peak > limit ? limit / peak : 1.0);
    bool finite = color.set(i, gain * rgb);
    finite &= coverage.set(i, record.hits * per_sample);
    finite &= depth.set(i, record.hits > 0 ? total(record.depth, record.depth_low) * per_hit : double{depth_of_nothing});
    finite &= albedo.set(i, m * (per_sample * total(record.albedo, record.albedo_low)));
    finite &= position.set(i, per_hit * total(record.position, record.position_low));
    // Unit vectors as floats are up to 1e-7 too long, and so is their mean.
    const Vector n = per_hit * total(record.normal, record.normal_low);
    const double length = std::hypot(n[0], n[1], n[2]);
    finite &= normal.set(
        i, length > 1 ? Vector{towards_zero(n[0] / length), towards_zero(n[1] / length), towards_zero(n[2] / length)} : n);
    if (variance && record.samples > 1) {
      const Vector square = per_sample * total(record.rgb_squared, record.rgb_squared_low);
      Vector of_mean{};
      for (std::size_t c = 0; c < 3; ++c) {
        const double spread = square[c] - rgb[c] * rgb[c];
        of_mean[c] = gain * gain * (spread < 0 ? 0.0 : spread) / (record.samples - 1.0);  // NaN stays NaN
      }
      finite &= variance.set(i, of_mean, std::numeric_limits<float>::max());
    }
    object.set(i, record.object);
    primitive.set(i, record.primitive);
    if (!finite && not_finite.count++ == 0) {
      not_finite.x = params.crop_x + i % params.crop_width;
      not_finite.y = params.crop_y + i / params.crop_width;
    }
  }
  return image;
}

LayeredImage develop(const std::vector<FilmRecord>& film, const ParamsRecord& params, const Scene& scene, Layers layers) {
  NotFinite not_finite;
  LayeredImage image = develop(film, params, scene, layers, not_finite);
  not_finite.warn();
  return image;
}

void NotFinite::warn() const {
  if (count > 0)
    log::warn("{} of {} pixels are beyond the range of a float and written black (the first: {},{})", count, of, x, y);
}

}  // namespace caplet
