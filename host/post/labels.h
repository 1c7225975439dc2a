// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Words at points of the scene.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace caplet::post {

/// Words beside a point of the world.
struct Label {
  glm::dvec3 at;
  std::string words;
};

/// Parses "X,Y,Z WORDS", one or several between semicolons or as lines. Throws InputError that
/// names `flag`.
std::vector<Label> parse_labels(std::string_view text, const std::string& flag);

}  // namespace caplet::post
