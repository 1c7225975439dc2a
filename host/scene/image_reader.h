// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace caplet {

/// Reads images for importers (environment maps, textures). host/film implements it; whoever imports passes it in.
class ImageReader {
 public:
  virtual ~ImageReader() = default;
  /// Linear RGB floats, row-major from the top. Throws InputError when the file is missing, broken or of an unknown type.
  virtual EnvironmentImage read_rgb(const std::filesystem::path& path) const = 0;
  /// The same as textures take it: `encoding` is that of whole numbers. Values are finite. Of a reader that has none, an error.
  virtual TextureImage read_texture(const std::filesystem::path& path, const ImageEncoding& encoding) const;
};

}  // namespace caplet
