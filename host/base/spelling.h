// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// How names are written, and what was meant by one that is not known.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace caplet {

/// The known name with the smallest edit distance; empty if there is none. Takes time by the number of names: pointless for an
/// error that is not shown (Diagnostics::is_full).
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);

/// A to Z as a to z; other bytes stay.
std::string lower_case(std::string text);

}  // namespace caplet
