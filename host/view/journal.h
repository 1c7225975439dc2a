// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// An append-only file of lines: a killed process loses nothing that it has written.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace caplet::view {

/// Each line has a checksum over itself and all lines before it (RFC 9923). Reading stops at the
/// first torn, altered or misplaced line. Only the user can read the file (mode 0600).
class Journal {
 public:
  Journal() = default;
  ~Journal() { close(); }
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Replaces the file by these lines. Returns false on failure; errno says why.
  bool begin(const std::filesystem::path& file, const std::vector<std::string>& lines);
  /// Returns false if the line could not be written completely: it is then removed, and the journal
  /// is closed.
  bool append(std::string_view line);
  bool is_open() const { return descriptor_ >= 0; }
  void close();

  /// Returns the intact lines in order; none if the file does not exist. At most
  /// `most_journal_bytes` are read.
  static std::vector<std::string> read(const std::filesystem::path& file);

 private:
  int descriptor_ = -1;
  std::string check_;
};

inline constexpr std::size_t most_journal_bytes = std::size_t{1} << 30;

/// Returns a hash of the file's content as 32 hexadecimal digits, read in pieces; empty if it
/// cannot be read.
std::string file_hash(const std::filesystem::path& file);

}  // namespace caplet::view
