// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Changes to a scene that keep the number of its shapes, capsules, instances, materials and lights.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <variant>
#include <vector>

#include "scene/scene.h"

namespace caplet {

/// Names a shape of the world or of an object definition.
struct ShapeAt {
  std::optional<std::uint32_t> object;  // index into Scene::objects; none: the world
  std::uint32_t shape = 0;              // index into Scene::shapes or Object::shapes
};

/// One capsule of a CapsulesShape, in its object space.
struct Capsule {
  glm::vec3 p0{0}, p1{0};
  float radius0 = 0, radius1 = 0;
};

struct CapsuleEdit {
  ShapeAt at;
  std::size_t capsule = 0;
  Capsule to;
};
struct TransformEdit {
  ShapeAt at;
  glm::dmat4 world_from_object{1};
};
/// Changes the emission of a shape that emits.
struct EmissionEdit {
  ShapeAt at;
  AreaEmission to;
};
/// Changes where an instance is, and how it moves; without keys its motion goes along.
struct InstanceEdit {
  std::uint32_t instance = 0;
  glm::dmat4 world_from_object{1};  // where there are keys, the first one's
  std::optional<TransformKeys> motion = {};
  glm::dvec3 pivot{0};
};
/// The material keeps its name and index but not its textures.
struct MaterialEdit {
  std::uint32_t material = 0;
  decltype(Material::model) to;
  std::vector<TexturedField> textures = {};
};
/// The light keeps its index.
struct LightEdit {
  std::uint32_t light = 0;
  Light to;
};

/// A View changes the camera and the settings of a render.
using SceneEdit = std::variant<CapsuleEdit, TransformEdit, EmissionEdit, InstanceEdit, MaterialEdit,
                               LightEdit, View>;

/// Throws InputError when the place does not exist, or when validate() would refuse the result.
void check_edit(const Scene& scene, const SceneEdit& edit);

/// Makes the change. Throws as check_edit does, and then changes nothing.
void apply_edit(Scene& scene, const SceneEdit& edit);

/// Applies an edit that check_edit has already passed.
void put_edit(Scene& scene, const SceneEdit& edit);

/// Returns the edit that restores what `edit` would replace. Throws InputError when the place does
/// not exist.
SceneEdit inverse(const Scene& scene, const SceneEdit& edit);

/// Returns the shape that an edit names. Throws InputError when there is none.
const Shape& shape_at(const Scene& scene, const ShapeAt& at);
/// Returns a capsule in its present state. Throws InputError when there is none, or when the shape
/// has no capsules.
Capsule capsule_at(const Scene& scene, const ShapeAt& at, std::size_t capsule);

/// Returns Camera::world_from_camera of a camera at `eye` that looks at `target`, with `up` upward.
/// There is no value where the points coincide or `up` is parallel to the view.
std::optional<glm::dmat4> camera_looking(const glm::dvec3& eye, const glm::dvec3& target,
                                         const glm::dvec3& up);

}  // namespace caplet
