// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "caplet/import.h"

#include <algorithm>

#include "base/spelling.h"
#include "film/image.h"
#include "import/import.h"
#include "library/detail/inside.h"

namespace caplet::v0 {

std::vector<SceneFormat> scene_formats() {
  std::vector<SceneFormat> out;
  for (const Format& format : formats())
    out.push_back({format.name, format.extensions, format.options});
  return out;
}

Scene import_scene(const std::filesystem::path& file,
                   const std::map<std::string, std::string>& options) {
  for (const auto& [name, value] : options) {
    std::vector<std::string> names;
    for (const ImportOptionRow& row : import_option_rows()) names.push_back(row.name);
    if (std::ranges::find(names, name) == names.end())
      throw InputError("there is no option '" + name + "'; the nearest is '" +
                       nearest_name(name, names) + "'");
  }
  return Inside::scene(caplet::import_scene(file, FileImageReader(), options));
}

}  // namespace caplet::v0
