// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "export/export.h"
#include "film/image.h"
#include "import/import.h"
#include "support/data.h"

namespace caplet::test {

inline std::vector<std::filesystem::path> scene_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> out;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (entry.is_regular_file() &&
        (extension == ".pbrt" || extension == ".swc" || extension == ".capsules"))
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

/// Every scene file of a folder that can be read, written and read again: `check` gets the scene,
/// what was read and the file between. Fails where there is none.
template <class Check>
void each_written_again(const std::filesystem::path& folder, const Check& check) {
  std::size_t count = 0;
  for (const std::filesystem::path& file : scene_files(folder)) {
    const std::optional<Scene> scene = readable_scene(file);
    if (!scene) continue;
    SCOPED_TRACE(file);
    ++count;
    const std::filesystem::path target = temporary_folder() / "scene.pbrt";
    write_scene(*scene, target);
    check(*scene, import_scene(target, FileImageReader()), target);
  }
  EXPECT_GT(count, 0u);
}

}  // namespace caplet::test
