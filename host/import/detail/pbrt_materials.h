// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <optional>
#include <string>

#include "import/detail/pbrt_parameters.h"
#include "scene/scene.h"

namespace caplet::pbrt {

/// What a Texture statement (`kind` "float" or "spectrum", a known class) comes to. One that varies is added to the scene.
TextureValue make_texture(const std::string& name, const std::string& kind, const std::string& texture_class,
                          Parameters& parameters, const TextureTable& textures, Scene& scene);

/// The material of an accepted type. The scene gets the textures that its remapped roughness takes.
Material make_material(const std::string& type, Parameters& parameters, const TextureTable& textures, Scene& scene);

}  // namespace caplet::pbrt
