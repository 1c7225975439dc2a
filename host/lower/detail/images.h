// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts images of textures to their records and texels.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "lower/flat_scene.h"
#include "scene/scene.h"

namespace caplet {

/// ImageUse is an image as textures evaluate it: with a mode for coordinates beyond its edges
/// (CAPLET_WRAP_...), or as it is.
struct ImageUse {
  const TextureImage* image = nullptr;
  std::optional<int> wrap;

  auto operator<=>(const ImageUse&) const = default;
};

/// These are their numbers in `images`, from 0 on.
using ImageNumbers = std::map<ImageUse, std::uint32_t>;
/// Numbers each image once, in the order in which textures first name them.
ImageNumbers image_numbers(const std::vector<Texture>& textures);
/// Returns the key of one image in image_numbers: where the sides are powers of two, all have wrap
/// 0.
ImageUse image_use(const TextureImage& image, std::optional<int> wrap);

/// Fills `images`, by their numbers, and `texels`. Images of imagemaps whose sides are no powers of
/// two are resampled to the next ones by Lanczos' filter of radius 2, as pbrt-v4's are. They have
/// mip levels, down to one texel: a level has half the sides of that before, at least 1, and its
/// texels are the means of those that they cover. Throws InputError where they need more words than
/// 32 bits number.
void lower_images(const Scene& scene, const ImageNumbers& numbers, FlatScene& out);

}  // namespace caplet
