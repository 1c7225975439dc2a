// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The importers of importers.def.
#pragma once

#include <filesystem>
#include <string>

#include "import/import.h"
#include "import/import_options.h"
#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet {

#define IMPORTER(function, name, ...)                                          \
  Scene function(const std::filesystem::path& path, const ImageReader& images, \
                 const ImportOptions& options = {});
#define FULL_IMPORTER(function, name, ...)                                        \
  Imported function(const std::filesystem::path& path, const ImageReader& images, \
                    const ImportOptions& options = {});
#include "import/importers.def"
#undef IMPORTER
#undef FULL_IMPORTER

}  // namespace caplet
