// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "caplet/import.h"

#include "film/image.h"
#include "import/import.h"
#include "library/detail/inside.h"

namespace caplet::v0 {

std::vector<SceneFormat> scene_formats() {
  std::vector<SceneFormat> out;
  for (const Format& format : formats()) out.push_back({format.name, format.extensions, format.options});
  return out;
}

Scene import_scene(const std::filesystem::path& file) { return import_scene(file, {}); }
Scene import_scene(const std::filesystem::path& file, const ImportOptions& options) {
  return Inside::scene(caplet::import_scene(file, FileImageReader(), caplet::ImportOptions(options)));
}

}  // namespace caplet::v0
