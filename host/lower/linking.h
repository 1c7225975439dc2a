// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Says which capsules share the points of their leaf blocks with their neighbours.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>

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
  /// The memory of linked capsules of the scene is given back while it is lowered, unless media
  /// need them: use lower_and_release.
  bool release = false;
  /// Capsules that are not linked stay as primitives, which edits move.
  bool keeps_primitives = false;

  /// All stay as primitives.
  static Linking none() {
    Linking out{std::numeric_limits<std::size_t>::max()};
    out.keeps_primitives = true;
    return out;
  }
  /// Scenes that are edited have some only where memory counts more than the first edit's time.
  static Linking of_edited() { return {std::size_t{1} << 24}; }
};

}  // namespace caplet
