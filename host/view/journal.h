// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Lines of text in a file that is only appended to, so that a process that is killed leaves all that it had written.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace caplet::view {

/// Each line has a check over itself and all lines before it (RFC 9923): what is torn, altered or out of its order ends what is
/// believed of a file. Only for the user who writes it (mode 0600).
class Journal {
 public:
  Journal() = default;
  ~Journal() { close(); }
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Replaces the file by these lines. False when that cannot be; errno says why.
  bool begin(const std::filesystem::path& file, const std::vector<std::string>& lines);
  /// False when not all of it could be written: then nothing is, and the journal is closed.
  bool append(std::string_view line);
  bool is_open() const { return descriptor_ >= 0; }
  void close();

  /// The lines of a file that are whole, in their order; none of one that is not there. At most `most_journal_bytes` are read.
  static std::vector<std::string> read(const std::filesystem::path& file);

 private:
  int descriptor_ = -1;
  std::string check_;
};

inline constexpr std::size_t most_journal_bytes = std::size_t{1} << 30;

/// 32 hexadecimal digits of what the file holds, read piece by piece; empty when it cannot be read.
std::string file_hash(const std::filesystem::path& file);

}  // namespace caplet::view
