// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts materials and textures of the public classes to the model's.
#pragma once

#include "caplet/material.h"
#include "scene/scene.h"

namespace caplet::v0 {

/// Throws InputError for an unknown name.
caplet::Spectrum to_model(const Spectrum& spectrum);

/// Returns a material without name and place. Its parameters refer to parts of `scene`. Throws
/// InputError for unknown types and parameters, and for values of the wrong type; ranges are
/// checked when the material is put into the scene.
caplet::Material to_model(const Material& material, const caplet::Scene& scene);

/// Does the same for a texture; reads the file of an image.
caplet::Texture to_model(const NamedTexture& texture, const caplet::Scene& scene);

/// Throws InputError unless the displacement and normalmap of `material` are suitable textures of
/// `scene`.
void check_bends(const caplet::Scene& scene, const caplet::Material& material);

/// Throws InputError if the textures of `scene`, which has nothing else, cannot be rendered.
void check_textures(const caplet::Scene& scene);

}  // namespace caplet::v0
