// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Lights other than emissive shapes (lights.def).
#pragma once

#include <optional>
#include <variant>

#include "base/error.h"
#include "scene/lights.def"

namespace caplet {

template <class, class... Types>
using LightVariant = std::variant<Types...>;

struct Light {
#define LIGHT_MODEL(name, Type) , Type
  LightVariant<void
#include "scene/lights.def"
               >
      model;
  double scale = 1;
  std::optional<double> power;        // pbrt's "power"
  std::optional<double> illuminance;  // pbrt's "illuminance" (distant, infinite)
  SourceLocation where;
};

}  // namespace caplet
