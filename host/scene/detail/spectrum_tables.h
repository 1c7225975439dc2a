// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Published spectral tables behind the named spectra.
#pragma once

#include <span>
#include <vector>

namespace caplet {

/// Relative power at `first`, `first` + 5, ... nm.
struct IlluminantTable {
  const char* name;
  double first;
  std::span<const double> values;
};
/// Rows of wavelength (nm), n, k.
struct MetalTable {
  const char* name;
  std::span<const double> rows;
};
/// Rows of wavelength (nm), value.
struct NamedTable {
  const char* name;
  std::span<const double> rows;
};

const std::vector<IlluminantTable>& illuminant_tables();
const std::vector<MetalTable>& metal_tables();
/// These are pbrt-v4's own tables (spectrum_tables_pbrt.cpp).
const std::vector<NamedTable>& pbrt_tables();

}  // namespace caplet
