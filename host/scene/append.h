// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Joins scenes.
#pragma once

#include <cstdint>
#include <string>

#include "scene/scene.h"

namespace caplet {

/// Says where the things of an added scene begin in the scene that it was added to.
struct Appended {
  std::uint32_t textures = 0, media = 0, objects = 0;
  std::vector<std::uint32_t> materials;  // the new index of each material
};

/// Adds everything in `part`, including its lights; `to` keeps its camera, film and settings. A
/// diffuse material without textures is not added again where `to` has one of the same name and
/// colour.
Appended append(Scene& to, Scene part);

/// Puts `name` and a colon before the names of shapes and objects. Those without a name, or called
/// `itself`, are renamed `name`.
void prefix_names(Scene& scene, const std::string& name, const std::string& itself = "");

}  // namespace caplet
