// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What is asked of a picture, whatever format its scene is of: the LOOK_OPTIONs of import_options.def.
#pragma once

#include "import/import_options.h"
#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet {

/// Camera, lights and film of a scene as the options ask. `is_turned`: the importer has turned the scene so that y is up, as the
/// option "up" says; else the camera is turned. Throws InputError naming the option.
void apply_look(Scene& scene, const ImageReader& images, const ImportOptions& options, bool is_turned);

}  // namespace caplet
