// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Spectra as a scene file states them. host/lower decides how they are stored on a device.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace caplet {

/// pbrt's RGB colour spaces.
enum class ColorSpace { srgb, dci_p3, rec2020, aces2065_1 };
/// Lists the names in scene files, in the order of ColorSpace.
inline constexpr std::array color_space_names = {"srgb", "dci-p3", "rec2020", "aces2065-1"};

struct ConstantSpectrum {
  double value = 0;
};
/// RGB in a colour space. The place where it is used decides whether it is a reflectance (0..1), an
/// unbounded positive quantity (eta, k) or an illuminant.
struct RgbSpectrum {
  glm::dvec3 rgb{0};
  ColorSpace space = ColorSpace::srgb;
};
/// Planck's law at `kelvin`, scaled to a maximum of 1 (as pbrt-v4).
struct BlackbodySpectrum {
  double kelvin = 6500;
};
/// Values at strictly ascending wavelengths (nm), linear between them, constant beyond the ends.
struct SampledSpectrum {
  std::vector<double> wavelengths;
  std::vector<double> values;
};

using Spectrum = std::variant<ConstantSpectrum, RgbSpectrum, BlackbodySpectrum, SampledSpectrum>;

/// Returns pbrt-v4's table for one of its names ("metal-Ag-eta", "glass-BK7", "stdillum-D65"...),
/// or one of our additions
/// ("metal-Ag-Johnson-eta", "glass-BK7-Schott", "water"...). Unknown names have no value.
std::optional<Spectrum> named_spectrum(const std::string& name);
/// Lists all names that named_spectrum knows, sorted.
std::vector<std::string> named_spectrum_names();

}  // namespace caplet
