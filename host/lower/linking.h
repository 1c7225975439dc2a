// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Says which capsules share the points of their leaf blocks with their neighbours.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <limits>
#include <span>

#include "lower/flat_primitive.h"
#include "scene/scene.h"

namespace caplet {

/// Linking says which capsules become linked ones, which take some half of the memory. An edit of
/// one has the scene lowered again without any.
struct Linking {
  /// Scenes of fewer capsules have none.
  std::size_t least_capsules = std::size_t{1} << 16;
  /// The least number in a row.
  std::size_t least_run = 4;
  /// The shapes that may have some; empty: all.
  std::function<bool(const Shape&)> allows = {};

  static Linking none() { return {std::numeric_limits<std::size_t>::max()}; }
  /// Scenes that are edited have some only where memory counts more than the first edit's time.
  static Linking of_edited() { return {std::size_t{1} << 24}; }
};

/// LinkedCapsule is what FlatPrimitive::data holds for linked capsules.
struct LinkedCapsule {
  float p0[3], p1[3];
  float r0, r1;
  float u0, u1;  // of a chain, at p0 and p1
  float has_u;   // 1: it is of a chain; 0
};
LinkedCapsule linked_capsule(const FlatPrimitive& p);

/// Makes those capsules and tapered capsules linked ones that follow each other `least_run` times
/// or more: one begins where the one before ends, with its radius, its u and the next id. `u`: at
/// both ends of each, or empty. Returns whether all are linked.
bool link_capsules(std::span<FlatPrimitive> primitives, std::span<const glm::vec2> u,
                   std::size_t least_run);

/// Returns whether two linked capsules may share a point of a leaf block.
bool are_linked(const FlatPrimitive& before, const FlatPrimitive& after);

/// Returns the rows of a leaf block of linked capsules such as `p`.
std::uint32_t link_rows(const FlatPrimitive& p);
/// Writes the leaf block (shared/shapes.h) of one to eight of them, of which each is linked with
/// the one before.
void write_links(std::span<const FlatPrimitive> capsules, float* block);

}  // namespace caplet
