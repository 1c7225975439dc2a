// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "post/overlay_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <string_view>
#include <system_error>
#include <variant>

#include "base/error.h"
#include "base/spelling.h"

namespace caplet::post {

namespace {

/// A row sets one member: a length or "auto", a number from `low` to `high`, a switch, or labels.
struct Row {
  const char *name, *values, *help;
  std::variant<decltype(&Overlays::scale_bar), decltype(&Overlays::outline),
               decltype(&Overlays::axes), decltype(&Overlays::labels)>
      member;
  double usual = 0, low = 0, high = 0;  // of a number
};

constexpr Row rows[] = {
    {"scale-bar", "auto|LENGTH",
     "A scale bar: auto, or its length, such as \"50 um\"; true everywhere in orthographic "
     "pictures, in others at the middle",
     &Overlays::scale_bar},
    {"outline", "PIXELS",
     "Black lines around objects and where one part stands before another; their width",
     &Overlays::outline, 1.5, 0.1, 64},
    {"depth-cue", "SHARE", "What is further fades into the background; by how much the farthest",
     &Overlays::depth_cue, 0.6, 0, 1},
    {"axes", "", "The file's axes, x red, y green, z blue", &Overlays::axes},
    {"color-bar", "", "What the colours tell, where they tell a number", &Overlays::color_bar},
    {"label", "X,Y,Z WORDS",
     "Words at a point of the world, with a line to it; several between semicolons or by "
     "repetition",
     &Overlays::labels},
};

double number_of(const std::string& text, const Row& row, const std::string& flag) {
  if (text.empty()) return row.usual;
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || at != end || !(value >= row.low && value <= row.high))
    throw InputError(SourceLocation{flag},
                     fmt::format("'{}' is no number from {} to {}", text, row.low, row.high));
  return value;
}

}  // namespace

const std::vector<OverlayRow>& overlay_rows() {
  static const std::vector<OverlayRow> all = [] {
    std::vector<OverlayRow> out;
    for (const Row& row : rows)
      out.push_back({row.name, row.values,
                     row.usual != 0 ? fmt::format("{} ({})", row.help, row.usual) : row.help,
                     std::holds_alternative<decltype(&Overlays::labels)>(row.member)});
    return out;
  }();
  return all;
}

void set_overlay(Overlays& overlays, const std::string& name, const std::string& value,
                 const std::string& flag) {
  const auto* const row = std::ranges::find(
      rows, std::string_view(name), [](const Row& one) { return std::string_view(one.name); });
  if (row == std::end(rows)) {
    std::vector<std::string> names;
    for (const OverlayRow& one : overlay_rows()) names.push_back(one.name);
    throw InputError(fmt::format("there is no overlay '{}'; the nearest is '{}'", name,
                                 nearest_name(name, names)));
  }
  if (const auto* length = std::get_if<0>(&row->member)) {
    overlays.*(*length) = parse_scale_bar(value == "auto" ? std::string() : value, flag);
  } else if (const auto* number = std::get_if<1>(&row->member)) {
    overlays.*(*number) = number_of(value, *row, flag);
  } else if (const auto* labels = std::get_if<3>(&row->member)) {
    overlays.*(*labels) = parse_labels(value, flag);
  } else {
    if (!value.empty())
      throw InputError(SourceLocation{flag}, fmt::format("'{}': it is a switch", value));
    overlays.*std::get<2>(row->member) = true;
  }
}

}  // namespace caplet::post
