// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Maps the numbers of lower back to the names in the scene.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scene/scene.h"
#include "shared/records.h"

namespace caplet {

struct Identity {
  const Shape* shape = nullptr;
  std::optional<std::uint32_t> instance;  // index into Scene::instances; none: a shape of the world
};

/// Returns what a crossing (not a miss) is on.
Identity identity_of(const Scene& scene, const PickRecord& pick);

/// Returns the number in the object-id layer: shapes of the world in the order of the scene, then
/// its instances.
std::uint32_t object_number(const Scene& scene, const Identity& identity);

/// Returns the shape's name; without one, the number in the object-id layer.
std::string object_label(const Scene& scene, const Identity& identity);
/// Returns the material's name; without one, its index in Scene::materials.
std::string material_label(const Scene& scene, std::uint32_t material);

}  // namespace caplet
