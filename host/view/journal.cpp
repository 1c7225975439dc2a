// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/journal.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <utility>

#include "base/content_hash.h"

namespace caplet::view {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t check_length = 16;

std::string check_of(const std::string& before, std::string_view line) {
  return content_hash(before + std::string(line)).substr(0, check_length);
}

bool write_all(int to, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(to, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

bool Journal::begin(const fs::path& file, const std::vector<std::string>& lines) {
  close();
  check_.clear();
  std::string text;
  for (const std::string& line : lines) {
    check_ = check_of(check_, line);
    text += check_ + " " + line + "\n";
  }
  // The old file stays until the new one is complete.
  const fs::path fresh = file.string() + ".new";
  std::error_code ignored;
  fs::remove(fresh, ignored);
  descriptor_ = ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0600);
  if (descriptor_ >= 0 && write_all(descriptor_, text) &&
      ::rename(fresh.c_str(), file.c_str()) == 0)
    return true;
  const int why = errno;
  if (descriptor_ >= 0) fs::remove(fresh, ignored);
  close();
  errno = why;
  return false;
}

bool Journal::append(std::string_view line) {
  if (descriptor_ < 0) return false;
  const off_t end = ::lseek(descriptor_, 0, SEEK_END);
  std::string check = check_of(check_, line);
  if (write_all(descriptor_, check + " " + std::string(line) + "\n")) {
    check_ = std::move(check);
    return true;
  }
  const int why = errno;
  if (end >= 0 && ::ftruncate(descriptor_, end) != 0) errno = why;
  close();
  errno = why;
  return false;
}

void Journal::close() {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
}

std::vector<std::string> Journal::read(const fs::path& file) {
  std::vector<std::string> out;
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return out;
  std::ifstream in(file, std::ios::binary);
  std::string line, check;
  std::size_t bytes = 0;
  while (std::getline(in, line) && !in.eof()) {  // a last line without its end is incomplete
    bytes += line.size();
    if (bytes > most_journal_bytes || line.size() <= check_length || line[check_length] != ' ')
      break;
    std::string text = line.substr(check_length + 1);
    std::string wanted = check_of(check, text);
    if (std::string_view(line).substr(0, check_length) != wanted) break;
    check = std::move(wanted);
    out.push_back(std::move(text));
  }
  return out;
}

std::string file_hash(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return {};
  std::ifstream in(file, std::ios::binary);
  if (!in) return {};
  std::string piece(std::size_t{1} << 22, '\0'), hashes;
  while (in) {
    in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    hashes +=
        content_hash(std::string_view(piece).substr(0, static_cast<std::size_t>(in.gcount())));
  }
  return in.bad() ? std::string() : content_hash(hashes);
}

}  // namespace caplet::view
