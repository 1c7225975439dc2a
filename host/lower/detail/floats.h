// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds floats next to others, matrices as rows of floats, and numbers that several files
// of this room need.
#pragma once

#include <bit>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <limits>

namespace caplet {

inline constexpr float inf = std::numeric_limits<float>::infinity();

/// This child of an 8-wide node means that there is none.
inline constexpr std::uint32_t no_child = 0x7fffffffu;

/// Returns the smallest float above x, which is finite. Infinity comes after the largest number.
inline float next_up(float x) {
  const auto bits = std::bit_cast<std::int32_t>(x);
  return x == 0 ? std::numeric_limits<float>::denorm_min()
                : std::bit_cast<float>(bits < 0 ? bits - 1 : bits + 1);
}

/// Returns the largest float below x, which is finite.
inline float next_down(float x) { return -next_up(-x); }

/// Writes the upper three rows of m: 12 floats, row by row, as kernels read transforms.
inline void write_matrix(float* rows, const glm::dmat4& m) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) rows[r * 4 + c] = static_cast<float>(m[c][r]);
}

}  // namespace caplet
