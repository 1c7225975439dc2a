// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Spectra as a scene file states them; what they become on a device is decided in host/lower.
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
/// Names in scene files, by ColorSpace.
inline constexpr std::array color_space_names = {"srgb", "dci-p3", "rec2020", "aces2065-1"};

struct ConstantSpectrum {
  double value = 0;
};
/// RGB in a colour space. Whether it is a reflectance (0..1), an unbounded positive quantity (eta, k) or an illuminant follows
/// from where it is used.
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

/// The spectrum behind one of pbrt-v4's names ("metal-Ag-eta", "glass-BK7", "stdillum-D65"...), which is pbrt-v4's own table, or
/// of our additions ("metal-Ag-Johnson-eta", "glass-BK7-Schott", "water"...); no value if unknown.
std::optional<Spectrum> named_spectrum(const std::string& name);
/// All names that named_spectrum knows, sorted.
std::vector<std::string> named_spectrum_names();

}  // namespace caplet
