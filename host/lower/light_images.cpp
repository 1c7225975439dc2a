// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/light_images.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "base/check.h"
#include "lower/color.h"

namespace caplet {

namespace {

using std::numbers::pi;
/// The rectified image of one radiance has this many weights along each side, and no texels.
constexpr int side_without_image = 64;

void append_grey(const EnvironmentImage& image, FlatScene& out) {
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3)
    out.light_texels.push_back(
        (usable(image.rgb[i]) + usable(image.rgb[i + 1]) + usable(image.rgb[i + 2])) / 3);
}

/// Returns the mean over its texels of the value that lights use.
double mean_of(const EnvironmentImage& image, bool is_grey) {
  double sum = 0;
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3)
    sum += is_grey ? (static_cast<double>(usable(image.rgb[i])) + usable(image.rgb[i + 1]) +
                      usable(image.rgb[i + 2])) /
                         3
                   : luminance_of(&image.rgb[i], image.space);
  return sum / (static_cast<double>(image.width) * image.height);
}

/// PortalCell is the direction in the portal's space at the middle of a texel, and its solid angle
/// (Bitterli et al. 2015).
struct PortalCell {
  glm::dvec3 direction;
  double solid_angle;

  PortalCell(int x, int y, int width, int height) {
    const double alpha = pi * ((x + 0.5) / width - 0.5), beta = pi * ((y + 0.5) / height - 0.5);
    direction = glm::normalize(glm::dvec3(std::tan(alpha), std::tan(beta), 1));
    const glm::dvec3 squared = direction * direction;
    solid_angle = pi * pi * (squared.y + squared.z) * (squared.x + squared.z) / direction.z /
                  (static_cast<double>(width) * height);
  }
};

/// Appends sums of whole numbers in proportion to `weights` over all rectangles from the first
/// corner, two words each.
void append_sums(const std::vector<double>& weights, std::size_t width, std::size_t height,
                 FlatScene& out) {
  double total = 0;
  for (const double weight : weights) total += weight;
  const double unit = total > 0 ? 0x1p62 / total : 0;
  const std::size_t begin = out.light_cdf.size();
  out.light_cdf.resize(begin + 2 * (width + 1) * (height + 1));
  std::vector<std::uint64_t> above(width + 1, 0);
  const auto put = [&](std::size_t x, std::size_t y, std::uint64_t sum) {
    float* const at = &out.light_cdf[begin + 2 * (y * (width + 1) + x)];
    at[0] = std::bit_cast<float>(static_cast<std::uint32_t>(sum));
    at[1] = std::bit_cast<float>(static_cast<std::uint32_t>(sum >> 32));
  };
  for (std::size_t x = 0; x <= width; ++x) put(x, 0, 0);
  for (std::size_t y = 0; y < height; ++y) {
    std::uint64_t row = 0;
    put(0, y + 1, 0);
    for (std::size_t x = 0; x < width; ++x) {
      const double weight = weights[y * width + x];
      if (weight > 0) row += std::max<std::uint64_t>(1, static_cast<std::uint64_t>(weight * unit));
      above[x + 1] += row;
      put(x + 1, y + 1, above[x + 1]);
    }
  }
}

/// Lowers the image as the portal shows it: each of its texels has the sky's radiance at its
/// middle, as in pbrt-v4.
void lower_portal(const InfiniteLight& light, const glm::dmat3& image_from_portal,
                  LoweredPicture& picture, FlatScene& out) {
  const int height = light.image ? light.image->height : side_without_image, width = height;
  picture.field[2] = picture.field[3] = narrow<std::uint32_t>(height);
  picture.field[4] = light.image ? 0 : 1;
  EnvironmentImage rectified{
      width, height, {}, light.image ? light.image->space : ColorSpace::srgb, false};
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  std::vector<double> weights(columns * rows), facing(rows, 0), all(rows, 0);
  if (light.image) rectified.rgb.resize(3 * weights.size());
  tbb::parallel_for(std::size_t{0}, rows, [&](std::size_t y) {
    for (std::size_t x = 0; x < columns; ++x) {
      const PortalCell cell(static_cast<int>(x), static_cast<int>(y), width, height);
      double luminance = 1;
      if (light.image) {
        float* const to = &rectified.rgb[3 * (y * columns + x)];
        const glm::dvec3 rgb = sky_rgb(*light.image, image_from_portal * cell.direction);
        for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(rgb[k]);
        luminance = luminance_of(to, light.image->space);
      }
      weights[y * columns + x] = luminance * cell.solid_angle;
      all[y] += weights[y * columns + x];
      facing[y] += weights[y * columns + x] * cell.direction.z;
    }
  });
  for (std::size_t y = 0; y < rows; ++y) {
    picture.integrals.luminance += all[y];
    picture.integrals.illuminance += facing[y];
  }
  if (light.image) append_texels(rectified, out);
  append_sums(weights, columns, rows, out);
}

}  // namespace

