// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/environment.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/check.h"
#include "lower/spectrum.h"
#include "shared/octahedron.h"

namespace caplet {

namespace {

using std::numbers::pi;

/// Luminances holds luminances of the texels, with the neighbours that bilinear interpolation uses
/// beyond the edges.
class Luminances {
 public:
  explicit Luminances(const EnvironmentImage& image)
      : width_(image.width),
        height_(image.height),
        square_(image.equal_area),
        values_(image.rgb.size() / 3) {
    const std::array<double, 9> xyz = xyz_from_rgb(image.space);
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, values_.size(), 4096),
        [&](const tbb::blocked_range<std::size_t>& r) {
          for (std::size_t i = r.begin(); i < r.end(); ++i) {
            const float* rgb = &image.rgb[3 * i];
            values_[i] = static_cast<float>(std::min(
                xyz[3] * usable(rgb[0]) + xyz[4] * usable(rgb[1]) + xyz[5] * usable(rgb[2]), 3e38));
          }
        });
  }

  double at(int x, int y) const {
    if (square_) {
      fold_over_edges(&x, &y, width_, height_);
    } else {
      x = (x + width_) % width_;
      y = std::clamp(y, 0, height_ - 1);
    }
    return values_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(x)];
  }

  /// Returns the mean over the texel's cell of the bilinear interpolation: 1/8, 6/8, 1/8 of the
  /// neighbours along each axis.
  double cell_mean(int x, int y) const {
    const auto row = [&](int r) { return at(x - 1, r) + 6 * at(x, r) + at(x + 1, r); };
    return (row(y - 1) + 6 * row(y) + row(y + 1)) / 64;
  }

 private:
  int width_, height_;
  bool square_;
  std::vector<float> values_;
};

/// Computes running sums of `weights`, 0 to 1, as floats; zeros when there is nothing to sum.
/// Returns the sum.
double running_sum(const std::vector<double>& weights, float* cdf) {
  double total = 0;
  for (const double w : weights) total += w;
  double sum = 0;
  cdf[0] = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i];
    cdf[i + 1] = total > 0 ? static_cast<float>(std::min(sum / total, 1.0)) : 0.f;
  }
  // The last cell with a weight ends at 1 exactly, and those after it have no width.
  for (std::size_t i = weights.size(); total > 0 && i > 0; --i) {
    cdf[i] = 1;
    if (weights[i - 1] > 0) break;
  }
  return total;
}

}  // namespace

float usable(float x) {
  if (!(x > 0)) return 0;
  return std::min(x, std::numeric_limits<float>::max());
}

double luminance_of(const float* rgb, ColorSpace space) {
  const std::array<double, 9> xyz = xyz_from_rgb(space);
  return xyz[3] * usable(rgb[0]) + xyz[4] * usable(rgb[1]) + xyz[5] * usable(rgb[2]);
}

glm::dvec3 environment_direction(bool equal_area, double u, double v) {
  if (!equal_area) {
    const double theta = pi * v, phi = 2 * pi * u;
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  }
  return sphere_from_square({u, v});
}

void append_texels(const EnvironmentImage& image, FlatScene& out) {
  const std::size_t count = image.rgb.size() / 3, begin = out.light_texels.size();
  CHECK_EQ_(image.rgb.size(),
            3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  out.light_texels.resize(begin + 4 * count);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1024),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        const float* rgb = &image.rgb[3 * i];
                        const std::array<float, 4> texel = environment_texel(
                            glm::dvec3(usable(rgb[0]), usable(rgb[1]), usable(rgb[2])),
                            image.space);
                        std::copy(texel.begin(), texel.end(), &out.light_texels[begin + 4 * i]);
                      }
                    });
}

glm::dvec3 sky_rgb(const EnvironmentImage& image, const glm::dvec3& d) {
  double u, v;
  if (image.equal_area) {
    const glm::dvec2 uv = square_from_sphere(d);
    u = uv.x;
    v = uv.y;
  } else {
    u = std::atan2(d.y, d.x) / (2 * pi);
    if (u < 0) u += 1;
    v = std::atan2(std::hypot(d.x, d.y), d.z) / pi;
  }
  const double x = u * image.width - 0.5, y = v * image.height - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  glm::dvec3 sum(0);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      int column = x0 + i, row = y0 + j;
      if (image.equal_area) {
        fold_over_edges(&column, &row, image.width, image.height);
      } else {
        column = (column + image.width) % image.width;
        row = std::clamp(row, 0, image.height - 1);
      }
      const float* rgb =
          &image.rgb[3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                          static_cast<std::size_t>(column))];
      const double weight = (i == 0 ? 1 - (x - x0) : x - x0) * (j == 0 ? 1 - (y - y0) : y - y0);
      sum += weight * glm::dvec3(usable(rgb[0]), usable(rgb[1]), usable(rgb[2]));
    }
  return sum;
}

EnvironmentIntegrals lower_environment(const EnvironmentImage& image, FlatScene& out) {
  const auto width = static_cast<std::size_t>(image.width),
             height = static_cast<std::size_t>(image.height);
  append_texels(image, out);
  const std::size_t begin = out.light_cdf.size();
  out.light_cdf.resize(begin + (height + 1) + height * (width + 1));

  const Luminances luminances(image);
  std::vector<double> rows(height), facing(height);
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, height),
      [&](const tbb::blocked_range<std::size_t>& range) {
        std::vector<double> weights(width);
        for (std::size_t y = range.begin(); y < range.end(); ++y) {
          // `cell` is the solid angle of a cell of this row.
          const double top = pi * static_cast<double>(y) / static_cast<double>(height);
          const double bottom = pi * static_cast<double>(y + 1) / static_cast<double>(height);
          const double cell = image.equal_area ? 4 * pi / static_cast<double>(width * height)
                                               : (std::cos(top) - std::cos(bottom)) * 2 * pi /
                                                     static_cast<double>(width);
          facing[y] = 0;
          for (std::size_t x = 0; x < width; ++x) {
            weights[x] = cell * luminances.cell_mean(static_cast<int>(x), static_cast<int>(y));
            const glm::dvec3 d = environment_direction(
                image.equal_area, (static_cast<double>(x) + 0.5) / static_cast<double>(width),
                (static_cast<double>(y) + 0.5) / static_cast<double>(height));
            facing[y] += weights[x] * std::max(0.0, d.z);
          }
          rows[y] = running_sum(weights, &out.light_cdf[begin + (height + 1) + y * (width + 1)]);
        }
      });
  EnvironmentIntegrals integrals;
  integrals.luminance = running_sum(rows, out.light_cdf.data() + begin);
  for (const double row : facing) integrals.illuminance += row;
  return integrals;
}

}  // namespace caplet
