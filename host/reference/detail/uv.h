// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Texture coordinates as docs/shapes.md defines them, in double precision.
#pragma once

#include <glm/vec2.hpp>

#include "reference/primitive.h"

namespace caplet::reference {

/// (u, v) at the point of surface `surface` nearest to x (on it or next to it), in the primitive's own space; of meshes those of
/// triangles and patches without uvs of their own. In [0, 1]; where u is undefined (poles, centres) anything in it. Of csg shapes
/// the operand's. Surfaces that are not there have (0, 0). direction: of the ray that sees it, which tells v of chains alone.
glm::dvec2 uv_at(const Primitive& primitive, const glm::dvec3& x, int surface, const glm::dvec3& direction = glm::dvec3(0));

}  // namespace caplet::reference
