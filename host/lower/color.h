// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Evaluates spectra and colours (spectrum_color.cpp, spectrum_uplift.cpp).
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "scene/scene.h"
#include "scene/spectrum.h"

namespace caplet {

/// Returns true when the value does not depend on wavelength (for the dispersive flag).
bool is_constant(const Spectrum& spectrum);

/// Returns the value at `nm` of a spectrum that is not RGB.
double evaluate(const Spectrum& spectrum, double nm);

/// Returns the four floats of an environment texel (sigmoid coefficients and scale) for linear RGB
/// >= 0. It is fast enough for millions of texels (a table of exact solutions built on first use,
/// interpolated).
std::array<float, 4> environment_texel(const glm::dvec3& rgb, ColorSpace space);

/// These are 3x3 row-major, linear RGB of `space` from XYZ and back.
std::array<double, 9> rgb_from_xyz(ColorSpace space);
std::array<double, 9> xyz_from_rgb(ColorSpace space);

/// Returns the same for a film's picture: with its white balance, by von Kries' rule in the space
/// of Bradford's cones (as pbrt-v4). The balanced white is that of CIE daylight of that
/// temperature, below 4000 K that of a black body.
std::array<double, 9> picture_from_xyz(const FilmSettings& film);

}  // namespace caplet
