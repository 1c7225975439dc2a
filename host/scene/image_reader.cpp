// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/image_reader.h"

namespace caplet {

TextureImage ImageReader::read_texture(const std::filesystem::path& path,
                                       const ImageEncoding&) const {
  throw InputError(path.string() + ": images of textures cannot be read here");
}

}  // namespace caplet
