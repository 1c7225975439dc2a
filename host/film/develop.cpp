// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/develop.h"

#include <algorithm>
#include <array>

#include "base/check.h"
#include "lower/spectrum.h"

namespace caplet {

namespace {

/// A compensated sum's value: Kahan's c is what the running sum has too much.
double total(float sum, float compensation) { return static_cast<double>(sum) - static_cast<double>(compensation); }

/// Planes of one layer, filled pixel by pixel.
class Planes {
 public:
  Planes(LayeredImage& image, std::vector<std::string> names, std::size_t pixels) : image_(image), first_(image.channels.size()) {
    for (std::string& name : names) image_.channels.push_back({std::move(name), std::vector<float>(pixels), {}});
  }
  float& operator()(std::size_t plane, std::size_t pixel) { return image_.channels[first_ + plane].floats[pixel]; }

 private:
  LayeredImage& image_;
  std::size_t first_;
};

class IdPlane {
 public:
  IdPlane(LayeredImage& image, const char* name, std::size_t pixels) : image_(image), index_(image.channels.size()) {
    image_.channels.push_back({name, {}, std::vector<std::uint32_t>(pixels)});
  }
  std::uint32_t& operator()(std::size_t pixel) { return image_.channels[index_].uints[pixel]; }

 private:
  LayeredImage& image_;
  std::size_t index_;
};

}  // namespace

LayeredImage develop(const std::vector<FilmRecord>& film, const ParamsRecord& params, const Scene& scene, bool with_variance) {
  const std::size_t pixels = static_cast<std::size_t>(params.crop_width) * params.crop_height;
  CHECK_EQ_(film.size(), pixels);
  const double exposure = scene.film.exposure_time * scene.film.iso / 100;
  const double limit = scene.film.max_component_value;
  const std::array<double, 9> m = rgb_from_xyz(scene.film.space);

  LayeredImage image;
  image.width = narrow<int>(params.width);
  image.height = narrow<int>(params.height);
  image.x = narrow<int>(params.crop_x);
  image.y = narrow<int>(params.crop_y);
  image.data_width = narrow<int>(params.crop_width);
  image.data_height = narrow<int>(params.crop_height);
  image.space = scene.film.space;
  Planes color(image, {"R", "G", "B"}, pixels), coverage(image, {"A"}, pixels), depth(image, {"Z"}, pixels);
  Planes albedo(image, {"albedo.R", "albedo.G", "albedo.B"}, pixels), normal(image, {"N.X", "N.Y", "N.Z"}, pixels);
  Planes position(image, {"P.X", "P.Y", "P.Z"}, pixels);
  Planes variance(image,
                  with_variance ? std::vector<std::string>{"variance.R", "variance.G", "variance.B"} : std::vector<std::string>{},
                  pixels);
  IdPlane object(image, "object.id", pixels), primitive(image, "primitive.id", pixels);

  for (std::size_t i = 0; i < pixels; ++i) {
    const FilmRecord& record = film[i];
    const double per_sample = record.samples > 0 ? 1.0 / record.samples : 0.0;
    const double per_hit = record.hits > 0 ? 1.0 / record.hits : 0.0;
    std::array<double, 3> xyz{}, rgb{};
    for (std::size_t c = 0; c < 3; ++c) xyz[c] = total(record.xyz[c], record.xyz_low[c]) * per_sample;
    for (std::size_t c = 0; c < 3; ++c) rgb[c] = m[3 * c] * xyz[0] + m[3 * c + 1] * xyz[1] + m[3 * c + 2] * xyz[2];
    const double peak = exposure * std::max({rgb[0], rgb[1], rgb[2]});
    const double gain = exposure * (limit > 0 && peak > limit ? limit / peak : 1.0);
    for (std::size_t c = 0; c < 3; ++c) {
      color(c, i) = static_cast<float>(gain * rgb[c]);
      albedo(c, i) = static_cast<float>(record.albedo[c] * per_sample);
      normal(c, i) = static_cast<float>(record.normal[c] * per_hit);
      position(c, i) = static_cast<float>(record.position[c] * per_hit);
      if (with_variance && record.samples > 1) {
        const double square = total(record.rgb_squared[c], record.rgb_squared_low[c]) * per_sample;
        variance(c, i) = static_cast<float>(gain * gain * std::max(0.0, square - rgb[c] * rgb[c]) / (record.samples - 1.0));
      }
    }
    coverage(0, i) = static_cast<float>(record.hits * per_sample);
    depth(0, i) = record.hits > 0 ? static_cast<float>(record.depth * per_hit) : depth_of_nothing;
    object(i) = record.object;
    primitive(i) = record.primitive;
  }
  return image;
}

}  // namespace caplet
