// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Materials of the model -> records and their data.
#pragma once

#include "lower/detail/images.h"
#include "lower/flat_scene.h"
#include "lower/spectrum.h"
#include "scene/scene.h"

namespace caplet {

/// Floats in material_data for each material: room for any kind, so that a material may become one of another kind in its place.
inline constexpr std::uint32_t material_stride = 16;

/// The record of material number `index`, whose data it writes to out.material_data: made longer when that ends before. The steps
/// of its textures are added.
MaterialRecord lower_material(const Scene& scene, std::uint32_t index, const ImageNumbers& images, SpectrumTable& spectra,
                              FlatScene& out);

}  // namespace caplet
