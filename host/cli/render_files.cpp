// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/render_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "base/error.h"
#include "cli/frames.h"
#include "cli/options.h"
#include "film/image.h"

namespace caplet::cli {

namespace fs = std::filesystem;

Files of_frame(const Files& files, std::uint32_t frame) {
  Files out;
  for (const fs::path& path : files.pictures) out.pictures.push_back(numbered(path, frame));
  for (const fs::path& path : files.previews) out.previews.push_back(numbered(path, frame));
  if (!files.deep.empty()) out.deep = numbered(files.deep, frame);
  if (!files.depth.empty()) out.depth = numbered(files.depth, frame);
  return out;
}

bool are_there(const Files& files) {
  std::error_code ignored;
  const auto exists = [&](const std::filesystem::path& path) {
    return std::filesystem::is_regular_file(path, ignored);
  };
  return std::ranges::all_of(files.pictures, exists) &&
         std::ranges::all_of(files.previews, exists) &&
         (files.deep.empty() || exists(files.deep)) && (files.depth.empty() || exists(files.depth));
}

void add_preview(Files& files, const fs::path& path, const std::string& flag) {
  check_preview_format(path, flag);
  files.previews.push_back(path);
  files.all.add(flag, path);
}

void add_output(const RenderFlags& options, Files& files, const fs::path& path) {
  if (is_stream(path) || path.extension() == ".exr") {
    files.pictures.push_back(path);
    files.all.add("-o", path);
  } else if (is_movie(path) && (options.has_frames() || path.extension() != ".gif")) {
    if (!options.has_frames())
      throw InputError(
          SourceLocation{"-o"},
          fmt::format("'{}': a movie goes with --turntable, --frames, --poses or --play",
                      path.string()));
    if (!files.movie.empty())
      throw InputError(SourceLocation{"-o"}, "one movie at a time is written");
    check_preview_format("frame.png", "-o");
    files.movie = path;
    files.all.add("-o", path);
  } else {
    files.all.add("-o", path);
    try {
      check_preview_format(path, "-o");
    } catch (const InputError& error) {
      throw InputError(SourceLocation{"-o"},
                       fmt::format("'{}': pictures are written as .exr, and tone-mapped as .png, "
                                   ".jpg and the like; movies of "
                                   "frames as .mp4, .mov, .mkv, .webm or .gif",
                                   path.string()));
    }
    files.previews.push_back(path);
  }
}

fs::path film_path(const RenderFlags& options, const Files& files) {
  if (!options.film.keeps()) return {};
  if (!options.film.film.empty()) return output_named(options.film.film);
  fs::path path = files.first();
  if (path.empty() || is_stream(path))
    throw InputError(SourceLocation{options.film.resume ? "--resume" : "--checkpoint"},
                     "--film FILE tells where the film is");
  return path.replace_extension(".film");
}

}  // namespace caplet::cli
