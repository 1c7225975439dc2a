// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Imports scenes from files.
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
  std::vector<std::string> options;     // names of the import options that it knows
};

/// Values of import options by name, as for the program's --NAME: {{"style", "sticks"}, {"up",
/// "z"}}.
using ImportOptions = std::map<std::string, std::string>;

CAPLET_API std::vector<SceneFormat> scene_formats();

/// Reads a scene of any of these formats, chosen by extension. A missing camera, light or material
/// gets sensible defaults. `options`: the program's options --NAME VALUE, {{"view", "top"},
/// {"background", "white"}, {"style", "sticks"}}. Throws InputError with the file, line and column
/// of every error, or with the option's name.
CAPLET_API Scene import_scene(const std::filesystem::path& file,
                              const std::map<std::string, std::string>& options = {});

CAPLET_END
