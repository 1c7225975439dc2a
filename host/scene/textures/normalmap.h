// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <memory>

#include "scene/field.h"
#include "scene/texture_image.h"

namespace caplet {

/// Surface normals, used as Material::normalmap.
struct NormalmapTexture {
  std::shared_ptr<const TextureImage> image;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.vectors({"filename", "the image of normals"}, self.image);
  }
};

}  // namespace caplet
