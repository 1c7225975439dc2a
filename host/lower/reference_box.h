// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes boxes of primitives.
#pragma once

#include "lower/flat_primitive.h"

namespace caplet {

/// Computes the exact box of a primitive in its tree's space: min, then max.
void primitive_box(const FlatPrimitive& p, double min[3], double max[3]);

/// The tree's boxes are the unions of these: the box of every point that the shape kernels may
/// report, rounded outward.
struct ReferenceBox {
  float min[3], max[3];
};
ReferenceBox reference_box(const FlatPrimitive& p);

}  // namespace caplet
