// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Bounds and counts of whole scenes.
#include "scene/scene.h"

#include <algorithm>
#include <cmath>

namespace caplet {

std::array<int, 2> strata_of(const SamplerSettings& sampler) {
  const int samples = sampler.samples_per_pixel;
  if (std::int64_t{sampler.x_strata} * sampler.y_strata == samples)
    return {sampler.x_strata, sampler.y_strata};
  int across = static_cast<int>(std::sqrt(static_cast<double>(samples)));
  while (samples % across != 0) --across;
  return {across, samples / across};
}

namespace {

constexpr std::size_t most_bounded_keys = 16;  // whose vertices are looked at one by one

}  // namespace

Bounds bounds_of(const Scene& scene) {
  Bounds bounds;
  for (const Shape& shape : scene.shapes) bounds.extend(bounds_of(shape));
  for (const Instance& instance : scene.instances) {
    const auto add = [&](const glm::dmat4& world_from_object) {
      for (const Shape& shape : scene.objects[instance.object].shapes)
        bounds.extend(bounds_of(shape.geometry, world_from_object * shape.world_from_object));
    };
    if (instance.motion.empty()) {
      add(instance.world_from_object);
      continue;
    }
    const AnimatedTransform animated(instance.motion, instance.pivot);
    Bounds box;
    for (const Shape& shape : scene.objects[instance.object].shapes) box.extend(bounds_of(shape));
    const auto add_box = [&](const glm::dmat4& world_from_object) {
      for (int corner = 0; corner < 8 && !box.empty(); ++corner)
        bounds.extend(
            glm::dvec3(world_from_object * glm::dvec4(corner & 1 ? box.max.x : box.min.x,
                                                      corner & 2 ? box.max.y : box.min.y,
                                                      corner & 4 ? box.max.z : box.min.z, 1)));
    };
    if (instance.motion.size() > most_bounded_keys) {
      for (const TransformKey& key : instance.motion) add_box(key.matrix);
      continue;
    }
    for (std::size_t i = 1; i < instance.motion.size(); ++i)
      for (int k = 0; k <= 16; ++k)
        add(animated.at(instance.motion[i - 1].time +
                        k / 16.0 * (instance.motion[i].time - instance.motion[i - 1].time)));
  }
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
