// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "present/next_frame.h"

#include <algorithm>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "present/open_shutter.h"
#include "scene/frozen.h"
#include "scene/shapes/capsule_motion.h"
#include "scene/shapes/mesh_motion.h"

namespace caplet {

namespace {

bool differ(const CapsulesShape& a, const CapsulesShape& b) {
  return a.p0 != b.p0 || a.p1 != b.p1 || a.radius0 != b.radius0 || a.radius1 != b.radius1;
}
bool differ(const TriangleMeshShape& a, const TriangleMeshShape& b) {
  return a.positions != b.positions || a.normals != b.normals;
}

void move_shapes(std::vector<Shape>& shapes, const std::vector<Shape>& next) {
  for (std::size_t i = 0; i < std::min(shapes.size(), next.size()); ++i) {
    if (shapes[i].world_from_object != next[i].world_from_object ||
        (shapes[i].emission && shapes[i].emission->power))
      continue;
    const auto pair = [&]<class Type>(std::type_identity<Type>) {
      auto* now = std::get_if<Type>(&shapes[i].geometry);
      const auto* then = std::get_if<Type>(&next[i].geometry);
      if (now && then && differ(*now, *then) && add_key(*now, 1, *then)) now->times = {0, 1};
    };
    pair(std::type_identity<CapsulesShape>());
    pair(std::type_identity<TriangleMeshShape>());
  }
}

/// Returns how a matrix goes to another one; not at all where that is a mirror image.
TransformKeys keys_of(const glm::dmat4& now, const glm::dmat4& next) {
  if (now == next || !(glm::determinant(glm::dmat3(now)) * glm::determinant(glm::dmat3(next)) > 0))
    return {};
  return {{0, now}, {1, next}};
}

}  // namespace

void move_to_next_frame(Scene& scene, const Scene& next, double share) {
  if (moves(scene) || moves(next)) return;
  move_shapes(scene.shapes, next.shapes);
  for (std::size_t i = 0; i < std::min(scene.objects.size(), next.objects.size()); ++i)
    move_shapes(scene.objects[i].shapes, next.objects[i].shapes);
  for (std::size_t i = 0; i < std::min(scene.instances.size(), next.instances.size()); ++i) {
    Instance& now = scene.instances[i];
    const Instance& then = next.instances[i];
    if (now.object == then.object)
      now.motion = keys_of(now.world_from_object, then.world_from_object);
  }
  if (!scene.automatic_camera && !next.automatic_camera)
    scene.view.camera.motion =
        keys_of(scene.view.camera.world_from_camera, next.view.camera.world_from_camera);
  scene.view.film.shutter_open = 0;
  expose(scene.view.film, share);
}

}  // namespace caplet
