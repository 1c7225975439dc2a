// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/identity.h"

#include "base/check.h"

namespace caplet {

Identity identity_of(const Scene& scene, const PickRecord& pick) {
  const std::size_t in_world = scene.shapes.size();
  if (pick.object < in_world) return {&scene.shapes[pick.object], std::nullopt};
  const std::size_t instance = pick.object - in_world;
  CHECK_LT_(instance, scene.instances.size());
  // The numbers of an object's shapes continue those of the world's (lower/geometry.cpp).
  const auto& shapes = scene.objects[scene.instances[instance].object].shapes;
  CHECK_LT_(pick.shape - in_world, shapes.size());
  return {&shapes[pick.shape - in_world], static_cast<std::uint32_t>(instance)};
}

std::uint32_t object_number(const Scene& scene, const Identity& identity) {
  return narrow<std::uint32_t>(
      identity.instance ? scene.shapes.size() + *identity.instance
                        : static_cast<std::size_t>(identity.shape - scene.shapes.data()));
}

std::string object_label(const Scene& scene, const Identity& identity) {
  return identity.shape->name.empty() ? std::to_string(object_number(scene, identity))
                                      : identity.shape->name;
}

std::string material_label(const Scene& scene, std::uint32_t material) {
  const std::string& name = scene.materials[material].name;
  return name.empty() ? std::to_string(material) : name;
}

}  // namespace caplet
