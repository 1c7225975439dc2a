// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Options of the picture, for scenes of any format: the rows `picture` of import_option_rows().
#pragma once

#include "import/import_options.h"
#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet {

/// The most that --least-width may ask for, in pixels: anything wider is no line.
constexpr float widest_least_width = 64;

/// Sets the camera, lights and film of a scene by the options. `is_turned`: the importer has turned
/// the scene so that y is up, as the option "up" asks; otherwise the camera is turned. Throws
/// InputError that names the option.
void apply_picture_options(Scene& scene, const ImageReader& images, const ImportOptions& options,
                           bool is_turned);

}  // namespace caplet
