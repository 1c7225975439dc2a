// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What the page says: JSON texts (docs/viewer.md). Nothing of them is trusted.
#pragma once

#include <glm/mat4x4.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace caplet::view {

/// How the scene is looked at, and in how many pixels.
struct Look {
  int width = 0, height = 0;
  glm::dmat4 world_from_camera{1};
  double fov = 0;  // radians, of the shorter side
  double lens_radius = 0, focal_distance = 1;
};
/// Whether anybody sees the page.
struct Seen {
  bool seen = true;
};
/// What a pixel of the page's picture shows, by its nearest crossing or by all of them, with the witness's answer or without.
struct Ask {
  double number = 0;  // given back with the answer
  int x = 0, y = 0;
  bool all = false, reference = false;
};
/// The picture in full, as an EXR file.
struct Snapshot {};

using Message = std::variant<Look, Seen, Ask, Snapshot>;

/// Largest picture that the page may ask for, in pixels along a side.
inline constexpr int most_page_pixels = 4096;

/// Throws InputError that says which field is wrong.
Message parse_message(std::string_view text);

}  // namespace caplet::view
