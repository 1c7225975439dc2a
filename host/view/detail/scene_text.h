// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What the page is told of a scene.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "scene/scene.h"
#include "view/hidden.h"
#include "view/messages.h"

namespace caplet::view {

/// Most shapes and instances that are named one by one.
inline constexpr std::size_t most_named = 5000;

/// Three numbers: x, y, z.
nlohmann::ordered_json to_json(const glm::dvec3& v);

/// How the page says it, too (messages.h).
nlohmann::ordered_json camera_text(const Look& look);

/// Its name, bounds (bounds_or_unit_of), shapes and instances by their object.id, materials, the device's name, and the samples
/// of a pixel at which a picture is done.
nlohmann::ordered_json scene_text(const Scene& scene, const std::string& device, std::uint32_t samples);

/// Names of what is hidden: shapes, then instances.
nlohmann::ordered_json hidden_text(const Scene& scene, const Hidden& hidden);

/// A thing: its place in the world, bounds, surfaces with their materials, and a capsule of it where it has some, with its ends
/// in the world. Null where there is none.
nlohmann::ordered_json thing_text(const Scene& scene, std::uint32_t id, std::uint32_t primitive);

}  // namespace caplet::view
