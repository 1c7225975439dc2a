// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace caplet {

/// Reads images for importers (environment maps, textures). host/film implements it, and the caller
/// of an importer passes it in.
class ImageReader {
 public:
  virtual ~ImageReader() = default;
  /// Returns linear RGB floats, row-major from the top. Throws InputError when the file is missing,
  /// broken or of an unknown type.
  virtual EnvironmentImage read_rgb(const std::filesystem::path& path) const = 0;
  /// Reads an image for a texture. `encoding` is that of integer samples. Values are finite. Throws
  /// in readers without textures.
  virtual TextureImage read_texture(const std::filesystem::path& path,
                                    const ImageEncoding& encoding) const;
};

}  // namespace caplet
