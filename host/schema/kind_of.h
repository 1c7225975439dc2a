// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <algorithm>
#include <optional>
#include <string>

namespace caplet::schema {

/// Returns the enumerator of a type in `names`; no value for a type that is rendered as another.
template <class Kind, class Names>
std::optional<Kind> kind_of(const std::string& type, const Names& names) {
  const auto found = std::ranges::find(names, type);
  return found == names.end() ? std::nullopt
                              : std::optional(static_cast<Kind>(found - names.begin()));
}

}  // namespace caplet::schema
