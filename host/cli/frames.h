// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Sequences of frames: their selection, file names, and movies.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "import/import_options.h"

namespace caplet::cli {

/// The frames to render, from 1. `count`: the number of frames of a turn or a file, if known.
struct FrameRange {
  std::uint32_t first = 1, last = 1, count = 1;
};

/// Parses "A-B" or "A": integers from 1, the second not below the first. Returns no value for
/// "all". Throws InputError that names
/// --frames.
std::optional<FrameRange> parse_frames(const std::string& text);

/// Returns whether a name has a place for a number: "####" (at least so many digits) or "%d",
/// "%04d".
bool is_numbered(const std::string& name);
/// Fills in the last such place of the file name; a name without one stays as it is.
std::filesystem::path numbered(const std::filesystem::path& name, std::uint32_t number);

/// Returns whether the extension is that of a movie: .mp4, .mov, .mkv, .webm, .gif.
bool is_movie(const std::filesystem::path& path);

/// Collects pictures in a temporary folder, from which ffmpeg makes a movie.
class Movie {
 public:
  /// Throws InputError that names `flag` if ffmpeg is missing.
  Movie(std::filesystem::path path, double frames_a_second, const std::string& flag);
  ~Movie();
  Movie(const Movie&) = delete;
  Movie& operator=(const Movie&) = delete;

  /// Returns the path for the next frame's picture.
  std::filesystem::path next();
  /// Writes the movie. Throws RunError with ffmpeg's message.
  void finish();

 private:
  std::filesystem::path path_, folder_;
  double frames_a_second_;
  std::uint32_t count_ = 0;
};

}  // namespace caplet::cli
