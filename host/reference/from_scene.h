// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts shapes of the scene to the reference implementation's primitives.
#pragma once

#include <vector>

#include "reference/primitive.h"
#include "scene/scene.h"

namespace caplet::reference {

/// Returns a shape's primitives, in order, in its object space (world_from_object is not applied).
std::vector<Primitive> primitives_of(const Shape& shape);

}  // namespace caplet::reference
