// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <optional>
#include <string>

#include "import/detail/pbrt_parameters.h"
#include "scene/scene.h"

namespace caplet::pbrt {

/// What a Texture statement (`kind` "float" or "spectrum", a known class) comes to.
TextureValue make_texture(const std::string& kind, const std::string& texture_class, Parameters& parameters,
                          const TextureTable& textures);

/// The material of an accepted type.
Material make_material(const std::string& type, Parameters& parameters, const TextureTable& textures);

}  // namespace caplet::pbrt
