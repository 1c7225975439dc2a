// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/under.h"

#include <algorithm>
#include <cmath>

namespace caplet {

namespace {

std::array<float, 3> of_image(const EnvironmentImage& image, int width, int height, int x, int y) {
  // The image is scaled so that it just covers the film.
  const double texels = std::min(static_cast<double>(image.width) / width,
                                 static_cast<double>(image.height) / height);
  const double left = 0.5 * (image.width - texels * width),
               top = 0.5 * (image.height - texels * height);
  // The sample is the middle of the pixel, or of each of its parts no larger than a texel.
  const int parts = static_cast<int>(std::clamp(std::ceil(texels), 1.0, 16.0));
  std::array<double, 3> sum{};
  for (int part = 0; part < parts * parts; ++part) {
    const double fx = left + texels * (x + (part % parts + 0.5) / parts) - 0.5;
    const double fy = top + texels * (y + (part / parts + 0.5) / parts) - 0.5;
    const double x0 = std::floor(fx), y0 = std::floor(fy);
    for (const int dy : {0, 1})
      for (const int dx : {0, 1}) {
        const double weight = (dx ? fx - x0 : 1 - fx + x0) * (dy ? fy - y0 : 1 - fy + y0);
        const auto column =
            static_cast<std::size_t>(std::clamp(static_cast<int>(x0) + dx, 0, image.width - 1));
        const auto row =
            static_cast<std::size_t>(std::clamp(static_cast<int>(y0) + dy, 0, image.height - 1));
        for (std::size_t c = 0; c < 3; ++c)
          sum[c] +=
              weight *
              double{image.rgb[3 * (row * static_cast<std::size_t>(image.width) + column) + c]};
      }
  }
  std::array<float, 3> out{};
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = static_cast<float>(std::clamp(sum[c] / (parts * parts), 0.0, 1.0));
  return out;
}

}  // namespace

std::array<float, 3> under(const Backdrop& backdrop, int width, int height, int x, int y) {
  switch (backdrop.kind) {
    case Backdrop::Kind::transparent:
      break;
    case Backdrop::Kind::color:
      return {static_cast<float>(backdrop.color.x), static_cast<float>(backdrop.color.y),
              static_cast<float>(backdrop.color.z)};
    case Backdrop::Kind::image:
      return of_image(*backdrop.image, width, height, x, y);
  }
  return {};
}

std::array<float, 3> under(const Backdrop& backdrop, int width, int height, int x, int y,
                           ColorSpace space) {
  const std::array<float, 3> srgb = under(backdrop, width, height, x, y);
  if (space == ColorSpace::srgb) return srgb;
  const std::array<double, 9> m = product(inverse(xyz_from_rgb(chromaticities_of(space))),
                                          xyz_from_rgb(chromaticities_of(ColorSpace::srgb)));
  std::array<float, 3> out{};
  for (std::size_t r = 0; r < 3; ++r)
    out[r] = static_cast<float>(m[3 * r] * double{srgb[0]} + m[3 * r + 1] * double{srgb[1]} +
                                m[3 * r + 2] * double{srgb[2]});
  return out;
}

}  // namespace caplet
