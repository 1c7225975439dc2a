// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Areas of primitives, as they are and under affine maps.
#pragma once

#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

#include "lower/flat_primitive.h"

namespace caplet {

/// Surface area of a primitive in its tree's space, without open ends; of csg shapes 0. Bilinear patches by a sum (error 1e-8 of
/// it for patches without folds), all others in closed form.
double primitive_area(const FlatPrimitive& p, const std::vector<float>& leaves);

/// An affine map, with what all primitives ask of it.
struct AreaMap {
  AreaMap(const glm::dmat4& m);  // NOLINT(google-explicit-constructor)
  glm::dmat4 m;
  double similarity;  // the factor of lengths where it is one for all directions; 0: it is not
};

/// Area of the primitive's image under the affine map, or of those `surfaces` of it (empty: of all; numbers without a surface
/// add nothing). An element of area with unit normal n grows by |cof(M) n|, cof(M) = |det M| M^-T. Exact for flat surfaces; round
/// ones by quadrature that converges geometrically: relative error 1e-9 where m stretches by less than ten to one, and 2e-5
/// however it stretches. 0 for csg shapes.
double placed_area(const FlatPrimitive& p, const std::vector<float>& leaves, const AreaMap& map,
                   std::span<const std::uint32_t> surfaces);

}  // namespace caplet
