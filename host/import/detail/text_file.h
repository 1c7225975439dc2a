// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Helpers of line-based text formats: a whole file in memory, its lines, and numbers in them.
#pragma once

#include <charconv>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace caplet {

/// The limit in bytes exceeds the text of the most capsules that device data can hold
/// (host/lower/encode.h).
inline constexpr std::size_t longest_text_file = std::size_t{1} << 34;

/// Holds the bytes of a regular file. Throws InputError when it is missing, no regular file,
/// unreadable or longer than longest_text_file.
class TextFile {
 public:
  explicit TextFile(const std::filesystem::path& path);
  std::string_view text() const { return {data_.get(), size_}; }

 private:
  std::unique_ptr<char[]> data_;
  std::size_t size_ = 0;
};

/// Removes and returns the next line of `text`, without its end ("\n", "\r\n" or "\r").
std::string_view take_line(std::string_view& text);

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

/// Removes the blanks at both ends.
std::string_view trimmed(std::string_view text);

/// Splits a line at blanks.
std::vector<std::string_view> words_of(std::string_view line);

/// Returns whether the whole of `token` is a number of this type for std::from_chars; if so, it is
/// stored in `value`.
template <class Number>
bool parse_number(std::string_view token, Number& value) {
  const char* end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, value);
  return error == std::errc() && stop == end;
}

/// Why a number was refused; empty: it was not.
enum class NumberError { none, not_a_number, not_finite, out_of_range };

/// The greatest number in a file without a camera: with every point and radius within it, the
/// camera that sees all of them stands within largest_length (scene.h) of the origin.
inline constexpr float largest_number = 1e16F;

/// Reads the float nearest to the whole of `token` (decimal notation, a leading '+' allowed).
/// Underflow becomes 0, and numbers beyond largest_number are out of range.
NumberError parse_float(std::string_view token, float& value);

/// Quotes `token` for a message: shortened, unprintable bytes as \xNN; hidden if the file is
/// unproven (base/quotes.h).
std::string quoted(std::string_view token);

/// Returns "'abc' is not a number" and the like, for a token that parse_float refused.
std::string describe(NumberError error, std::string_view token);

}  // namespace caplet
