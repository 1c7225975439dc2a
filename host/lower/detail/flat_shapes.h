// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts shapes of the scene to what their kernels read (shared/shapes.def), and says which
// transforms that form can hold.
#pragma once

#include <glm/mat4x4.hpp>
#include <vector>

#include "lower/flat_primitive.h"
#include "scene/scene.h"

namespace caplet {

/// Returns the common scale when `m` keeps angles (a rotation or reflection times a factor), within
/// float rounding; otherwise 0.
double similarity_scale(const glm::dmat4& m);

/// Returns true when the shape's kernel form can hold its transform; otherwise it becomes an
/// instance.
bool bakes(const Shape& shape);

glm::dvec3 apply_point(const glm::dmat4& m, const glm::dvec3& p);

/// Returns GeometryRecord.uv_space of a shape baked under `m`, appended to `leaves`; CAPLET_NONE
/// where its uv does not need it.
std::uint32_t append_uv_space(const Geometry& geometry, const glm::dmat4& m,
                              std::vector<float>& leaves);

/// Writes v to p.data[at .. at + 2].
void put(FlatPrimitive& p, int at, const glm::dvec3& v);

}  // namespace caplet
