// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What surfaces are made of, for edits.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "caplet/export.h"

CAPLET_BEGIN

/// Linear sRGB, from 0 up.
struct Rgb {
  double r = 0, g = 0, b = 0;
};

/// The same at all wavelengths, a colour, or a name that pbrt scenes may use: "metal-Au-eta", "glass-BK7", "stdillum-D65".
using Spectrum = std::variant<double, Rgb, std::string>;

struct Diffuse {
  Spectrum reflectance = 0.5;
};

/// Roughness is GGX's alpha along dp/du and dp/dv; 0: perfectly smooth.
struct Conductor {
  Spectrum eta = std::string("metal-Cu-eta"), k = std::string("metal-Cu-k");
  std::optional<Spectrum> reflectance = {};  // at normal incidence, 0 to 1; replaces eta and k
  double roughness_u = 0, roughness_v = 0;
};
struct Dielectric {
  Spectrum eta = 1.5;
  double roughness_u = 0, roughness_v = 0;
};

using Material = std::variant<Diffuse, Conductor, Dielectric>;

CAPLET_END
