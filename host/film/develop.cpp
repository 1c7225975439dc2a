// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/develop.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "base/check.h"
#include "base/log.h"
#include "film/mattes.h"
#include "film/replicates.h"
#include "film/under.h"
#include "lower/spectrum.h"

namespace caplet {

namespace {

using Vector = std::array<double, 3>;

Vector operator*(double factor, const Vector& v) {
  return {factor * v[0], factor * v[1], factor * v[2]};
}
Vector operator*(const std::array<double, 9>& m, const Vector& v) {
  return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
          m[6] * v[0] + m[7] * v[1] + m[8] * v[2]};
}

/// Rounds to the nearest float that is no further from 0.
float towards_zero(double value) {
  const auto rounded = static_cast<float>(value);
  return std::abs(double{rounded}) > std::abs(value) ? std::nextafter(rounded, 0.0f) : rounded;
}

/// Returns infinity beyond the range of a float.
float to_float(double value) {
  if (std::abs(value) > double{std::numeric_limits<float>::max()})
    return std::numeric_limits<float>::infinity();
  return static_cast<float>(value);
}

LayeredImage black_image(const FilmLayout& layout, ColorSpace space, Layers layers,
                         int matte_levels) {
  LayeredImage image = image_of(layout);
  image.space = space;
  const std::size_t pixels = layout.window.pixels();
  for (std::size_t i = 0; i < layer_rows.size(); ++i) {
    if (!layers.has(static_cast<Layer>(i))) continue;
    if (layer_rows[i].kind == LayerKind::slots) {
      for (int c = 0; c < channels_of(layer_rows[i], matte_levels); ++c)
        image.channels.push_back(
            {matte_channel(layer_rows[i].channels, c), std::vector<float>(pixels), {}});
      continue;
    }
    for (std::string_view names = layer_rows[i].channels; !names.empty();) {
      const std::size_t comma = std::min(names.find(','), names.size());
      Channel channel{std::string(names.substr(0, comma)), {}, {}};
      if (layer_rows[i].kind == LayerKind::id)
        channel.uints.resize(pixels);
      else
        channel.floats.resize(pixels);
      image.channels.push_back(std::move(channel));
      names.remove_prefix(std::min(comma + 1, names.size()));
    }
  }
  return image;
}

/// Develops one pixel of a film.
class Developer {
 public:
  Developer(const Film& film, const FilmSettings& settings, Layers layers)
      : film_(film),
        picture_from_xyz_(picture_from_xyz(settings)),
        rgb_from_xyz_(rgb_from_xyz(settings.space)),
        exposure_(settings.exposure_factor()) {
    if (layers.has(Layer::variance)) variances_ = variances_of_means(film, picture_from_xyz_);
  }

  void look_at(std::size_t pixel) {
    pixel_ = pixel;
    samples_ = static_cast<double>(film_.samples(pixel));
    hits_ = film_.sum(Layer::coverage, 0, pixel);
    per_sample_ = samples_ > 0 ? 1 / samples_ : 0;
    per_hit_ = hits_ > 0 ? 1 / hits_ : 0;
    rgb_ = picture_from_xyz_ * (per_sample_ * sums(Layer::color));
  }

  /// Returns the channels of a layer that is not a number.
  Vector values(Layer layer) const {
    switch (row_of(layer).how) {
      case LayerHow::picture:
        return exposure_ * rgb_;
      case LayerHow::share:
        return per_sample_ * sums(layer);
      case LayerHow::distance:
        return hits_ > 0 ? per_hit_ * sums(layer) : Vector{double{depth_of_nothing}, 0, 0};
      case LayerHow::reflectance:
        return rgb_from_xyz_ * (per_sample_ * sums(layer));
      case LayerHow::direction: {
        // Unit vectors as floats are up to 1e-7 too long, and so is their mean.
        const Vector n = per_hit_ * sums(layer);
        const double length = std::hypot(n[0], n[1], n[2]);
        return length > 1 ? Vector{towards_zero(n[0] / length), towards_zero(n[1] / length),
                                   towards_zero(n[2] / length)}
                          : n;
      }
      case LayerHow::mean:
        return per_hit_ * sums(layer);
      case LayerHow::variance:
        return exposure_ * exposure_ * variances_[pixel_];
      case LayerHow::number:
      case LayerHow::matte:
      case LayerHow::deep:
        break;
    }
    return {};
  }

 private:
  Vector sums(Layer layer) const {
    Vector out{};
    for (int c = 0; c < row_of(layer).count; ++c)
      out[static_cast<std::size_t>(c)] = film_.sum(layer, static_cast<std::size_t>(c), pixel_);
    return out;
  }

