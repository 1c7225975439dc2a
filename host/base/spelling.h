// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Spelling of names, and suggestions for unknown ones.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace caplet {

/// Returns the known name with the smallest edit distance; empty if there is none. The time grows
/// with the number of names, so skip it for an error that is not shown (Diagnostics::is_full).
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);

/// Returns "'NAME' is none of: A, B, C; the nearest is 'B'". What a file says may have to be hidden
/// (base/quotes.h): this is for options.
std::string none_of(std::string_view name, const std::vector<std::string>& known);

/// Converts A to Z to lower case; other bytes stay.
std::string lower_case(std::string text);

}  // namespace caplet
