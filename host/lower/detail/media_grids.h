// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts the values of media that vary to the form of devices, and bounds them.
#pragma once

#include <vector>

#include "scene/medium.h"

namespace caplet {

/// Returns four floats a cell: coefficients of a sigmoid, and its scale (environment_texel).
std::vector<float> grid_spectra(const ColorGrid& grid);

/// Returns for CAPLET_MAJORANT_CELLS^3 cells of the medium's box, x fastest, the greatest value
/// within each (Pharr, Jakob and Humphreys 2023, 11.4.2): of the density, or of both coefficients
/// together at any wavelength. A cloud has one cell, and 1 there.
std::vector<float> medium_majorants(const UniformGridMedium& medium);
std::vector<float> medium_majorants(const RgbGridMedium& medium);
std::vector<float> medium_majorants(const CloudMedium& medium);
std::vector<float> medium_majorants(const NanovdbMedium& medium);

}  // namespace caplet
