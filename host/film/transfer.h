// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is the sRGB transfer function (IEC 61966-2-1:1999).
#pragma once

#include <cmath>

namespace caplet {

inline float linear_from_srgb(float v) {
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}
inline float srgb_from_linear(float v) {
  return v <= 0.0031308f ? v * 12.92f : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

/// Returns a value of a file made linear by a power; an exponent of 1 leaves it, and 0 stands for
/// the sRGB curve.
inline float linear_from(float v, float exponent) {
  if (exponent == 1) return v;
  return exponent == 0 ? linear_from_srgb(v) : std::copysign(std::pow(std::abs(v), exponent), v);
}

}  // namespace caplet
