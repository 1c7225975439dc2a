// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>

#include "base/error.h"

namespace caplet {

namespace fs = std::filesystem;

namespace {

fs::path folder_of(const fs::path& target) { return target.has_parent_path() ? target.parent_path() : fs::path("."); }

}  // namespace

void write_atomically(const fs::path& target, const std::function<void(const fs::path&)>& write) {
  static int serial = 0;
  const fs::path temporary = folder_of(target) / fmt::format(".{}.{}.{}.part{}", target.stem().string(), ::getpid(), serial++,
                                                             target.extension().string());
  std::error_code error;
  try {
    write(temporary);
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
  fs::rename(temporary, target, error);
  if (error) {
    const std::string why = error.message();
    fs::remove(temporary, error);
    throw RunError(fmt::format("{}: cannot be replaced: {}", target.string(), why));
  }
}

void check_writable(const fs::path& target, const std::string& flag) {
  std::error_code error;
  const fs::path folder = folder_of(target);
  if (!target.has_filename()) throw InputError(SourceLocation{flag}, fmt::format("'{}' names no file", target.string()));
  if (!fs::is_directory(folder, error))
    throw InputError(SourceLocation{flag}, fmt::format("folder '{}' does not exist", folder.string()));
  if (fs::is_directory(target, error)) throw InputError(SourceLocation{flag}, fmt::format("'{}' is a folder", target.string()));
  if (::access(folder.c_str(), W_OK) != 0)
    throw InputError(SourceLocation{flag}, fmt::format("folder '{}' cannot be written", folder.string()));
}

}  // namespace caplet
