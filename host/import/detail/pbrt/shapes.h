// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <optional>
#include <string>

#include "import/detail/capsules.h"
#include "import/detail/pbrt/parameters.h"
#include "scene/scene.h"

namespace caplet::pbrt {

/// What a Shape statement may refer to.
struct ShapeContext {
  const TextureTable& textures;
  const MaterialIndex&
      material_index;           // for "string materials" and for names within .capsules files
  const ObjectLookup& objects;  // for csg
};

/// Makes the geometry, name and materials (the statement's, else `material`) of a Shape statement
/// of an accepted type. Errors are reported. The caller adds the rest of the state.
Shape make_shape(const std::string& type, Parameters& parameters, std::uint32_t material,
                 const ShapeContext& context);

}  // namespace caplet::pbrt