glm::dmat3 portal_from_world(const LightPortal& portal) {
  const glm::dvec3 x = glm::normalize(portal[3] - portal[0]);
  glm::dvec3 y = portal[1] - portal[0];
  y = glm::normalize(y - glm::dot(x, y) * x);
  return glm::transpose(glm::dmat3(x, y, glm::cross(x, y)));
}

void LightImages::begin() {
  asked_ = 0;
  has_changed_ = false;
}

void LightImages::end(FlatScene& out) {
  if (asked_ == entries_.size()) return;
  out.light_texels.resize(entries_[asked_].texels_begin);
  out.light_cdf.resize(entries_[asked_].cdf_begin);
  entries_.resize(asked_);
  has_changed_ = true;
}

template <class Make>
const LoweredPicture& LightImages::find(Use use, const std::shared_ptr<const void>& of,
                                        const glm::dmat3& turn, FlatScene& out, Make&& make) {
  const auto is_it = [&](const Entry& entry) {
    return entry.use == use && entry.of == of && entry.turn == turn;
  };
  const auto asked = entries_.begin() + static_cast<std::ptrdiff_t>(asked_);
  if (const auto found = std::find_if(entries_.begin(), asked, is_it); found != asked)
    return found->picture;
  if (asked_ == entries_.size() || !is_it(*asked)) {
    end(out);
    Entry& fresh = entries_.emplace_back(
        Entry{use, of, turn, {}, out.light_texels.size(), out.light_cdf.size()});
    fresh.picture.field[0] = narrow<std::uint32_t>(out.light_texels.size());
    fresh.picture.field[1] = narrow<std::uint32_t>(out.light_cdf.size());
    make(fresh.picture);
    // Indices of floats have 32 bits.
    if (std::max(out.light_texels.size(), out.light_cdf.size()) > 0xffffffffu)
      throw InputError("the images of lights have more texels than 32 bits number");
    has_changed_ = true;
  }
  return entries_[asked_++].picture;
}

const LoweredPicture& LightImages::sky(const std::shared_ptr<const EnvironmentImage>& image,
                                       FlatScene& out) {
  return find(Use::sky, image, glm::dmat3(1), out, [&](LoweredPicture& picture) {
    picture.field[2] = narrow<std::uint32_t>(image->width);
    picture.field[3] = narrow<std::uint32_t>(image->height);
    picture.field[4] = image->equal_area ? 1 : 0;
    picture.integrals = lower_environment(*image, out);
  });
}

const LoweredPicture& LightImages::picture(const LightPicture& of, FlatScene& out) {
  return find(of.is_grey ? Use::grey : Use::color, of.image, glm::dmat3(1), out,
              [&](LoweredPicture& picture) {
                picture.field[2] = narrow<std::uint32_t>(of.image->width);
                picture.field[3] = narrow<std::uint32_t>(of.image->height);
                picture.mean = mean_of(*of.image, of.is_grey);
                of.is_grey ? append_grey(*of.image, out) : append_texels(*of.image, out);
              });
}

const LoweredPicture& LightImages::profile(const std::shared_ptr<const IesProfile>& profile,
                                           FlatScene& out) {
  return find(Use::profile, profile, glm::dmat3(1), out, [&](LoweredPicture& picture) {
    picture.field[2] = narrow<std::uint32_t>(profile->azimuths.size());
    picture.field[3] = narrow<std::uint32_t>(profile->polar.size());
    for (const auto* values : {&profile->polar, &profile->azimuths, &profile->candela})
      for (const double value : *values) out.light_texels.push_back(static_cast<float>(value));
  });
}

const LoweredPicture& LightImages::portal(const InfiniteLight& light, FlatScene& out) {
  // A rotation's inverse is its transpose.
  const glm::dmat3 turn =
      light.image ? glm::transpose(portal_from_world(*light.portal) * light.world_from_light)
                  : glm::dmat3(1);
  return find(Use::portal, light.image, turn, out,
              [&](LoweredPicture& picture) { lower_portal(light, turn, picture, out); });
}

}  // namespace caplet
