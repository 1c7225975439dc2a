// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "post/overlay_options.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <system_error>

#include "base/error.h"
#include "base/spelling.h"

namespace caplet::post {

namespace {

double number_of(const std::string& text, double usual, double low, double high, const std::string& flag) {
  if (text.empty()) return usual;
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || at != end || !(value >= low && value <= high))
    throw InputError(SourceLocation{flag}, fmt::format("'{}' is no number from {} to {}", text, low, high));
  return value;
}

}  // namespace

const std::vector<OverlayRow>& overlay_rows() {
  static const std::vector<OverlayRow> rows = {
#define OVERLAY_LENGTH(name, field, values, help) {name, values, help},
#define OVERLAY_NUMBER(name, field, usual, low, high, values, help) {name, values, fmt::format("{} ({})", help, usual)},
#define OVERLAY_SWITCH(name, field, help) {name, "", help},
#include "post/overlays.def"
#undef OVERLAY_LENGTH
#undef OVERLAY_NUMBER
#undef OVERLAY_SWITCH
  };
  return rows;
}

void set_overlay(Overlays& overlays, const std::string& name, const std::string& value, const std::string& flag) {
#define OVERLAY_LENGTH(known, field, values, help)                                   \
  if (name == (known)) {                                                             \
    overlays.field = parse_scale_bar(value == "auto" ? std::string() : value, flag); \
    return;                                                                          \
  }
#define OVERLAY_NUMBER(known, field, usual, low, high, values, help) \
  if (name == (known)) {                                             \
    overlays.field = number_of(value, usual, low, high, flag);       \
    return;                                                          \
  }
#define OVERLAY_SWITCH(known, field, help)                                                                  \
  if (name == (known)) {                                                                                    \
    if (!value.empty()) throw InputError(SourceLocation{flag}, fmt::format("'{}': it is a switch", value)); \
    overlays.field = true;                                                                                  \
    return;                                                                                                 \
  }
#include "post/overlays.def"
#undef OVERLAY_LENGTH
#undef OVERLAY_NUMBER
#undef OVERLAY_SWITCH
  std::vector<std::string> names;
  for (const OverlayRow& row : overlay_rows()) names.push_back(row.name);
  throw InputError(fmt::format("there is no overlay '{}'; the nearest is '{}'", name, nearest_name(name, names)));
}

}  // namespace caplet::post
