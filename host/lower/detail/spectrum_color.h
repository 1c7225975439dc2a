// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes colour at 1 nm: the observer, the spaces' illuminants, and the colours of spectra.
#pragma once

#include <array>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/spectrum.h"
#include "shared/kinds.h"

namespace caplet {

/// The samples are at 360, 361, ... 830 nm.
using SpectrumSamples = std::array<double, CAPLET_LAMBDA_COUNT>;

/// Returns x-bar, y-bar, z-bar of the CIE 1931 observer in 1/nm, divided by the integral of y-bar.
const std::array<SpectrumSamples, 3>& normalized_observer();

/// Samples `spectrum` (not RGB) at 1 nm.
SpectrumSamples sample(const Spectrum& spectrum);

/// Returns CIE XYZ of a spectrum given at 1 nm; linear between the samples, as on the device.
glm::dvec3 xyz_of(const SpectrumSamples& samples);

/// Returns the illuminant of a colour space's white (D65; D60 for aces2065_1), of luminance 1.
const SpectrumSamples& illuminant(ColorSpace space);

/// Returns s(x) = 1/2 + x / (2 sqrt(1 + x^2)) at x = c0 l^2 + c1 l + c2, l in nm.
double sigmoid_value(const std::array<double, 3>& coefficients, double nm);

/// Returns the density of wavelength sampling at 1 nm, not normalised (docs/numerics.md).
SpectrumSamples wavelength_density();

}  // namespace caplet
