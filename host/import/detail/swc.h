// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// SWC neurons (Cannon et al. 1998, doi:10.1016/S0165-0270(98)00091-0): samples with a radius and a parent each.
// Conventions: docs/formats/swc.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace caplet {

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

/// Parses the text of an SWC file and links parents. Radii are as written, 0 included. `name` is the file's name in messages.
/// Throws InputError with file:line:column (up to 20 at once): wrong columns, non-numbers, non-finite or negative values,
/// repeated ids, missing parents, self-parents, cycles, no samples.
std::vector<SwcSample> parse_swc(std::string_view text, const std::string& name);

}  // namespace caplet
