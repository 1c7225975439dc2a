// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The files that `caplet render` writes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "cli/render_flags.h"

namespace caplet::cli {

/// The outputs and their paths; for frames, with the place of the number. An empty path is not
/// written.
struct Files {
  std::vector<std::filesystem::path> pictures, previews;
  std::filesystem::path movie, stats, film, deep, depth;
  Outputs all;

  /// Returns the first output, which stands for all in messages.
  std::filesystem::path first() const {
    if (!pictures.empty()) return pictures.front();
    if (!previews.empty()) return previews.front();
    if (!movie.empty()) return movie;
    if (!deep.empty()) return deep;
    return !depth.empty() ? depth : !film.empty() ? film : stats;
  }
};

/// Returns them with the number of a frame filled in.
Files of_frame(const Files& files, std::uint32_t frame);

/// Returns whether all outputs of a frame exist.
bool are_there(const Files& files);

/// Adds a tone-mapped picture that `flag` names. Throws InputError for another format.
void add_preview(Files& files, const std::filesystem::path& path, const std::string& flag);

/// Adds an output of -o: a picture, a tone-mapped one or a movie. Throws InputError.
void add_output(const RenderFlags& options, Files& files, const std::filesystem::path& path);

/// Returns where the film is written; empty where it is not. Throws InputError.
std::filesystem::path film_path(const RenderFlags& options, const Files& files);

}  // namespace caplet::cli
