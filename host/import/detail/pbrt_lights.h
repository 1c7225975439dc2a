// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <optional>
#include <string>

#include "import/detail/pbrt_parameters.h"
#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet::pbrt {

/// The light of a LightSource statement of an accepted type; no value when it had errors (reported).
std::optional<Light> make_light(const std::string& type, Parameters& parameters, const glm::dmat4& world_from_light,
                                const ImageReader& images);

/// The emission an AreaLightSource statement gives to the shapes after it.
AreaEmission make_area_emission(Parameters& parameters);

}  // namespace caplet::pbrt
