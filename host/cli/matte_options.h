// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The options of `render` and `merge` about mattes and deep pictures.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "film/layers.h"

namespace caplet::cli {

struct MatteFlags {
  bool cryptomatte = false;
  std::optional<int> levels;
  std::string deep;
};

void add_matte_flags(CLI::App& command, MatteFlags& flags);

/// Returns where the deep picture is written; empty where it is not. Throws InputError for a name
/// that is not one of an EXR.
std::filesystem::path deep_path(const MatteFlags& flags);

/// Returns the layers, and the mattes if the flags ask for them.
Layers with_mattes(Layers layers, const MatteFlags& flags);

}  // namespace caplet::cli
