// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Messages from the page: JSON texts (docs/viewer.md). They are not trusted.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "scene/view.h"
#include "view/parts.h"
#include "view/redraw.h"

namespace caplet::view {

/// The view of the scene and its size in pixels.
struct ShowView {
  int width = 0, height = 0;
  glm::dmat4 world_from_camera{1};
  double fov = 0;  // radians, of the shorter side
  double lens_radius = 0, focal_distance = 1;
  double orthographic = 0;  // half the shorter side of a parallel view; 0: perspective
  double separation = 0;    // distance of the eyes of a stereo pair; 0: a single eye
  double convergence = 0;   // distance at which both views coincide; 0: infinity
  std::optional<ClipPlane> clip = {};
};
/// Whether pictures are denoised, for all pages.
struct Denoise {
  bool on = true;
};
/// Whether the page is visible.
struct Seen {
  bool seen = true;
};
/// Asks what a pixel shows: the nearest crossing or all of them, optionally with the reference
/// result.
struct Ask {
  double number = 0;  // returned with the answer
  int x = 0, y = 0;
  bool all = false, reference = false;
  int eye = 0;  // 1: the right of a stereo pair
};
/// Asks for the full picture as an EXR file.
struct Snapshot {};
/// Asks for a figure: a picture of its own size with what is drawn on it, as a PNG file.
struct MakeFigure {
  double number = 0;  // returned with what is told of it
  ShowView look;
  int samples = 0;  // of a pixel
  bool denoise = false;
  std::optional<std::string> background;  // a colour, or "transparent"; none: the scene's
  std::optional<std::string> exposure;    // of parse_exposure (present/picture_options.h)
  std::vector<std::pair<std::string, std::string>> drawn;  // overlays (post/overlay_options.h)
};
/// Ends the page's figure, unfinished.
struct EndFigure {};
/// Asks for a description of a thing: transform, surfaces, and the capsule `primitive` if it has
/// some.
struct Describe {
  double number = 0;
  std::uint32_t id = 0, primitive = 0;
};

// Changes of the scene. Things are shapes of the world and instances, by their numbers in the layer
// object.id.

/// Moves things: world_from_object is multiplied from the left by world_from_world.
struct Move {
  std::vector<std::uint32_t> ids;
  glm::dmat4 world_from_world{1};
};
/// Sets the ends of a capsule, in the world, and its radii, in its own space.
struct Reshape {
  std::uint32_t id = 0, capsule = 0;
  glm::dvec3 p0{0}, p1{0};
  double radius0 = 0, radius1 = 0;
};
/// Sets the material of one surface of shapes of the world, or of all surfaces.
struct Paint {
  std::vector<std::uint32_t> ids;
  std::optional<std::uint32_t> surface;
  std::uint32_t material = 0;
};
/// Copies things with an offset.
struct Duplicate {
  std::vector<std::uint32_t> ids;
  glm::dvec3 by{0};
};
struct Delete {
  std::vector<std::uint32_t> ids;
};
/// Draws the scene's files anew with these options, and all others as they are. Other changes of
/// things and materials are undone by it.
struct Redraw {
  FileOptions options;  // an empty text takes an option away
};
using Change =
    std::variant<Move, Reshape, Paint, Duplicate, Delete, Set, Add, Remove, Hide, Show, Redraw>;

struct Edit {
  Change change;
  bool goes_on = false;  // merges the change with the one before into one undo step
  double number = 0;     // returned with the result
};
/// Undoes or redoes a change.
struct Undo {
  bool again = false;
};

/// Saves the scene as pbrt text beside the scene's file.
struct Save {
  std::optional<std::string> name;  // none: the name of the last save, or the scene's own
  bool camera = false;              // save with the present camera; else with the scene's own
  bool replace = false;             // overwrite files that the session has not written
};
/// Undoes all unsaved changes.
struct Discard {};
/// Decides on changes that an earlier session kept for other content of the scene's file.
struct Kept {
  bool restore = false;  // replay them as far as possible; else forget them
};

using Message = std::variant<ShowView, Denoise, Seen, Ask, Snapshot, MakeFigure, EndFigure,
                             Describe, Form, Edit, Undo, Save, Discard, Kept>;

/// The longest file name, in bytes.
inline constexpr std::size_t longest_name = 200;

/// The largest picture that the page may ask for, in pixels per side.
inline constexpr int most_page_pixels = 4096;
/// The most samples of a figure's pixel.
inline constexpr int most_figure_samples = 16384;

/// Parses a message. Throws InputError that names the wrong field.
Message parse_message(std::string_view text);

}  // namespace caplet::view
