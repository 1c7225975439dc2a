// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The importers of importers.def.
#pragma once

#include <filesystem>

#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet {

#define IMPORTER(function, name, ...) Scene function(const std::filesystem::path& path, const ImageReader& images);
#include "import/importers.def"
#undef IMPORTER

}  // namespace caplet
