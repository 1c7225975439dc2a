// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Files that are moved, turned or scaled as they join a scene.
#pragma once

#include <filesystem>
#include <glm/mat4x4.hpp>
#include <optional>

#include "scene/scene.h"

namespace caplet {

struct PlacedFile {
  std::filesystem::path path;
  std::optional<glm::dmat4> placement;  // where it is not as the file has it
};

/// Reads FILE@translate=X,Y,Z@rotate=DEGREES,X,Y,Z@scale=S (or X,Y,Z): steps in the scene's
/// coordinates, one after the other. A file that has the whole as its name is taken as it is.
/// Throws InputError.
PlacedFile placed_file(const std::filesystem::path& given);

/// Moves the shapes and instances of a scene. Its lights, media and camera stay.
void place(Scene& scene, const glm::dmat4& placement);

}  // namespace caplet
