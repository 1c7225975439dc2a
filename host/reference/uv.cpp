// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "reference/detail/uv.h"

#include "reference/detail/parts.h"

namespace caplet::reference {

glm::dvec2 uv_at(const Primitive& primitive, const glm::dvec3& x, int surface,
                 const glm::dvec3& direction) {
  if (surface < 0 || surface >= surface_count(primitive)) return {0, 0};
  if (const auto* capsule = std::get_if<Capsule>(&primitive); capsule && capsule->u)
    return chain_uv_of(*capsule, x, direction);
  if (const auto* csg = std::get_if<Csg>(&primitive)) return csg_uv_of(*csg, x, surface, direction);
  return std::visit([&](const auto& shape) { return uv_of(shape, x, surface); }, primitive);
}

}  // namespace caplet::reference
