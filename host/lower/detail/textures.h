// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts textures of the model to steps (records.def: TextureRecord) and their data.
#pragma once

#include <optional>

#include "lower/detail/images.h"
#include "lower/flat_scene.h"
#include "lower/spectrum.h"
#include "scene/scene.h"

namespace caplet {

/// TextureUse says how values of a texture are used: as reflectances, as spectra from 0 up, or as
/// numbers.
enum class TextureUse { albedo, unbounded, number };

/// Adds the steps of Scene::textures[texture] to out.textures, and one of kind `last` of it where
/// there is one. Returns the number of the first.
std::uint32_t lower_texture(const Scene& scene, std::uint32_t texture, TextureUse use,
                            std::optional<uint> last, const ImageNumbers& images,
                            SpectrumTable& spectra, FlatScene& out);

/// Does the same for a shape's alpha.
std::uint32_t lower_alpha(const Scene& scene, const TextureOperand& alpha,
                          const ImageNumbers& images, SpectrumTable& spectra, FlatScene& out);

}  // namespace caplet
