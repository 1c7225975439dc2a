// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <optional>
#include <string>

#include "import/capsules.h"
#include "import/pbrt_parameters.h"
#include "scene/scene.h"

namespace caplet::pbrt {

/// The geometry, name and material (if the statement names one) of a Shape statement of an accepted type; no value when it had
/// errors (reported). `material_index` finds materials by name, for "string materials" and for those named within .capsules
/// files. The rest of the state is the caller's.
std::optional<Shape> make_shape(const std::string& type, Parameters& parameters, std::uint32_t material,
                                const TextureTable& textures, const MaterialIndex& material_index);

}  // namespace caplet::pbrt
