// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "scene/motion.h"
#include "scene/shapes/family.h"

namespace caplet {

/// A boolean combination of closed solids. Difference subtracts all others from the first. The
/// surfaces of the operands are numbered one after the other; of a subtracted solid the inside is
/// visible.
struct CsgShape {
  enum class Operation {
    set_union,
    set_intersection,
    set_difference
  } operation = Operation::set_union;
  std::vector<std::shared_ptr<const Shape>>
      operands;  // two or more; their world_from_object is object_from_operand
  /// Says how each operand moves: object_from_operand, about its origin, the one of its
  /// world_from_object first. No keys: it rests. Empty: all rest.
  std::vector<TransformKeys> motions = {};

  const TransformKeys& motion(std::size_t operand) const {
    static const TransformKeys none;
    return motions.empty() ? none : motions[operand];
  }
};
inline constexpr std::size_t max_csg_operands = 32;  // solids in one csg shape, nested ones counted

/// Counts the solids in it, including nested ones. Counting stops above max_csg_operands.
std::size_t solids_of(const CsgShape& csg);

inline std::size_t count_of(const CsgShape&) { return 1; }
std::size_t surfaces_of(const CsgShape& csg);
inline bool closed(const CsgShape&) { return true; }
/// Returns whether an operand moves, or its points do.
bool moves(const CsgShape& csg);
/// Calls visit(time) for the times (seconds) of all keys of its operands' motions.
void visit_key_times(const CsgShape& csg, const std::function<void(double)>& visit);
/// Returns bounds tight to about 1/64 of the size, within 0.4 ms (csg_bounds.cpp); empty when the
/// solid is found to be empty. Bounds of one whose operands move hold it at all times, and are
/// those of the operands' boxes.
Bounds bounds_under(const CsgShape& csg, const glm::dmat4& m);
/// Returns whether a search, shorter than that of the bounds, finds that the operands leave no
/// solid.
bool is_empty(const CsgShape& csg, const glm::dmat4& m);
void check(const CsgShape& csg, ShapeCheck& report);
/// This is never called: nested csg is resolved into its solids.
inline Beyond beyond(const CsgShape&, const glm::dvec3&) { return unknown; }

}  // namespace caplet
