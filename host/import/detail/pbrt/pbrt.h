// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <filesystem>
#include <string>

#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet::pbrt {

/// Imports scene text in memory. `file` is its name, for messages and for relative paths. Throws
/// InputError.
Scene import_text(const std::string& file, std::string text, const ImageReader& images);

}  // namespace caplet::pbrt
