// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes texture coordinates as docs/shapes.md defines them, in double precision.
#pragma once

#include <glm/vec2.hpp>

#include "reference/primitive.h"

namespace caplet::reference {

/// Returns (u, v) at the point of surface `surface` nearest to x (on it or next to it), in the
/// primitive's own space; for meshes those of triangles and patches without uvs of their own. They
/// are in [0, 1]; where u is undefined (poles, centres) it is anything in that range. For csg
/// shapes they are the operand's. Surfaces that are not there have (0, 0). direction: of the ray
/// that sees it, which only v of chains depends on.
glm::dvec2 uv_at(const Primitive& primitive, const glm::dvec3& x, int surface,
                 const glm::dvec3& direction = glm::dvec3(0));

}  // namespace caplet::reference
