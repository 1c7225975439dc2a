// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/chromaticities.h"

#include <cmath>

#include "base/error.h"

namespace caplet {

namespace {

constexpr std::array<double, 2> d65{0.3127, 0.3290};

bool near(const std::array<double, 2>& a, const std::array<double, 2>& b) {
  return std::abs(a[0] - b[0]) < 1e-3 && std::abs(a[1] - b[1]) < 1e-3;
}

std::array<double, 3> apply(const std::array<double, 9>& m, const std::array<double, 3>& v) {
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
  return out;
}

}  // namespace

Chromaticities chromaticities_of(ColorSpace space) {
  switch (space) {
    case ColorSpace::srgb:
      return {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, d65};
    case ColorSpace::dci_p3:
      return {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, d65};
    case ColorSpace::rec2020:
      return {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, d65};
    case ColorSpace::aces2065_1:
      return {{0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}, {0.32168, 0.33767}};
  }
  throw std::logic_error("unknown colour space");
}

std::optional<ColorSpace> color_space_of(const Chromaticities& c) {
  for (const ColorSpace space :
       {ColorSpace::srgb, ColorSpace::dci_p3, ColorSpace::rec2020, ColorSpace::aces2065_1}) {
    const Chromaticities known = chromaticities_of(space);
    if (near(c.red, known.red) && near(c.green, known.green) && near(c.blue, known.blue) &&
        near(c.white, known.white))
      return space;
  }
  return std::nullopt;
}

std::array<double, 9> inverse(const std::array<double, 9>& m) {
  const auto minor = [&](std::size_t r, std::size_t c) {
    const std::size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return m[3 * r1 + c1] * m[3 * r2 + c2] - m[3 * r1 + c2] * m[3 * r2 + c1];
  };
  const double determinant = m[0] * minor(0, 0) + m[1] * minor(0, 1) + m[2] * minor(0, 2);
  if (!(std::abs(determinant) > 1e-12))
    throw InputError("chromaticities that span no colour space");
  std::array<double, 9> out{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) out[3 * r + c] = minor(c, r) / determinant;
  return out;
}

std::array<double, 9> product(const std::array<double, 9>& a, const std::array<double, 9>& b) {
  std::array<double, 9> out{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < 3; ++k) out[3 * r + c] += a[3 * r + k] * b[3 * k + c];
  return out;
}

std::array<double, 9> xyz_from_rgb(const Chromaticities& c) {
  const std::array<double, 9> primaries{c.red[0],
                                        c.green[0],
                                        c.blue[0],
                                        c.red[1],
                                        c.green[1],
                                        c.blue[1],
                                        1 - c.red[0] - c.red[1],
                                        1 - c.green[0] - c.green[1],
                                        1 - c.blue[0] - c.blue[1]};
  if (!(c.white[1] > 0)) throw InputError("chromaticities with a white point of no luminance");
  const std::array<double, 3> white{c.white[0] / c.white[1], 1,
                                    (1 - c.white[0] - c.white[1]) / c.white[1]};
  const std::array<double, 3> scale = caplet::apply(inverse(primaries), white);
  std::array<double, 9> out = primaries;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t k = 0; k < 3; ++k) out[3 * r + k] *= scale[k];
  return out;
}

}  // namespace caplet
