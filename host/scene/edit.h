// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Changes of a scene that leave what it consists of as it is: so many shapes, capsules, instances, materials and lights.
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

/// A shape of the world, or of an object definition.
struct ShapeAt {
  std::optional<std::uint32_t> object;  // index into Scene::objects; none: the world
  std::uint32_t shape = 0;              // index into Scene::shapes or Object::shapes
};

/// One of a CapsulesShape, in its object space.
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
/// Of a shape that emits.
struct EmissionEdit {
  ShapeAt at;
  AreaEmission to;
};
struct InstanceEdit {
  std::uint32_t instance = 0;
  glm::dmat4 world_from_object{1};
};
/// The material keeps its name and place, not its textures.
struct MaterialEdit {
  std::uint32_t material = 0;
  decltype(Material::model) to;
  std::vector<TexturedField> textures = {};
};
/// The light keeps its place.
struct LightEdit {
  std::uint32_t light = 0;
  Light to;
};
/// What is rendered of the scene, and how.
struct ViewEdit {
  Camera camera;
  PixelFilter filter;
  FilmSettings film;
  SamplerSettings sampler;
  IntegratorSettings integrator;
};

using SceneEdit = std::variant<CapsuleEdit, TransformEdit, EmissionEdit, InstanceEdit, MaterialEdit, LightEdit, ViewEdit>;

/// Throws InputError when there is no such place, and when validate() would refuse what is to stand there.
void check_edit(const Scene& scene, const SceneEdit& edit);

/// Makes the change. Throws as check_edit does, and then changes nothing.
void apply_edit(Scene& scene, const SceneEdit& edit);

/// The same of an edit that check_edit has passed.
void put_edit(Scene& scene, const SceneEdit& edit);

/// What an edit of its shape names. Throws InputError when there is none.
const Shape& shape_at(const Scene& scene, const ShapeAt& at);
/// A capsule as it now is. Throws InputError when there is none, or the shape is not of capsules.
Capsule capsule_at(const Scene& scene, const ShapeAt& at, std::size_t capsule);
/// The view as it now is.
ViewEdit view_of(const Scene& scene);

/// Camera::world_from_camera of a camera at `eye` that looks at `target`, `up` being up; none where the points coincide, or up
/// lies along the view.
std::optional<glm::dmat4> camera_looking(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up);

}  // namespace caplet
