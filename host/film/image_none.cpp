// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Image files other than EXR in a build without OpenImageIO: clear errors.
#include <fmt/format.h>

#include "base/error.h"
#include "film/detail/image_files.h"

namespace caplet::image_files {

namespace {

constexpr const char* reason = "this build reads and writes EXR only (built with CAPLET_WITH_OIIO=OFF)";

}  // namespace

bool available() { return false; }

Pixels read_linear(const std::filesystem::path& path) { throw InputError(fmt::format("{}: {}", path.string(), reason)); }

StoredPixels read_stored(const std::filesystem::path& path) { throw InputError(fmt::format("{}: {}", path.string(), reason)); }

bool can_write(const std::filesystem::path&) { return false; }

bool can_hold(const std::filesystem::path&, int, int) { return false; }

bool can_write_alpha(const std::filesystem::path&) { return false; }

std::string encode_8bit(const std::filesystem::path& path, int, int, int, const std::vector<std::uint8_t>&) {
  throw RunError(fmt::format("{}: {}", path.string(), reason));
}

}  // namespace caplet::image_files
