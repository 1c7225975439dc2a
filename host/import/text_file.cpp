// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/text_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "base/quotes.h"
#include "base/reading.h"

namespace caplet {

namespace {

[[noreturn]] void cannot_read(const std::filesystem::path& path, const char* reason) {
  throw InputError({path.string(), 0, 0}, fmt::format("cannot read: {}", reason));
}

struct Descriptor {
  int number;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

}  // namespace

TextFile::TextFile(const std::filesystem::path& path) {
  begin_reading(path);
  // O_NONBLOCK: opening a fifo must not wait for a writer; fifos are refused below.
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (file.number < 0) cannot_read(path, std::strerror(errno));
  struct stat status {};
  if (::fstat(file.number, &status) != 0) cannot_read(path, std::strerror(errno));
  if (!S_ISREG(status.st_mode))
    cannot_read(path, S_ISDIR(status.st_mode) ? "it is a folder" : "it is not a regular file");
  const auto expected = static_cast<std::size_t>(status.st_size);
  if (expected > longest_text_file) cannot_read(path, "it is longer than 16 GiB");
  data_ = std::make_unique_for_overwrite<char[]>(expected);
  while (size_ < expected) {
    const ssize_t count = ::read(file.number, data_.get() + size_, expected - size_);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) cannot_read(path, std::strerror(errno));
    if (count == 0) break;
    size_ += static_cast<std::size_t>(count);
  }
}

std::string_view take_line(std::string_view& text) {
  const std::size_t newline = text.find('\n');
  std::string_view line = text.substr(0, newline);
  const std::size_t carriage_return = line.find('\r');
  if (carriage_return == std::string_view::npos) {
    text.remove_prefix(newline == std::string_view::npos ? text.size() : newline + 1);
    return line;
  }
  const bool pair = carriage_return + 1 == line.size() && newline != std::string_view::npos;
  text.remove_prefix(carriage_return + (pair ? 2 : 1));
  return line.substr(0, carriage_return);
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> out;
  std::size_t i = 0;
  for (;;) {
    while (i < line.size() && is_blank(line[i])) ++i;
    if (i == line.size()) return out;
    const std::size_t begin = i;
    while (i < line.size() && !is_blank(line[i])) ++i;
    out.push_back(line.substr(begin, i - begin));
  }
}

NumberError parse_float(std::string_view token, float& value) {
  const bool plus = token.size() > 1 && token[0] == '+' && token[1] != '-';
  const char* begin = token.data() + (plus ? 1 : 0);
  const char* end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (stop != end || error == std::errc::invalid_argument) return NumberError::not_a_number;
  if (error == std::errc()) {
    if (!std::isfinite(value)) return NumberError::not_finite;
    return std::abs(value) <= largest_number ? NumberError::none : NumberError::out_of_range;
  }
  // from_chars reports overflow and underflow alike; strtod distinguishes them.
  if (std::abs(std::strtod(std::string(begin, end).c_str(), nullptr)) > 1)
    return NumberError::out_of_range;
  value = 0;
  return NumberError::none;
}

std::string quoted(std::string_view token) {
  constexpr std::size_t kLongest = 32;
  if (!may_quote()) return std::string("'") + withheld + "'";
  std::string out = "'";
  for (const char c : token.substr(0, kLongest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte >= 0x7f)
      out += fmt::format("\\x{:02x}", byte);
    else
      out += c;
  }
  return out + (token.size() > kLongest ? "...'" : "'");
}

std::string describe(NumberError error, std::string_view token) {
  switch (error) {
    case NumberError::not_finite:
      return fmt::format("{} is not finite", quoted(token));
    case NumberError::out_of_range:
      return fmt::format("{} is out of range (largest: {:.3g})", quoted(token), largest_number);
    default:
      return fmt::format("{} is not a number", quoted(token));
  }
}

}  // namespace caplet
