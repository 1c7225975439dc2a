// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Files of poses: a JSON object a line, each what one frame, or one key of an animation, changes
// of a scene.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "scene/pose.h"
#include "scene/scene.h"

namespace caplet {

/// What a file of poses has before its scene is known.
struct PoseCount {
  std::uint32_t poses = 0;
  std::optional<std::pair<double, double>> seconds = {};  // the times of the first and last key
};

/// Counts the lines that are not blank and, where the first has a time, checks those of all. Throws
/// InputError for a file that cannot be read, that has none or more than 10 million, and for times
/// that are missing, no numbers, or do not rise.
PoseCount count_poses(const std::filesystem::path& file);

/// Reads the poses; each starts from the scene as it is. Members are all optional:
///   "time": seconds                   of a key; of each line or of none
///   "shapes": {NAME: matrix}          world_from_object of shapes of the world
///   "instances": {NUMBER: matrix}     world_from_object, by index
///   "capsules": {NAME: {"p0": [[x, y, z], ...], "p1": ..., "radius": [r or [r0, r1], ...]}}
///   "camera": {"eye", "target", "up": [x, y, z], "transform": matrix, "fov": degrees}
/// A matrix has 12 or 16 numbers, by rows, flat or nested. Throws InputError with file and line for
/// what is no such object, unknown keys and names, and what cannot be rendered.
std::vector<ScenePose> read_poses(const std::filesystem::path& file, const Scene& scene);

}  // namespace caplet
