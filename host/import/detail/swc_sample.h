// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace caplet {

/// Types of samples: the cell body's, and those of apical dendrites.
inline constexpr int kSoma = 1, kApical = 4;

/// One line of the file.
struct SwcSample {
  std::int64_t id = 0;
  std::int64_t parent_id = -1;
  std::int32_t type = 0;
  std::int32_t parent = -1;  // index into the samples; -1: root
  glm::vec3 position{0};
  float radius = 0;
  int line = 0;
};

}  // namespace caplet
