// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is a build without OpenImageIO: there is no module of image files.
#include <fmt/format.h>

#include "base/error.h"
#include "film/detail/image_module.h"

namespace caplet::image_files {

bool available() { return false; }

const Module& module_for(const std::filesystem::path& path) {
  throw InputError(
      fmt::format("{}: this build reads and writes EXR and PNG only (CAPLET_WITH_OIIO=OFF): "
                  "convert the image to PNG or EXR, or "
                  "use a build with OpenImageIO",
                  path.string()));
}

}  // namespace caplet::image_files
