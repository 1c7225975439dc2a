// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <optional>
#include <string_view>

namespace caplet {

/// Returns the seconds of a time such as "90", "90s", "5m", "1.5h" or "1h30m": a number alone
/// counts seconds, and units go from hours to seconds, each at most once. Empty for anything else,
/// and for times that are not positive and finite.
std::optional<double> seconds_of(std::string_view text);

}  // namespace caplet
