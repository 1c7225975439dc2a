// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scenes that move, and what they are at one time.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>

#include "scene/scene.h"

namespace caplet {

/// Returns whether instances, capsules or the camera have motions.
bool moves(const Scene& scene);

/// Returns the first and the last time (seconds) of all keys; none where nothing moves.
std::optional<std::array<double, 2>> motion_span(const Scene& scene);

/// Returns the scene as it is at a time (seconds): nothing of it moves.
Scene frozen_at(Scene scene, double time);

/// Returns the origin of the space that pbrt-v4 renders in, halfway through the camera's motion. It
/// is the pivot of instances in its scene files, unless they state the option "rendercoordsys".
glm::dvec3 rendering_origin(const Camera& camera);

}  // namespace caplet
