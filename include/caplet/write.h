// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scenes to files.
#pragma once

#include <filesystem>

#include "caplet/scene.h"

CAPLET_BEGIN

/// Writes the scene as pbrt text to a file `.pbrt`, which is replaced as a whole. import_scene of it gives the same picture, bit
/// for bit; the scene's images and other files are named, not copied. Throws InputError, and leaves the file as it was, for what
/// no text says (an image that was read from no file); RunError when writing fails.
CAPLET_API void write_scene(const Scene& scene, const std::filesystem::path& file);

CAPLET_END
