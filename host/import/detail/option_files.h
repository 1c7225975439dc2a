// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <optional>

#include "base/reading.h"
#include "import/import_options.h"

namespace caplet {

/// While an instance exists, files that options name may be read. Files that the user names may lie
/// anywhere; those that a scene's statement names must lie where the scene's other files may.
class OptionFiles {
 public:
  explicit OptionFiles(const ImportOptions& options) {
    if (!options.are_of_scene) anywhere_.emplace();
  }

 private:
  std::optional<ReadingAnywhere> anywhere_;
};

}  // namespace caplet
