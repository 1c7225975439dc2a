// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Zip archives, for 3MF packages and TRX.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace caplet {

/// Reads whole files of an archive, one at a time. All functions throw InputError for a file that
/// is no archive, is broken, encrypted or packed other than by deflate, and when more than
/// most_unpacked of the archive was read.
class ZipFile {
 public:
  explicit ZipFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  const std::vector<std::string>& names() const { return names_; }
  /// Finds the archive's own spelling of a name; the case of ASCII letters is ignored.
  std::optional<std::string> find(std::string_view name) const;
  /// Returns the bytes of one of names().
  std::string read(const std::string& name);

 private:
  [[noreturn]] void fail(const std::string& message) const;

  std::filesystem::path path_;
  std::shared_ptr<void> file_;
  std::vector<std::string> names_;
  std::uintmax_t left_ = 0;  // the bytes that may still be unpacked
};

}  // namespace caplet
