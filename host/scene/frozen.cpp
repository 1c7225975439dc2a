// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/frozen.h"

#include <algorithm>

#include "scene/motion.h"

namespace caplet {

bool moves(const Scene& scene) {
  return !scene.view.camera.motion.empty() ||
         std::ranges::any_of(scene.instances,
                             [](const Instance& one) { return !one.motion.empty(); });
}

Scene frozen_at(Scene scene, double time) {
  const auto freeze = [time](TransformKeys& keys, const glm::dvec3& pivot, glm::dmat4& matrix) {
    if (!keys.empty()) matrix = AnimatedTransform(keys, pivot).at(time);
    keys.clear();
  };
  for (Instance& instance : scene.instances)
    freeze(instance.motion, instance.pivot, instance.world_from_object);
  freeze(scene.view.camera.motion, glm::dvec3(0), scene.view.camera.world_from_camera);
  return scene;
}

glm::dvec3 rendering_origin(const Camera& camera) {
  if (camera.motion.empty()) return {camera.world_from_camera[3]};
  const double middle = 0.5 * (camera.motion.front().time + camera.motion.back().time);
  return {AnimatedTransform(camera.motion).at(middle)[3]};
}

}  // namespace caplet
