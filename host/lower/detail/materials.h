// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts materials of the model to records and their data.
#pragma once

#include "lower/detail/images.h"
#include "lower/flat_scene.h"
#include "lower/spectrum.h"
#include "scene/scene.h"

namespace caplet {

/// Each material has this many floats in material_data: room for any kind, so that a material may
/// become one of another kind in its place.
inline constexpr std::uint32_t material_stride = 16;

/// Returns the record of material number `index`, and writes its data to out.material_data, which
/// grows when it ends before. The steps of its textures are added.
MaterialRecord lower_material(const Scene& scene, std::uint32_t index, const ImageNumbers& images,
                              SpectrumTable& spectra, FlatScene& out);

}  // namespace caplet
