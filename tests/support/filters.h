// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// pbrt-v4's reconstruction filters (src/pbrt/filters.h), integrated by hand.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/scene.h"

namespace caplet::test {

/// Integral from 0 to t, 0 <= t <= 2, of the filter of Mitchell and Netravali 1988; 1/2 at 2
/// whatever b and c are.
inline double mitchell_integral(double t, double b, double c) {
  const double u = std::min(t, 1.0);
  double sum = ((12 - 9 * b - 6 * c) * std::pow(u, 4) / 4 +
                (-18 + 12 * b + 6 * c) * std::pow(u, 3) / 3 + (6 - 2 * b) * u) /
               6;
  const auto outer = [&](double v) {
    return ((-b - 6 * c) * std::pow(v, 4) / 4 + (6 * b + 30 * c) * std::pow(v, 3) / 3 +
            (-12 * b - 48 * c) * v * v / 2 + (8 * b + 24 * c) * v) /
           6;
  };
  if (t > 1) sum += outer(std::min(t, 2.0)) - outer(1);
  return sum;
}

/// Returns the integral of sinc(x) sinc(x / tau) from 0 to x, by Simpson's rule: sinc(x) = sin(pi
/// x) / (pi x).
inline double windowed_sinc_integral(double x, double tau) {
  const auto sinc = [](double t) {
    return t == 0 ? 1 : std::sin(std::numbers::pi * t) / (std::numbers::pi * t);
  };
  constexpr int steps = 2000;
  double sum = 0;
  for (int i = 0; i <= steps; ++i) {
    const double t = x * i / steps;
    sum += (i == 0 || i == steps ? 1 : i % 2 ? 4 : 2) * sinc(t) * sinc(t / tau);
  }
  return sum * x / (3 * steps);
}

/// The part of a filter's integral along one axis that lies below `x` (pixels from the centre): the
/// response to a step. Not within 0..1 where the filter is negative.
inline double filter_share(const PixelFilter& filter, double x, double radius) {
  const double d = std::clamp(x, -radius, radius), size = std::abs(d);
  const auto from_half = [&](double integral, double half) {
    return 0.5 + std::copysign(0.5 * integral / half, d);
  };
  switch (filter.kind) {
    case PixelFilter::Kind::box:
      return (d + radius) / (2 * radius);
    case PixelFilter::Kind::triangle:  // radius - |x|
      return from_half(radius * size - size * size / 2, radius * radius / 2);
    case PixelFilter::Kind::gaussian: {  // exp(-x^2 / 2 sigma^2) - exp(-radius^2 / 2 sigma^2)
      const double s = filter.sigma * std::numbers::sqrt2;
      const auto integral = [&](double t) {
        return filter.sigma * std::sqrt(std::numbers::pi / 2) * std::erf(t / s) -
               t * std::exp(-radius * radius / (s * s));
      };
      return from_half(integral(size), integral(radius));
    }
    case PixelFilter::Kind::mitchell:  // stretched to the radius
      return from_half(mitchell_integral(2 * size / radius, filter.b, filter.c), 0.5);
    case PixelFilter::Kind::sinc:
      return from_half(windowed_sinc_integral(size, filter.tau),
                       windowed_sinc_integral(radius, filter.tau));
  }
  return 0;
}

}  // namespace caplet::test
