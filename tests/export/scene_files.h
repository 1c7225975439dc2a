// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "film/image.h"
#include "import/import.h"
#include "support/data.h"

namespace caplet::test {

/// Scene files of a folder, those that can be read.
struct SceneFile {
  std::filesystem::path path;
  Scene scene;
};
inline std::vector<std::filesystem::path> scene_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> out;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (entry.is_regular_file() && (extension == ".pbrt" || extension == ".swc" || extension == ".capsules"))
      out.push_back(entry.path());
  }
  std::ranges::sort(out);
  return out;
}

inline std::optional<Scene> readable_scene(const std::filesystem::path& file) {
  try {
    return import_scene(file, FileImageReader());
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace caplet::test
