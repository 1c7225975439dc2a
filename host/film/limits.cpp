// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/detail/limits.h"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>

#include "base/error.h"
#include "base/reading.h"
#include "scene/film.h"

namespace caplet {

namespace fs = std::filesystem;

std::uintmax_t readable_file_bytes(const fs::path& path) {
  begin_reading(path);
  std::error_code error;
  if (!is_there(path, {})) throw InputError(path.string() + ": no such file");
  if (!is_file(path, {})) throw InputError(path.string() + ": not a file");
  if (::access(path.c_str(), R_OK) != 0)
    throw InputError(path.string() + ": cannot be read (permission denied)");
  const std::uintmax_t bytes = fs::file_size(path, error);
  if (error) throw InputError(fmt::format("{}: {}", path.string(), error.message()));
  return bytes;
}

void check_image_size(const fs::path& path, std::int64_t width, std::int64_t height,
                      std::uint64_t bytes_per_pixel, std::uint64_t file_bytes) {
  if (width < 1 || height < 1 || width > max_image_side || height > max_image_side ||
      static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) >
          std::uint64_t{most_image_pixels})
    throw InputError(fmt::format(
        "{}: an image of {} x {} pixels is not supported (at most 2^28 in all, 2^20 a side)",
        path.string(), width, height));
  const std::uint64_t needed =
      static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) * bytes_per_pixel;
  if (needed > (std::uint64_t{64} << 20) && needed / 2048 > file_bytes)
    throw InputError(fmt::format("{}: claims {} x {} pixels, more than a file of its size can hold",
                                 path.string(), width, height));
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace caplet
