// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts spectra of the scene to SpectrumRecord and tables.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <map>
#include <tuple>
#include <vector>

#include "lower/color.h"
#include "lower/flat_scene.h"
#include "scene/spectrum.h"

namespace caplet {

/// Appends spectra to a FlatScene, each distinct one once.
class SpectrumTable {
 public:
  /// Fills also observer, wavelength_table, and the space's illuminant table
  /// (world.illuminant_table). `space` is the film's.
  SpectrumTable(FlatScene& out, ColorSpace space);

  /// Returns the index into FlatScene::spectra. RGB is uplifted by a sigmoid polynomial; values are
  /// clamped to [0, 1].
  std::uint32_t add_reflectance(const Spectrum& spectrum);
  /// Adds eta or k: RGB is scaled to a sigmoid times twice its maximum (as pbrt-v4's
  /// RGBUnboundedSpectrum).
  std::uint32_t add_unbounded(const Spectrum& spectrum);
  /// Adds a spectrum with this number at every wavelength.
  std::uint32_t add_number(double value);
  /// Adds the k at which a metal of eta = 1 reflects `reflectance` (as add_reflectance takes it) at
  /// normal incidence, wavelength by wavelength: r = k^2 / (4 + k^2), so k = 2 sqrt(r / (1 - r)); r
  /// is at most 0.9999 (as pbrt-v4's ConductorMaterial).
  std::uint32_t add_extinction(const Spectrum& reflectance);
  /// Adds a spectrum of emission. RGB becomes a sigmoid times twice the maximum times the
  /// illuminant, so that rgb (1 1 1) seen directly is pixel (1 1 1). Every other form is normalised
  /// to luminance 1, as pbrt-v4 does (its magnitude comes from "scale" and "power").
  std::uint32_t add_illuminant(const Spectrum& spectrum);

  /// Returns the luminance (CIE Y with the integral of y-bar as unit; 1 for rgb (1 1 1)) of the
  /// spectrum that add_illuminant makes.
  double illuminant_luminance(const Spectrum& spectrum) const;

  /// Returns the first float in spectrum_tables of a space's sigmoids by colour (uplift.cl), added
  /// on first use.
  std::uint32_t uplift_table(ColorSpace space);

  /// Returns the first float in spectrum_tables of a space's illuminant (luminance 1), added on
  /// first use.
  std::uint32_t illuminant_table(ColorSpace space);

 private:
  using Key = std::tuple<std::uint32_t, float, float, float, float, std::uint32_t>;
  std::uint32_t add_table(std::vector<float> table);
  std::uint32_t add_record(const SpectrumRecord& record);
  std::uint32_t add_samples(std::vector<float> table);

  std::map<std::vector<float>, std::uint32_t> tables_;
  std::map<Key, std::uint32_t> records_;
  std::map<ColorSpace, std::uint32_t> uplift_tables_;
  FlatScene& out_;
  ColorSpace space_;
};

}  // namespace caplet
