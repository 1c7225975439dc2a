// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace caplet {

/// An axis-aligned box. It is empty by default.
struct Bounds {
  glm::dvec3 min{1e300}, max{-1e300};
  bool empty() const { return !(min.x <= max.x); }
  void extend(const glm::dvec3& p) {
    min = glm::min(min, p);
    max = glm::max(max, p);
  }
  void extend(const Bounds& other) {
    min = glm::min(min, other.min);
    max = glm::max(max, other.max);
  }
};

}  // namespace caplet
