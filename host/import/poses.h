// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Files of poses: a JSON object a line, each what one frame changes of a scene.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "scene/edit.h"
#include "scene/scene.h"

namespace caplet {

/// Returns the number of lines that are not blank. Throws InputError for a file that cannot be
/// read, or has none or more than 10 million.
std::uint32_t count_poses(const std::filesystem::path& file);

/// Reads the poses; each starts from the scene as it is. Keys are all optional:
///   "shapes": {NAME: matrix}          world_from_object of shapes of the world
///   "instances": {NUMBER: matrix}     world_from_object, by index
///   "capsules": {NAME: {"p0": [[x, y, z], ...], "p1": ..., "radius": [r or [r0, r1], ...]}}
///   "camera": {"eye", "target", "up": [x, y, z], "transform": matrix, "fov": degrees}
/// A matrix has 12 or 16 numbers, by rows, flat or nested. Throws InputError with file and line for
/// what is no such object, unknown keys and names, and what cannot be rendered.
std::vector<std::vector<SceneEdit>> read_poses(const std::filesystem::path& file,
                                               const Scene& scene);

}  // namespace caplet
