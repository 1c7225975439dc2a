// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Tree files in place of scene files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "import/import_options.h"
#include "lower/tree_file.h"
#include "post/scale_bar.h"
#include "scene/scene.h"

namespace caplet::cli {

/// A scene that `caplet build` has lowered.
struct Tree {
  Scene scene;  // its view, and names in place of its content (report/outline.h)
  TreeFile file;
  nlohmann::ordered_json summary;     // of the scene that it was built of (report::scene_summary)
  std::vector<std::uint32_t> joined;  // its shapes (post::Sight)
  /// Returns what overlays need, of the view as it is in `seen`.
  post::Sight sight(const Scene& seen) const;
};

/// Returns whether the scene is a tree file. Throws InputError for a tree file among others.
bool is_tree(const std::vector<std::string>& scenes);

/// Maps a tree file. Throws InputError, also for options, which were for the scene that it was
/// built of.
Tree read_tree(const std::string& file, const ImportOptions& options);

/// What is written of a scene beside its arrays.
class TreeWriter {
 public:
  /// Notes what lowering may give back. `folder`: that of the file, which names other files
  /// relative to it.
  TreeWriter(const Scene& scene, const std::filesystem::path& folder);
  void write(const std::filesystem::path& file, const FlatScene& flat,
             const std::function<void(double)>& progress);

 private:
  TreeNotes notes_;
};

}  // namespace caplet::cli
