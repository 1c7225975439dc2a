// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Chooses which library reads or writes an image file.
#include "film/detail/image_files.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/spelling.h"
#include "film/detail/image_module.h"
#include "film/detail/image_png.h"
#include "film/detail/limits.h"

namespace caplet::image_files {

namespace fs = std::filesystem;

namespace {

bool is_named_png(const fs::path& path) { return lower_case(path.extension().string()) == ".png"; }

/// Reads by libpng a file that begins as a PNG file does, and others by the module.
template <class Out>
Out read(const fs::path& path,
         std::string (*Module::*from_module)(const fs::path&, const SizeCheck&, Out&),
         std::string (*from_png)(const fs::path&, const SizeCheck&, Out&)) {
  const std::uintmax_t file_bytes = readable_file_bytes(path);
  const SizeCheck check = [&](int width, int height, std::uint64_t bytes_per_pixel) {
    check_image_size(path, width, height, bytes_per_pixel, file_bytes);
  };
  Out out;
  const std::string why =
      is_png(path) ? from_png(path, check, out) : (module_for(path).*from_module)(path, check, out);
  if (!why.empty()) throw InputError(fmt::format("{}: {}", path.string(), why));
  return out;
}

}  // namespace

Pixels read_linear(const fs::path& path) {
  return read<Pixels>(path, &Module::read_linear, &read_png_linear);
}

StoredPixels read_stored(const fs::path& path) {
  return read<StoredPixels>(path, &Module::read_stored, &read_png_stored);
}

bool can_write(const fs::path& path) {
  if (is_named_png(path)) return true;
  return available() && !path.extension().empty() && module_for(path).can_write(path);
}

bool can_hold(const fs::path& path, int width, int height) {
  if (is_named_png(path)) return width <= max_png_side && height <= max_png_side;
  bool out = false;
  const std::string why = module_for(path).can_hold(path, width, height, out);
  if (!why.empty()) throw RunError(fmt::format("{}: {}", path.string(), why));
  return out;
}

bool can_write_alpha(const fs::path& path) {
  return is_named_png(path) || (available() && module_for(path).can_write_alpha(path));
}

std::string encode_8bit(const fs::path& path, int width, int height, int channels,
                        const std::vector<std::uint8_t>& values) {
  std::string out;
  const std::string why =
      is_named_png(path) ? encode_png(width, height, channels, values, out)
                         : module_for(path).encode_8bit(path, width, height, channels, values, out);
  if (!why.empty()) throw RunError(fmt::format("{}: {}", path.string(), why));
  return out;
}

}  // namespace caplet::image_files
