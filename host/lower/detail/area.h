// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes areas of primitives, as they are and under affine maps.
#pragma once

#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

#include "lower/flat_primitive.h"

namespace caplet {

/// Returns the surface area of a primitive in its tree's space, without open ends; for csg shapes
/// 0. Bilinear patches use a sum (error 1e-8 of it for patches without folds), and so do molecular
/// ones (0.01 % of the whole sphere's), all others a closed form.
double primitive_area(const FlatPrimitive& p, const std::vector<float>& leaves);

/// AreaMap is an affine map, with the values that all primitives need of it.
struct AreaMap {
  AreaMap(const glm::dmat4& m);  // NOLINT(google-explicit-constructor)
  glm::dmat4 m;
  double similarity;  // the factor of lengths where it is one for all directions; 0: it is not
};

/// Returns the area of the primitive's image under the affine map, or of those `surfaces` of it
/// (empty: of all; numbers without a surface add nothing). An element of area with unit normal n
/// grows by |cof(M) n|, cof(M) = |det M| M^-T. It is exact for flat surfaces; round ones use
/// quadrature that converges geometrically: relative error 1e-9 where m stretches by less than ten
/// to one, and 2e-5 however it stretches. It is 0 for csg shapes.
double placed_area(const FlatPrimitive& p, const std::vector<float>& leaves, const AreaMap& map,
                   std::span<const std::uint32_t> surfaces);

}  // namespace caplet
