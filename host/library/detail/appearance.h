// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Materials and textures of the public classes -> the model's.
#pragma once

#include "caplet/material.h"
#include "scene/scene.h"

namespace caplet::v0 {

/// Throws InputError for an unknown name.
caplet::Spectrum to_model(const Spectrum& spectrum);

/// Without a name or a place; what its parameters name is of `scene`. Throws InputError for names of types and parameters that
/// there are none of, and for values of the wrong kind; what values lie within is checked where the material gets its place.
caplet::Material to_model(const Material& material, const caplet::Scene& scene);

/// The same; reads the file of an image.
caplet::Texture to_model(const NamedTexture& texture, const caplet::Scene& scene);

/// Throws InputError unless what bends the normals of `material` are textures of `scene` that do.
void check_bends(const caplet::Scene& scene, const caplet::Material& material);

/// Throws InputError where the textures of `scene`, which has nothing else, cannot be rendered.
void check_textures(const caplet::Scene& scene);

}  // namespace caplet::v0
