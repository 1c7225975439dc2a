// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <optional>

#include "base/reading.h"
#include "import/import_options.h"

namespace caplet {

/// While one lives, files that options name may be read: those that the user gave lie anywhere, those of a statement of a scene
/// where the scene's other files do.
class OptionFiles {
 public:
  explicit OptionFiles(const ImportOptions& options) {
    if (!options.are_of_scene) anywhere_.emplace();
  }

 private:
  std::optional<ReadingAnywhere> anywhere_;
};

}  // namespace caplet
