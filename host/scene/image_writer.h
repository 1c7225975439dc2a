// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <filesystem>
#include <string>

#include "scene/light_image.h"
#include "scene/texture_image.h"

namespace caplet {

/// Writes images that are in no file, for exporters. host/film implements it, and the caller of an
/// exporter passes it in.
class ImageWriter {
 public:
  /// A file, and whether it was not there before.
  struct File {
    std::filesystem::path path;
    bool is_new = false;
  };
  virtual ~ImageWriter() = default;
  /// Writes an image so that an ImageReader reads the same values, with the image's encoding. The
  /// file's name is `stem`'s with a hash of the contents: a file that is there stays. Throws
  /// RunError.
  virtual File write(const std::filesystem::path& stem, const TextureImage& image) const = 0;
  virtual File write(const std::filesystem::path& stem, const EnvironmentImage& image) const = 0;
};

}  // namespace caplet
