// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Messages that describe a scene to the page.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "scene/scene.h"
#include "view/hidden.h"
#include "view/messages.h"

namespace caplet::view {

/// The most shapes and instances that are listed by name.
inline constexpr std::size_t most_named = 5000;

/// Three numbers: x, y, z.
nlohmann::ordered_json to_json(const glm::dvec3& v);

/// The page sends cameras in the same form (messages.h).
nlohmann::ordered_json camera_text(const ShowView& look);

/// Returns what the page puts under pictures: "transparent", a displayed colour (linear sRGB), or
/// null for nothing.
nlohmann::ordered_json backdrop_text(const std::optional<Backdrop>& backdrop);
nlohmann::ordered_json exposure_text(const PreviewExposure& exposure);

/// Returns name, bounds (bounds_or_unit_of), shapes and instances by their object.id, materials,
/// the device's name, and the samples per pixel and the noise (0: any) of a finished picture.
nlohmann::ordered_json scene_text(const Scene& scene, const std::string& device,
                                  std::uint32_t samples, double noise);

/// Returns the names of hidden things: shapes, then instances.
nlohmann::ordered_json hidden_text(const Scene& scene, const Hidden& hidden);

/// Returns a thing: its transform, bounds, surfaces with their materials, and one of its capsules
/// if it has some, with its ends in the world. Returns null if the thing does not exist.
nlohmann::ordered_json thing_text(const Scene& scene, std::uint32_t id, std::uint32_t primitive);

}  // namespace caplet::view
