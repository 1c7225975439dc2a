// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads lists of rays from files piece by piece: text of six numbers per line, or .npy.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "table/npy.h"

namespace caplet {

/// Origin, then direction (of any length).
using RayNumbers = std::array<float, 6>;

/// A ray of a list. Only hits from t_min to before t_max count, in lengths of the direction.
struct ListedRay {
  RayNumbers numbers{};
  float t_min = 0, t_max = std::numeric_limits<float>::infinity();
};

/// Squares of larger coordinates, and of directions longer than this or shorter than its inverse,
/// do not fit into floats.
inline constexpr double largest_ray_number = 0x1p60;  // 1.15e18

/// Returns the six numbers as floats. Otherwise returns the error (not finite, too large, no
/// direction) and the number's index.
struct BadRay {
  std::size_t number;  // 0..5
  std::string message;
};
std::optional<BadRay> to_ray(const std::array<double, 6>& numbers, RayNumbers& ray);

/// Parses a whole token as a number in decimal notation; a leading '+' is allowed. Otherwise
/// returns the error.
std::optional<std::string> parse_number(std::string_view token, double& value);

/// Reads .npy by extension (rows of six or eight numbers, NpyReader), else text: six or eight
/// numbers per line, separated by blanks or commas; `#` starts a comment, blank lines are skipped.
/// The seventh and eighth are t_min, from 0, and t_max, above it or `inf`. "-" is the standard
/// input, as text.
class RayFile {
 public:
  /// Throws InputError when the file is missing, unreadable or not such a list.
  explicit RayFile(const std::filesystem::path& path);

  /// Returns up to `most` more rays; fewer only at the end. Throws InputError with every bad ray
  /// among them, up to 20, with line and column or, in a .npy file, its row.
  std::vector<ListedRay> next(std::size_t most);

 private:
  std::vector<ListedRay> next_rows(std::size_t most);
  std::optional<std::string_view> take_line();
  std::optional<ListedRay> parse_line(std::string_view line, Diagnostics& diagnostics) const;

  std::filesystem::path path_;
  std::optional<NpyReader> npy_;
  std::uint64_t row_ = 0;  // of the .npy file, the next one
  std::ifstream text_;
  std::string buffer_;
  std::size_t at_ = 0;  // in buffer_
  int line_ = 0;
};

}  // namespace caplet
