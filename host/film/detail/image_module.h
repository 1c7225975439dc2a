// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is the interface of the module caplet_images.so, which reads and writes image files by
// OpenImageIO. It is loaded for the first such file: OpenImageIO depends on some 250 shared
// libraries, which would slow every start of the program.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "film/detail/image_pixels.h"

namespace caplet::image_files {

/// The module's function caplet_image_module returns this. Program and module are of one build
/// (`version`). Functions that return a text return the error, without the file's name, or nothing;
/// they throw what `SizeCheck` throws and nothing else.
struct Module {
  static constexpr std::uint32_t current = 1;
  std::uint32_t version;
  std::string (*read_linear)(const std::filesystem::path& path, const SizeCheck& check,
                             Pixels& out);
  std::string (*read_stored)(const std::filesystem::path& path, const SizeCheck& check,
                             StoredPixels& out);
  bool (*can_write)(const std::filesystem::path& path);
  std::string (*can_hold)(const std::filesystem::path& path, int width, int height, bool& out);
  bool (*can_write_alpha)(const std::filesystem::path& path);
  std::string (*encode_8bit)(const std::filesystem::path& path, int width, int height, int channels,
                             const std::vector<std::uint8_t>& values, std::string& out);
};

/// Returns whether the build has the module: files other than EXR and PNG can be read and written.
bool available();
/// Returns the module, loaded at the first call. Throws RunError naming the file where it is
/// missing, and InputError where the build is without OpenImageIO. It is thread-safe.
const Module& module_for(const std::filesystem::path& path);

}  // namespace caplet::image_files
