// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "post/labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "base/error.h"
#include "present/picture_options.h"

namespace caplet::post {

namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/// Parses "X,Y,Z WORDS"; no value for anything else.
std::optional<Label> label_of(std::string_view text) {
  const std::size_t space = std::min(text.find(' '), text.size());
  const auto at = three_numbers(text.substr(0, space));
  const std::string_view words = trimmed(text.substr(space));
  if (!at || words.empty()) return std::nullopt;
  return Label{*at, std::string(words)};
}

}  // namespace

std::vector<Label> parse_labels(std::string_view text, const std::string& flag) {
  std::vector<Label> out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\n;"), text.size());
    const std::string_view one = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (one.empty()) continue;
    auto label = label_of(one);
    if (!label) throw InputError(SourceLocation{flag}, fmt::format("'{}' is not X,Y,Z WORDS", one));
    out.push_back(*std::move(label));
  }
  if (out.empty()) throw InputError(SourceLocation{flag}, "is not X,Y,Z WORDS");
  return out;
}

}  // namespace caplet::post
