// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A file as memory: its pages are read when they are touched.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace caplet {

/// Maps a regular file for reading. What is written to the memory stays within the process. A file
/// that is cut short meanwhile ends the process with SIGBUS at the first page that is missing.
class MappedFile {
 public:
  /// Throws InputError when it is missing, no regular file or unreadable.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  /// Begins at a page.
  std::string_view bytes() const { return {begin_, size_}; }

 private:
  const char* begin_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace caplet
