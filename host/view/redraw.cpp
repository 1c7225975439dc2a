// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/redraw.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "base/error.h"

namespace caplet::view {

FileOptions changed_options(const SceneFiles& files, const FileOptions& now,
                            const FileOptions& changed) {
  FileOptions out = now;
  for (const auto& [name, text] : changed) {
    const auto row = std::ranges::find(files.options, name, &FileOption::name);
    if (row == files.options.end())
      throw InputError(SourceLocation{name}, "the scene's files have no such option");
    if (row->values.find("FILE") != std::string::npos && text.find('/') != std::string::npos)
      throw InputError(SourceLocation{name}, "a page may not name files of other folders");
    if (text.empty())
      out.erase(name);
    else
      out[name] = text;
  }
  return out;
}

Scene redrawn(const SceneFiles& files, const FileOptions& options, const Scene& before) {
  Scene out = files.read(options);
  const auto medium = out.view.camera.medium;
  out.view = before.view;
  out.view.camera.medium = medium;
  out.lights = before.lights;
  out.automatic_camera = before.automatic_camera;
  out.has_no_up = before.has_no_up;
  out.framing = before.framing;
  out.source = before.source;
  return out;
}

}  // namespace caplet::view
