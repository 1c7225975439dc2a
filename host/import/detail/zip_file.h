// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Zip archives: 3MF packages, TRX.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace caplet {

/// The files of an archive, read whole, one at a time. All of it throws InputError, for what is no archive, is broken, encrypted,
/// or packed in other ways than deflate, and when what was read is more than most_unpacked of the archive.
class ZipFile {
 public:
  explicit ZipFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  const std::vector<std::string>& names() const { return names_; }
  /// The archive's own spelling of a name, whose ASCII letters may be of either case.
  std::optional<std::string> find(std::string_view name) const;
  /// The bytes of one of names().
  std::string read(const std::string& name);

 private:
  [[noreturn]] void fail(const std::string& message) const;

  std::filesystem::path path_;
  std::shared_ptr<void> file_;
  std::vector<std::string> names_;
  std::uintmax_t left_ = 0;  // of what may be unpacked
};

}  // namespace caplet
