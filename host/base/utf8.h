// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Text from files and file systems is bytes, but JSON, EXR headers, Python and pages accept only
// UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace caplet {

/// This replaces bytes that are not valid UTF-8.
inline constexpr char32_t replacement_character = 0xfffd;

/// Takes the first character off `text`, which must not be empty. Invalid bytes become a
/// replacement_character per maximal subpart of a sequence, as the Unicode Standard recommends
/// (version 15, section 3.9, "U+FFFD Substitution of Maximal Subparts"): lone continuations,
/// overlong forms, surrogates, values beyond U+10FFFF and truncated sequences.
char32_t take_character(std::string_view& text);

/// Replaces invalid UTF-8 in `text` by replacement_character.
std::string valid_utf8(std::string_view text);

/// Returns valid_utf8 with control characters (C0, DEL, C1) as blanks: they neither break lines nor
/// move a terminal's cursor.
std::string one_line(std::string_view text);

/// Returns the text of an nlohmann JSON value with invalid UTF-8 replaced as in valid_utf8; dump()
/// throws for that. The program writes all JSON with this. `indent` -1: one line. It is a template
/// because most includers do not use JSON.
template <class Json>
std::string json_dump(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace caplet
