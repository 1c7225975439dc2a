// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scenes from files.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "caplet/scene.h"

CAPLET_BEGIN

struct SceneFormat {
  std::string name;                     // "pbrt-v4"
  std::vector<std::string> extensions;  // ".pbrt"
  std::vector<std::string> options;     // names of import options that say something to it
};

/// Values of import options by name, as the program's --NAME takes them: {{"style", "sticks"}, {"up", "z"}}.
using ImportOptions = std::map<std::string, std::string>;

CAPLET_API std::vector<SceneFormat> scene_formats();

/// Reads a scene of any of these formats, chosen by extension. What the file leaves open (camera, light, material) gets good
/// values. Throws InputError with every mistake's file, line and column, and for options that say nothing to the format.
CAPLET_API Scene import_scene(const std::filesystem::path& file);
CAPLET_API Scene import_scene(const std::filesystem::path& file, const ImportOptions& options);

CAPLET_END
