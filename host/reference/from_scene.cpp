// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "reference/from_scene.h"

#include "reference/detail/parts.h"

namespace caplet::reference {

namespace {

template <class Model>
std::vector<Primitive> primitives_in(const Model& geometry) {
  if constexpr (FacedSolid<Model>)
    return {Solid<Model>{geometry}};
  else
    return references_of(geometry);
}

}  // namespace

std::vector<Primitive> primitives_of(const Shape& shape) {
  return std::visit([](const auto& geometry) { return primitives_in(geometry); }, shape.geometry);
}

}  // namespace caplet::reference