  const Film& film_;
  const std::array<double, 9> picture_from_xyz_, rgb_from_xyz_;
  const double exposure_;
  std::vector<Vector> variances_;
  std::size_t pixel_ = 0;
  double samples_ = 0, hits_ = 0, per_sample_ = 0, per_hit_ = 0;
  Vector rgb_{};
};

/// Returns what is written where a value is infinite or not a number.
float instead_of(LayerHow how) {
  return how == LayerHow::variance ? std::numeric_limits<float>::max() : 0.0f;
}

}  // namespace

void put_under(LayeredImage& image, const std::optional<Backdrop>& backdrop,
               const std::string& prefix) {
  image.backdrop = backdrop;
  if (!backdrop || backdrop->kind == Backdrop::Kind::transparent) return;
  const std::vector<float>& coverage = image.find("A")->floats;
  std::array<std::vector<float>*, 3> rgb{};
  for (Channel& channel : image.channels)
    for (const std::size_t c : {0U, 1U, 2U})
      if (channel.name == prefix + std::array{"R", "G", "B"}.at(c)) rgb.at(c) = &channel.floats;
  std::size_t pixel = 0;
  for (int y = 0; y < image.data_height; ++y)
    for (int x = 0; x < image.data_width; ++x, ++pixel) {
      if (coverage[pixel] == 1) continue;
      const std::array<float, 3> color =
          under(*backdrop, image.width, image.height, image.x + x, image.y + y, image.space);
      for (std::size_t c = 0; c < 3; ++c)
        rgb.at(c)->at(pixel) += (1 - coverage[pixel]) * color.at(c);
    }
}

LayeredImage develop(const Film& film, const FilmSettings& settings, Layers layers,
                     PictureFlaws& flaws, RowMargins margins) {
  CHECK_EQ_(film.layout().layers.has_all(layers), true);
  FilmLayout layout = film.layout();
  layout.window.y += margins.above;
  layout.window.height -= margins.above + margins.below;
  const Window& window = layout.window;
  CHECK_LE_(0, window.height);
  LayeredImage image = black_image(layout, settings.space, layers, settings.matte_levels);
  image.exposure = settings.exposure;
  Developer developer(film, settings, layers);
  const std::size_t first =
      static_cast<std::size_t>(margins.above) * static_cast<std::size_t>(window.width);
  flaws.of += window.pixels();
  if (layers.has(Layer::variance)) flaws.noise.add(film, margins.above, window.height);
  for (std::size_t pixel = 0; pixel < window.pixels(); ++pixel) {
    developer.look_at(first + pixel);
    bool all_finite = true, is_crowded = false;
    std::size_t channel = 0;
    for (std::size_t i = 0; i < layer_rows.size(); ++i) {
      const auto layer = static_cast<Layer>(i);
      const LayerRow& row = layer_rows[i];
      if (!layers.has(layer)) continue;
      if (row.kind == LayerKind::id) {
        image.channels[channel++].uints[pixel] = film.number(layer, first + pixel);
        continue;
      }
      if (row.kind == LayerKind::slots) {
        const auto count = static_cast<std::size_t>(channels_of(row, settings.matte_levels));
        if (count == 0) continue;
        const std::vector<MatteRank> ranks = matte_ranks(film, layer, first + pixel);
        for (std::size_t rank = 0; 2 * rank < count && rank < ranks.size(); ++rank) {
          image.channels[channel + 2 * rank].floats[pixel] = ranks[rank].id;
          image.channels[channel + 2 * rank + 1].floats[pixel] = ranks[rank].coverage;
        }
        channel += count;
        is_crowded |= ranks.size() == CAPLET_SLOTS && lacks_slots(film, layer, first + pixel);
        continue;
      }
      const Vector values = developer.values(layer);
      std::array<float, 3> floats{};
      std::ranges::transform(values, floats.begin(), to_float);
      const bool finite = std::ranges::all_of(floats, [](float v) { return std::isfinite(v); });
      for (std::size_t c = 0; c < static_cast<std::size_t>(row.count); ++c)
        image.channels[channel++].floats[pixel] = finite ? floats[c] : instead_of(row.how);
      all_finite &= finite;
    }
    if (is_crowded) ++flaws.crowded;
    if (all_finite || flaws.count++ > 0) continue;
    const auto width = static_cast<std::size_t>(window.width);
    flaws.x = static_cast<std::size_t>(window.x) + pixel % width;
    flaws.y = static_cast<std::size_t>(window.y) + pixel / width;
  }
  put_under(image, settings.backdrop);
  return image;
}

LayeredImage develop(const Film& film, const FilmSettings& settings, Layers layers) {
  PictureFlaws flaws;
  LayeredImage image = develop(film, settings, layers, flaws);
  flaws.warn();
  return image;
}

void PictureFlaws::warn() const {
  if (count > 0)
    log::warn(
        "{} of {} pixels are beyond the range of a float and written black (the first: {},{})",
        count, of, x, y);
  if (crowded > 0)
    log::warn("{} of {} pixels show more than {} things: their mattes lack some", crowded, of,
              CAPLET_SLOTS);
}

}  // namespace caplet
