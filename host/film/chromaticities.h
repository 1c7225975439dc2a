// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds chromaticities of the RGB colour spaces, as EXR files state them.
#pragma once

#include <array>
#include <optional>

#include "scene/spectrum.h"

namespace caplet {

/// These are CIE 1931 xy of the primaries and of white.
struct Chromaticities {
  std::array<double, 2> red, green, blue, white;
  bool operator==(const Chromaticities&) const = default;
};

/// Returns ITU-R BT.709 (sRGB), DCI-P3 primaries with the D65 white (as pbrt-v4), ITU-R BT.2020, or
/// SMPTE ST 2065-1 (ACES).
Chromaticities chromaticities_of(ColorSpace space);

/// Returns the space whose chromaticities these are, to within 1e-3 (files round them to three
/// digits); no value when there is none.
std::optional<ColorSpace> color_space_of(const Chromaticities& chromaticities);

/// Returns 3x3 row-major XYZ from linear RGB: the columns are the primaries, scaled so that RGB (1,
/// 1, 1) is the white of luminance 1 (SMPTE RP 177-1993). Throws InputError when the primaries lie
/// on a line or a white has y = 0.
std::array<double, 9> xyz_from_rgb(const Chromaticities& chromaticities);

/// Returns the 3x3 row-major inverse. Throws InputError when singular.
std::array<double, 9> inverse(const std::array<double, 9>& m);
std::array<double, 9> product(const std::array<double, 9>& a, const std::array<double, 9>& b);

}  // namespace caplet
