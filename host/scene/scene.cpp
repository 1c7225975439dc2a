// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Bounds and counts of whole scenes.
#include "scene/scene.h"

#include <algorithm>

namespace caplet {

std::array<double, 4> screen_window_of(const Camera& camera, const FilmSettings& film) {
  const double aspect = camera.frame_aspect_ratio.value_or(static_cast<double>(film.width) / film.height);
  const double x = std::max(aspect, 1.0), y = std::max(1 / aspect, 1.0);
  return camera.screen_window.value_or(std::array<double, 4>{-x, x, -y, y});
}

Bounds bounds_of(const Scene& scene) {
  Bounds bounds;
  for (const Shape& shape : scene.shapes) bounds.extend(bounds_of(shape));
  for (const Instance& instance : scene.instances)
    for (const Shape& shape : scene.objects[instance.object].shapes)
      bounds.extend(bounds_of(shape.geometry, instance.world_from_object * shape.world_from_object));
  return bounds;
}

std::map<std::string, std::uint64_t> count_primitives(const Scene& scene) {
  std::map<std::string, std::uint64_t> counts;
  const auto add = [&](const Shape& shape, std::uint64_t times) {
    counts[geometry_name(shape)] += times * primitive_count(shape);
  };
  for (const Shape& shape : scene.shapes) add(shape, 1);
  std::vector<std::uint64_t> uses(scene.objects.size(), 0);
  for (const Instance& instance : scene.instances) ++uses[instance.object];
  for (std::size_t i = 0; i < uses.size(); ++i)
    for (const Shape& shape : scene.objects[i].shapes)
      if (uses[i] > 0) add(shape, uses[i]);
  return counts;
}

}  // namespace caplet
