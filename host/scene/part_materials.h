// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include "scene/shape.h"

namespace caplet {

/// Returns the materials that the parts of a shape have one by one, in place of the shape's: those
/// of capsules and of a molecule's balls. They may be none; null: the shape has no such parts.
template <class AnyShape>
auto* part_materials(AnyShape& shape) {
  using List = std::conditional_t<std::is_const_v<AnyShape>, const std::vector<std::uint32_t>,
                                  std::vector<std::uint32_t>>;
  if (auto* capsules = std::get_if<CapsulesShape>(&shape.geometry)) return &capsules->materials;
  if (auto* molecule = std::get_if<MolecularSurfaceShape>(&shape.geometry))
    return &molecule->materials;
  return static_cast<List*>(nullptr);
}

}  // namespace caplet
