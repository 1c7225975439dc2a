// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <array>
#include <memory>

#include "scene/field.h"
#include "scene/texture_image.h"
#include "scene/texture_mapping.h"
#include "scene/texture_operand.h"

namespace caplet {

/// The order is that of CAPLET_WRAP_... and CAPLET_FILTER_... (kernels/shared/kinds.h).
inline constexpr std::array<const char*, 4> texture_wrap_names = {"repeat", "black", "clamp",
                                                                  "octahedralsphere"};
inline constexpr std::array<const char*, 4> texture_filter_names = {"point", "bilinear",
                                                                    "trilinear", "EWA"};

/// `scale` times an image at (s, t); its bottom row is at t = 0. invert: 1 minus that, at least 0.
struct ImagemapTexture {
  std::shared_ptr<const TextureImage> image;
  int wrap = 0, filter = 1;
  double maxanisotropy = 8, scale = 1;
  bool invert = false;
  TextureMapping mapping = {};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.image({"filename", "the image"}, self.image);
    visit.choice({"wrap", "what lies beyond the image's edges"}, self.wrap, texture_wrap_names);
    visit.choice({"filter", "how texels are filtered"}, self.filter, texture_filter_names);
    visit.number({"maxanisotropy", "greatest ratio of a footprint's sides, for EWA"},
                 self.maxanisotropy);
    visit.number({"scale", "factor of the image's values"}, self.scale);
    visit.flag({"invert", "1 less the value, from 0 up"}, self.invert);
    visit.mapping(self.mapping);
  }
};

}  // namespace caplet
