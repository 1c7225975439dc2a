// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Random scenes with every row of every list, by what the rows' `fields` visit: a new row is among
// them.
#pragma once

#include <filesystem>

#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet::test {

/// Images by their names alone; the files need only be there.
class NamedImages : public ImageReader {
 public:
  EnvironmentImage read_rgb(const std::filesystem::path& path) const override;
  TextureImage read_texture(const std::filesystem::path& path,
                            const ImageEncoding& encoding) const override;
};

/// `folder` gets the files that the scene names. All parameters are others than those by default.
Scene random_scene(unsigned seed, const std::filesystem::path& folder);

}  // namespace caplet::test
