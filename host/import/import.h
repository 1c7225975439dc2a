// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads scene files of every known format into the model. A format is one file here, one row in importers.def and one page in
// docs/formats.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "import/import_options.h"
#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet {

struct Format {
  std::string name;                     // "pbrt-v4"
  std::vector<std::string> extensions;  // ".pbrt"
  std::vector<std::string> options;     // names of those in import_options.def that it knows
  /// Throws InputError.
  Scene (*import)(const std::filesystem::path& path, const ImageReader& images, const ImportOptions& options);
};

const std::vector<Format>& formats();

/// Imports by extension. The scene is validated; a file that says nothing of camera, light or material has good ones.
/// Throws InputError for a missing, unreadable or wrong file, an unknown extension, or an option that says nothing to its format.
Scene import_scene(const std::filesystem::path& path, const ImageReader& images, const ImportOptions& options = {});

}  // namespace caplet
