// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What fills space (media.def), and which side of a surface it is on.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "base/error.h"
#include "scene/media.def"

namespace caplet {

template <class, class... Types>
using MediumVariant = std::variant<Types...>;

struct Medium {
#define MEDIUM_MODEL(name, Type) , Type
  MediumVariant<void
#include "scene/media.def"
                >
      model;
  std::string name;
  SourceLocation where;
  /// What scatters within counts, together with the surface that light came in through, as one against the integrator's maxdepth.
  bool subsurface = false;
};

/// The media on both sides of a surface, by index in Scene::media: inside is where the normal points away from.
struct MediumSides {
  std::optional<std::uint32_t> inside, outside;
  bool operator==(const MediumSides&) const = default;
  /// Whether anything changes across it.
  bool differ() const { return inside != outside; }
};

}  // namespace caplet
