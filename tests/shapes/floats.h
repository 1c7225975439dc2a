// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <array>
#include <glm/vec3.hpp>

namespace caplet::test {

/// Relative error of one rounding to float.
inline constexpr double eps = 0x1p-24;

inline glm::dvec3 point(const float* p) { return {p[0], p[1], p[2]}; }

inline std::array<float, 3> floats(const glm::dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace caplet::test
