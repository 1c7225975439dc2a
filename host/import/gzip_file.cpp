// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/gzip_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <system_error>

#include "base/reading.h"

namespace caplet {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const SourceLocation& where, const fs::path& path, const std::string& what) {
  if (where.file.empty()) throw InputError(SourceLocation{path.string()}, what);
  throw InputError(where, path.string() + ": " + what);
}

}  // namespace

std::uintmax_t most_unpacked(std::uintmax_t size) {
  return std::max<std::uintmax_t>(std::uintmax_t{1} << 26, 100 * size);
}

std::string read_file(const fs::path& path, const SourceLocation& where, std::size_t limit) {
  begin_reading(path, where);
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) fail(where, path, "no such file");
  if (fs::is_directory(status)) fail(where, path, "is a folder, not a file");
  if (!fs::is_regular_file(status)) fail(where, path, "is no regular file");
  struct Close {
    void operator()(gzFile file) const { gzclose(file); }
  };
  const auto size = fs::file_size(path, error);
  const std::unique_ptr<gzFile_s, Close> file(gzopen(path.c_str(), "rb"));
  if (!file) fail(where, path, "cannot be read");
  if (error) fail(where, path, "cannot be read (" + error.message() + ")");
  gzbuffer(file.get(), 1 << 18);
  std::string bytes;
  if (gzdirect(file.get()) && size > limit)
    fail(where, path, fmt::format("is longer than {} bytes", limit));
  const std::size_t most =
      gzdirect(file.get()) ? limit : std::min<std::uintmax_t>(limit, most_unpacked(size));
  if (size < limit) bytes.reserve(size + 1);
  // The buffer is a byte larger than the file, so that the second read finds its end; packed files
  // take as much at a time.
  const auto chunk = static_cast<unsigned>(std::clamp<std::uintmax_t>(size + 1, 1 << 12, 1 << 20));
  for (;;) {
    const std::size_t before = bytes.size();
    if (bytes.capacity() < before + chunk)
      bytes.reserve(std::max(before + chunk, std::min(2 * before, most + chunk)));
    bytes.resize(before + chunk);
    const int got = gzread(file.get(), bytes.data() + before, chunk);
    bytes.resize(before + static_cast<std::size_t>(got > 0 ? got : 0));
    int code = Z_OK;
    gzerror(file.get(), &code);
    if (got < 0 || (code != Z_OK && code != Z_STREAM_END))
      fail(where, path,
           code == Z_BUF_ERROR ? "the gzip data is truncated"
                               : "cannot be read (broken gzip data or a read error)");
    if (bytes.size() > most && most < limit)
      fail(
          where, path,
          fmt::format(
              "unpacks to more than {} bytes, {} times its own size: no text or mesh packs so well",
              most, most / size));
    if (bytes.size() > most) fail(where, path, fmt::format("is longer than {} bytes", limit));
    if (got == 0) return bytes;
  }
}

void check_text(const std::string& text, const std::string& file) {
  constexpr std::size_t block = 256;  // the compiler vectorises the test of a block
  for (std::size_t i = 0; i < text.size(); ++i) {
    for (; i + block <= text.size(); i += block) {
      unsigned bad = 0;
      for (std::size_t k = 0; k < block; ++k) {
        const auto byte = static_cast<unsigned char>(text[i + k]);
        bad |= static_cast<unsigned>(byte < '\t') |
               (static_cast<unsigned>(byte > '\r') & static_cast<unsigned>(byte < 32));
      }
      if (bad != 0) break;
    }
    if (i == text.size()) return;
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte >= 32 || (byte >= '\t' && byte <= '\r')) continue;
    if (byte == 0 && text.find_first_not_of('\0', i) == std::string::npos) return;
    int line = 1;
    std::size_t line_start = 0;
    for (std::size_t k = 0; k < i; ++k)
      if (text[k] == '\n') {
        ++line;
        line_start = k + 1;
      }
    throw InputError(SourceLocation{file, line, static_cast<int>(i - line_start) + 1},
                     fmt::format("this is no text (byte 0x{:02x})", byte));
  }
}

std::string read_text(const fs::path& path, const SourceLocation& where) {
  std::string text = read_file(path, where);
  check_text(text, path.string());
  while (!text.empty() && text.back() == '\0') text.pop_back();
  return text;
}

}  // namespace caplet
