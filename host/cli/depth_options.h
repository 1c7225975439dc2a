// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The options of `render` about depth pictures.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "film/depth_picture.h"
#include "scene/scene.h"

namespace caplet::cli {

struct DepthFlags {
  std::string file;
  std::optional<std::string> kind;  // depth_kinds
  std::optional<double> unit;       // scene units
  bool is_planar() const { return kind && *kind == "planar"; }
};

void add_depth_flags(CLI::App& command, DepthFlags& flags);

/// Returns where the depth picture is written; empty where it is not. Throws InputError for another
/// format, and for flags that go with --depth alone.
std::filesystem::path depth_path(const DepthFlags& flags);

/// Throws InputError where planar depths are asked of a camera that moves.
void check_depth(const DepthFlags& flags, const Camera& camera, bool is_turned);

/// Returns the picture to write at `path` of what the camera sees.
DepthPicture depth_picture(const DepthFlags& flags, const std::filesystem::path& path,
                           const Camera& camera);

}  // namespace caplet::cli
