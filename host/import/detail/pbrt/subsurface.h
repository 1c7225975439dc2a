// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "import/detail/pbrt/parameters.h"
#include "scene/scene.h"

namespace caplet::pbrt {

/// Makes the medium behind the boundary of pbrt's "subsurface" (docs/media.md) from all parameters
/// but those of the boundary, whose index is `eta`. Coefficients that are textures are replaced by
/// their means over the texture, with a warning.
Medium subsurface_medium(Parameters& parameters, const TextureTable& textures, const Scene& scene,
                         const Spectrum& eta);

}  // namespace caplet::pbrt
