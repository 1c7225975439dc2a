// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What surfaces are made of (materials.def).
#pragma once

#include <string>
#include <variant>

#include "base/error.h"
#include "scene/materials.def"

namespace caplet {

template <class, class... Types>
using MaterialVariant = std::variant<Types...>;

struct Material {
#define MATERIAL_MODEL(name, Type) , Type
  MaterialVariant<void
#include "scene/materials.def"
                  >
      model;
  std::string name;
  SourceLocation where;
};

}  // namespace caplet
