// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A file that OpenEXR writes.
#pragma once

#include <ImfIO.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "base/error.h"

namespace caplet {

/// CheckedFile reports every failure to write: OpenEXR's own stream ignores those of its last bytes
/// and of its table of rows.
class CheckedFile : public Imf::OStream {
 public:
  /// Opens a file. `name`: for messages.
  CheckedFile(const std::filesystem::path& path, const std::filesystem::path& name)
      : Imf::OStream(path.c_str()), name_(name), file_(std::fopen(path.c_str(), "wb")) {
    if (!file_) fail(errno);
    std::setvbuf(file_, nullptr, _IOFBF, std::size_t{1} << 20);
  }
  ~CheckedFile() override {
    if (file_) std::fclose(file_);
  }
  CheckedFile(const CheckedFile&) = delete;
  CheckedFile& operator=(const CheckedFile&) = delete;

  void write(const char* bytes, int count) override {
    if (std::fwrite(bytes, 1, static_cast<std::size_t>(count), file_) !=
        static_cast<std::size_t>(count))
      fail(errno);
  }
  std::uint64_t tellp() override {
    const long at = std::ftell(file_);
    if (at < 0) fail(errno);
    return static_cast<std::uint64_t>(at);
  }
  void seekp(std::uint64_t to) override {
    if (std::fseek(file_, static_cast<long>(to), SEEK_SET) != 0) fail(errno);
  }
  /// Closes the file. Throws for this and for any earlier failure, even one that was caught.
  void close() {
    if (std::fclose(std::exchange(file_, nullptr)) != 0 && failure_ == 0) fail(errno);
    if (failure_ != 0) fail(failure_);
  }

 private:
  [[noreturn]] void fail(int code) {
    failure_ = code;
    throw RunError(fmt::format("{}: cannot be written: {}", name_.string(), std::strerror(code)));
  }
  std::filesystem::path name_;
  std::FILE* file_;
  int failure_ = 0;
};

}  // namespace caplet
