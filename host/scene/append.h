// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scenes as one.
#pragma once

#include <cstdint>
#include <string>

#include "scene/scene.h"

namespace caplet {

/// Where in a scene the things of one that was added begin.
struct Appended {
  std::uint32_t textures = 0, media = 0, objects = 0;
  std::vector<std::uint32_t> materials;  // the new index of each
};

/// Adds what `part` consists of, its lights among it; `to` keeps its camera, film and settings. A diffuse material without
/// textures that is there already, by its name and colour, is not added again.
Appended append(Scene& to, Scene part);

/// Puts `name` and a colon before the names of shapes and objects; those without a name, or called `itself`, get `name` alone.
void prefix_names(Scene& scene, const std::string& name, const std::string& itself = "");

}  // namespace caplet
