// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Media that vary: their values as devices have them, and bounds of these.
#pragma once

#include <vector>

#include "scene/medium.h"

namespace caplet {

/// Four floats a cell: coefficients of a sigmoid, and its scale (environment_texel).
std::vector<float> grid_spectra(const ColorGrid& grid);

/// Of CAPLET_MAJORANT_CELLS^3 cells of the medium's box, x fastest, the most that its values can be within (Pharr, Jakob and
/// Humphreys 2023, 11.4.2): of the density, or of both coefficients together at any wavelength. A cloud has one cell, and 1
/// there.
std::vector<float> medium_majorants(const UniformGridMedium& medium);
std::vector<float> medium_majorants(const RgbGridMedium& medium);
std::vector<float> medium_majorants(const CloudMedium& medium);
std::vector<float> medium_majorants(const NanovdbMedium& medium);

}  // namespace caplet
