// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What the page says: JSON texts (docs/viewer.md). Nothing of them is trusted.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "view/parts.h"

namespace caplet::view {

/// How the scene is looked at, and in how many pixels.
struct Look {
  int width = 0, height = 0;
  glm::dmat4 world_from_camera{1};
  double fov = 0;  // radians, of the shorter side
  double lens_radius = 0, focal_distance = 1;
  double orthographic = 0;  // half the shorter side of what is seen, of parallel rays; 0: perspective
  double separation = 0;    // of a pair of eyes; 0: one alone
  double convergence = 0;   // what is so far before them is at one place in both views; 0: what is infinitely far
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
  int eye = 0;  // of a pair: 1 the right
};
/// The picture in full, as an EXR file.
struct Snapshot {};
/// What a thing is: its place, its surfaces, and the capsule `primitive` where it has some.
struct Describe {
  double number = 0;
  std::uint32_t id = 0, primitive = 0;
};

// Changes of the scene. Things are shapes of the world and instances, by their numbers in the layer object.id.

/// Moves things: world_from_object becomes world_from_world times it.
struct Move {
  std::vector<std::uint32_t> ids;
  glm::dmat4 world_from_world{1};
};
/// The ends of a capsule, in the world, and its radii, in its own space.
struct Reshape {
  std::uint32_t id = 0, capsule = 0;
  glm::dvec3 p0{0}, p1{0};
  double radius0 = 0, radius1 = 0;
};
/// Another material on a surface of shapes of the world, or on all of them.
struct Paint {
  std::vector<std::uint32_t> ids;
  std::optional<std::uint32_t> surface;
  std::uint32_t material = 0;
};
/// Copies things, moved by so much.
struct Duplicate {
  std::vector<std::uint32_t> ids;
  glm::dvec3 by{0};
};
struct Delete {
  std::vector<std::uint32_t> ids;
};
using Change = std::variant<Move, Reshape, Paint, Duplicate, Delete, Set, Add, Remove, Hide, Show>;

struct Edit {
  Change change;
  bool goes_on = false;  // with the gesture of the change before: the two are taken back as one
  double number = 0;     // given back with what comes of it
};
/// Takes the last change back, or makes it again.
struct Undo {
  bool again = false;
};

/// The scene as pbrt text, in a file beside the scene's.
struct Save {
  std::optional<std::string> name;  // none: the one that it was saved to last, or the scene's own
  bool camera = false;              // with the camera as it now is; else the scene keeps its own
  bool replace = false;             // also what the session has not written itself
};
/// Takes all that is not saved back.
struct Discard {};
/// What to do with changes that an earlier session kept of another content of the scene's file.
struct Kept {
  bool restore = false;  // make them again, as far as they can be; else they are forgotten
};

using Message = std::variant<Look, Seen, Ask, Snapshot, Describe, Form, Edit, Undo, Save, Discard, Kept>;

/// Longest name of a file, in bytes.
inline constexpr std::size_t longest_name = 200;

/// Largest picture that the page may ask for, in pixels along a side.
inline constexpr int most_page_pixels = 4096;

/// Throws InputError that says which field is wrong.
Message parse_message(std::string_view text);

}  // namespace caplet::view
