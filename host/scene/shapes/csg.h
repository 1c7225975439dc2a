// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <memory>
#include <vector>

#include "scene/shapes/family.h"

namespace caplet {

/// Closed solids combined. Difference: the first without all others. The operands' surfaces follow each other; what is subtracted
/// shows its inside.
struct CsgShape {
  enum class Operation { set_union, set_intersection, set_difference } operation = Operation::set_union;
  std::vector<std::shared_ptr<const Shape>> operands;  // two or more; their world_from_object is object_from_operand
};
inline constexpr std::size_t max_csg_operands = 32;  // solids in one csg shape, nested ones counted

/// Solids in it, nested ones counted. Counting stops above max_csg_operands.
std::size_t solids_of(const CsgShape& csg);

inline std::size_t count_of(const CsgShape&) { return 1; }
std::size_t surfaces_of(const CsgShape& csg);
inline bool closed(const CsgShape&) { return true; }
/// Around the solid, and tight to about 1/64 of its size, at moderate cost (csg_bounds.cpp); empty when it is found to be empty.
Bounds bounds_under(const CsgShape& csg, const glm::dmat4& m);
void check(const CsgShape& csg, ShapeCheck& report);
/// Of no use: nested csg is resolved into its solids.
inline Beyond beyond(const CsgShape&, const glm::dvec3&) { return unknown; }

}  // namespace caplet
