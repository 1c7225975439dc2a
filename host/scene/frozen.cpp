// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/frozen.h"

#include <algorithm>
#include <cmath>

#include "scene/motion.h"
#include "scene/shapes/capsule_motion.h"
#include "scene/shapes/mesh_motion.h"

namespace caplet {

namespace {

bool any_moves(const std::vector<Shape>& shapes) {
  return std::ranges::any_of(shapes, [](const Shape& one) { return moves(one); });
}

/// Returns the shape as kernels see it while the shutter is open, and else to one rounding.
template <class Motion, class Type>
Type frozen(const Type& moving, const FilmSettings& film, double time) {
  const double at = (time - film.shutter_open) / film.open_time();
  if (!(at >= 0 && at <= 1)) return at_time(moving, time);
  return Motion(moving, film.shutter_open, film.open_time()).at(static_cast<float>(at));
}

void freeze_shape(Shape& shape, const FilmSettings& film, double time) {
  if (!moves(shape)) return;
  if (auto* capsules = std::get_if<CapsulesShape>(&shape.geometry))
    *capsules = frozen<CapsuleMotion>(*capsules, film, time);
  if (auto* mesh = std::get_if<TriangleMeshShape>(&shape.geometry))
    *mesh = frozen<MeshMotion>(*mesh, film, time);
  auto* csg = std::get_if<CsgShape>(&shape.geometry);
  if (!csg) return;
  for (std::size_t i = 0; i < csg->operands.size(); ++i) {
    Shape operand = *csg->operands[i];
    freeze_shape(operand, film, time);
    if (!csg->motion(i).empty())
      operand.world_from_object = AnimatedTransform(csg->motion(i)).at(time);
    csg->operands[i] = std::make_shared<const Shape>(std::move(operand));
  }
  csg->motions.clear();
}

}  // namespace

bool moves(const Scene& scene) {
  return !scene.view.camera.motion.empty() || any_moves(scene.shapes) ||
         std::ranges::any_of(scene.objects,
                             [](const Object& one) { return any_moves(one.shapes); }) ||
         std::ranges::any_of(scene.instances,
                             [](const Instance& one) { return !one.motion.empty(); });
}

std::optional<std::array<double, 2>> motion_span(const Scene& scene) {
  if (!moves(scene)) return std::nullopt;
  std::array<double, 2> out{INFINITY, -INFINITY};
  const auto add = [&out](double time) { out = {std::min(out[0], time), std::max(out[1], time)}; };
  const auto add_shapes = [&](const std::vector<Shape>& shapes) {
    for (const Shape& shape : shapes) visit_key_times(shape, add);
  };
  add_shapes(scene.shapes);
  for (const Object& object : scene.objects) add_shapes(object.shapes);
  for (const Instance& instance : scene.instances)
    for (const TransformKey& key : instance.motion) add(key.time);
  for (const TransformKey& key : scene.view.camera.motion) add(key.time);
  return out;
}

Scene frozen_at(Scene scene, double time) {
  const auto freeze = [time](TransformKeys& keys, const glm::dvec3& pivot, glm::dmat4& matrix) {
    if (!keys.empty()) matrix = AnimatedTransform(keys, pivot).at(time);
    keys.clear();
  };
  for (Instance& instance : scene.instances)
    freeze(instance.motion, instance.pivot, instance.world_from_object);
  const auto freeze_shapes = [&](std::vector<Shape>& shapes) {
    for (Shape& shape : shapes) freeze_shape(shape, scene.view.film, time);
  };
  freeze_shapes(scene.shapes);
  for (Object& object : scene.objects) freeze_shapes(object.shapes);
  freeze(scene.view.camera.motion, glm::dvec3(0), scene.view.camera.world_from_camera);
  return scene;
}

glm::dvec3 rendering_origin(const Camera& camera) {
  if (camera.motion.empty()) return {camera.world_from_camera[3]};
  const double middle = 0.5 * (camera.motion.front().time + camera.motion.back().time);
  return {AnimatedTransform(camera.motion).at(middle)[3]};
}

}  // namespace caplet
