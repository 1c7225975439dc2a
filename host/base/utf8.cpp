// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/utf8.h"

#include <algorithm>
#include <cstddef>

namespace caplet {

namespace {

constexpr std::string_view replacement_text = "\xef\xbf\xbd";

/// The meaning of a first byte (Unicode 15, table 3-7): the number of further bytes, and the range
/// of the first of them.
struct Lead {
  std::size_t more = 0;  // 0: no sequence begins with it
  unsigned char low = 0x80, high = 0xbf;
};

Lead lead_of(unsigned char byte) {
  if (byte >= 0xc2 && byte <= 0xdf) return {1};
  if (byte == 0xe0) return {2, 0xa0, 0xbf};
  if (byte == 0xed) return {2, 0x80, 0x9f};
  if (byte >= 0xe1 && byte <= 0xef) return {2};
  if (byte == 0xf0) return {3, 0x90, 0xbf};
  if (byte >= 0xf1 && byte <= 0xf3) return {3};
  if (byte == 0xf4) return {3, 0x80, 0x8f};
  return {};
}

}  // namespace

char32_t take_character(std::string_view& text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  Lead lead = lead_of(first);
  const std::size_t whole = 1 + lead.more;
  char32_t out = first < 0x80 ? first : first & (0x3fu >> lead.more);
  std::size_t end = 1;
  for (; end < std::min(whole, text.size()) && byte(end) >= lead.low && byte(end) <= lead.high;
       ++end) {
    out = out << 6 | (byte(end) & 0x3fu);
    lead = {0, 0x80, 0xbf};
  }
  text.remove_prefix(end);
  return first < 0x80 || (whole > 1 && end == whole) ? out : replacement_character;
}

std::string valid_utf8(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::string_view before = text;
    const bool is_broken = take_character(text) == replacement_character;
    out += is_broken ? replacement_text : before.substr(0, before.size() - text.size());
  }
  return out;
}

std::string one_line(std::string_view text) {
  std::string out;
  const std::string valid = valid_utf8(text);
  out.reserve(valid.size());
  for (std::string_view left = valid; !left.empty();) {
    const std::string_view before = left;
    const char32_t character = take_character(left);
    const bool is_control = character < 0x20 || (character >= 0x7f && character < 0xa0);
    out += is_control ? std::string_view(" ") : before.substr(0, before.size() - left.size());
  }
  return out;
}

}  // namespace caplet
