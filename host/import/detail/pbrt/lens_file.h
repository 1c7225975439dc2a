// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// pbrt's lens files: four numbers for each surface, from the scene to the film: radius of curvature
// (0: the stop), thickness, index of refraction, diameter; lengths in mm.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"
#include "scene/camera.h"

namespace caplet::pbrt {

/// Throws InputError with the place in the file, or at `where` when the file cannot be read.
Lens read_lens_file(const std::filesystem::path& path, const SourceLocation& where);
Lens parse_lens_text(const std::string& file, std::string text);

}  // namespace caplet::pbrt
