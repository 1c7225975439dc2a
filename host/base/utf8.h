// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Text from files and file systems is bytes; JSON, EXR headers, Python and pages take UTF-8 alone.
#pragma once

#include <string>
#include <string_view>

namespace caplet {

/// What stands for bytes that are no UTF-8.
inline constexpr char32_t replacement_character = 0xfffd;

/// Takes the first character off `text`, which is not empty. Where there is none, the longest part of a sequence that could have
/// been one goes as a replacement_character, as the Unicode Standard recommends (version 15, section 3.9, "U+FFFD Substitution of
/// Maximal Subparts"): of lone continuations, overlong forms, surrogates, what is beyond U+10FFFF and what is cut off.
char32_t take_character(std::string_view& text);

/// `text` with a replacement_character where it is no UTF-8.
std::string valid_utf8(std::string_view text);

/// valid_utf8 with a blank in place of each control character (C0, DEL, C1): what breaks no line and moves no terminal's cursor.
std::string one_line(std::string_view text);

/// The text of a value of nlohmann's JSON, in which broken UTF-8 is as valid_utf8 has it: dump() alone throws for that. All JSON
/// of the program is written by this. `indent` -1: on one line. A template, for most that include this know nothing of JSON.
template <class Json>
std::string json_dump(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace caplet
