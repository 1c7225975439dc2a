// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Writes scenes to files.
#pragma once

#include <filesystem>

#include "caplet/scene.h"

CAPLET_BEGIN

/// Writes the scene as pbrt text to a file `.pbrt`, which is replaced atomically. import_scene
/// reads it to the same picture, bit for bit. Images and other files are referenced, not copied;
/// images that are in no file are written beside it, as PNG or EXR named by their contents. Throws
/// InputError, and leaves the file as it was, for what text cannot express; RunError when writing
/// fails.
CAPLET_API void write_scene(const Scene& scene, const std::filesystem::path& file);

CAPLET_END
