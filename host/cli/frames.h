// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pictures that follow each other: which, what their files are called, and a movie of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "import/import_options.h"

namespace caplet::cli {

/// Which frames are made, from 1; `count`: how many there are (of a turn, of a file), where that is known.
struct FrameRange {
  std::uint32_t first = 1, last = 1, count = 1;
};

/// "A-B", or "A": whole numbers from 1, the second not below the first. None where it is "all". Throws InputError naming
/// --frames.
std::optional<FrameRange> parse_frames(const std::string& text);

/// Whether a name has a place for a number: "####" (so many digits at least) or "%d", "%04d".
bool is_numbered(const std::string& name);
/// The last such place of its file name filled in; without one the name as it is.
std::filesystem::path numbered(const std::filesystem::path& name, std::uint32_t number);

/// Whether a name is one of a movie: .mp4, .mov, .mkv, .webm, .gif.
bool is_movie(const std::filesystem::path& path);

/// Pictures in a folder of their own until ffmpeg makes one file of them.
class Movie {
 public:
  /// Throws InputError naming `flag` where there is no ffmpeg.
  Movie(std::filesystem::path path, double frames_a_second, const std::string& flag);
  ~Movie();
  Movie(const Movie&) = delete;
  Movie& operator=(const Movie&) = delete;

  /// Where the next frame's picture is to be written.
  std::filesystem::path next();
  /// Writes the movie. Throws RunError with what ffmpeg says.
  void finish();

 private:
  std::filesystem::path path_, folder_;
  double frames_a_second_;
  std::uint32_t count_ = 0;
};

}  // namespace caplet::cli
