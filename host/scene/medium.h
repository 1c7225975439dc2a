// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Participating media (media.def), and the media on both sides of a surface.
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
  /// Scattering within, together with the boundary that the light entered through, counts as one
  /// event for maxdepth.
  bool subsurface = false;
};

/// The media on both sides of a surface, as indices into Scene::media. The normal points away from
/// the inside.
struct MediumSides {
  std::optional<std::uint32_t> inside, outside;
  bool operator==(const MediumSides&) const = default;
  /// Returns whether the medium changes across the surface.
  bool differ() const { return inside != outside; }
};

}  // namespace caplet
