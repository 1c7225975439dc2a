// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The scene model in double precision, as its file states it. Importers produce it, and all other
// parts read it. Lengths are in scene units, angles in radians; matrices map column vectors and are
// named destination_from_source.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.h"
#include "scene/light.h"
#include "scene/material.h"
#include "scene/medium.h"
#include "scene/motion.h"
#include "scene/shape.h"
#include "scene/spectrum.h"
#include "scene/view.h"

namespace caplet {

// --- Objects and instances ---

struct Object {
  std::string name;
  std::vector<Shape> shapes;
  SourceLocation where;
};
struct Instance {
  std::uint32_t object = 0;         // index into Scene::objects
  glm::dmat4 world_from_object{1};  // of one that moves: at its first key
  SourceLocation where;
  TransformKeys motion = {};
  glm::dvec3 pivot{0};  // of the object, for its motion (AnimatedTransform)
};

/// Settings of the automatic camera.
struct Framing {
  std::optional<glm::dvec3> toward_viewer;  // world, of any length
  std::optional<glm::dvec3> up;             // world, unit; none: y
  bool is_orthographic = false;
};

/// What colours tell: numbers, by a map's colours at even steps from `low` to `high`; names; or
/// directions, by the share of each of the file's axes in red, green and blue.
struct Legend {
  std::string title, unit;
  double low = 0, high = 1;
  std::vector<glm::dvec3> colors;       // linear sRGB, as displayed
  std::vector<std::string> names = {};  // one a colour, where colours tell names
  bool of_directions = false;
};

/// Returns the colour of a direction by its parts along the file's axes, of any sign: linear sRGB,
/// from 0.05 to 0.85, so that each reflects some light of every channel.
inline glm::dvec3 direction_color(const glm::dvec3& unit) { return 0.05 + 0.8 * glm::abs(unit); }

struct Scene {
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Medium> media;
  std::vector<Shape> shapes;  // world
  std::vector<Object> objects;
  std::vector<Instance> instances;
  std::vector<Light> lights;
  View view;
  std::string source;             // the file it came from
  bool automatic_camera = false;  // the camera was framed to the shapes (present/present.h), for
                                  // the film's size as it was
  bool has_no_up = false;  // no direction is up (a neuron): the automatic camera may turn the scene
                           // within the image
  Framing framing;         // settings of the automatic camera
  glm::dmat3 world_from_file{1};  // a rotation: its axes are those of the file
  std::string unit;               // the unit of lengths, as people write it ("µm"); empty: unknown
  std::optional<Legend> legend;   // the legend of its colours
  std::vector<std::pair<std::string, std::uint64_t>>
      contents;  // counts of what the file holds and shapes do not tell, such as "atoms"
};

/// Returns the bounds of all shapes in the world, including instances. Those that move count where
/// they are at each key and at 15 times between keys, whether the shutter is open then or not. Of
/// those with more than 16 keys the corners of their boxes count, at each key.
Bounds bounds_of(const Scene& scene);

/// Counts primitives by kind, with instances expanded. Kinds are the names of shapes in scene
/// files; tapered capsules count as "capsule", patches of a bilinear mesh as "bilinear_patch".
std::map<std::string, std::uint64_t> count_primitives(const Scene& scene);

/// Reports everything that cannot be rendered: non-finite numbers, non-positive sizes, singular
/// transforms, indices out of range, an image larger than 2^28 pixels. Errors name the places of
/// the statements.
void validate(const Scene& scene, Diagnostics& diagnostics);

}  // namespace caplet
