// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scenes from files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "caplet/scene.h"

CAPLET_BEGIN

struct SceneFormat {
  std::string name;                     // "pbrt-v4"
  std::vector<std::string> extensions;  // ".pbrt"
};

CAPLET_API std::vector<SceneFormat> scene_formats();

/// Reads a scene of any of these formats, chosen by extension. What the file leaves open (camera, light, material) gets good
/// values. Throws InputError with every mistake's file, line and column.
CAPLET_API Scene import_scene(const std::filesystem::path& file);

CAPLET_END
