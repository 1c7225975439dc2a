// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "import/detail/pbrt_parameters.h"
#include "scene/scene.h"

namespace caplet::pbrt {

/// What is behind the boundary of pbrt's "subsurface" (docs/media.md): all of its parameters but those of the boundary, whose
/// index is `eta`. Coefficients that are textures count by their means over the texture, and a warning says so.
Medium subsurface_medium(Parameters& parameters, const TextureTable& textures, const Scene& scene, const Spectrum& eta);

}  // namespace caplet::pbrt
