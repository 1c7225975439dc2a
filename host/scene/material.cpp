// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/material.h"

#include <array>
#include <charconv>
#include <cmath>

namespace caplet {

namespace {

/// Returns the shortest text that parses to this number.
std::string text_of(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}  // namespace

Spectrum copper_eta() noexcept { return *named_spectrum("metal-Cu-eta"); }
Spectrum copper_k() noexcept { return *named_spectrum("metal-Cu-k"); }

std::string must_lie_within(double low, double high) {
  if (std::isinf(low) && std::isinf(high)) return "must be finite";
  if (std::isinf(high)) return "must be finite and from " + text_of(low) + " up";
  return "must lie between " + text_of(low) + " and " + text_of(high);
}

std::string must_lie_within(const Field& field) {
  if (!field.above_low) return must_lie_within(field.low, field.high);
  if (std::isinf(field.high))
    return field.low == 0 ? "must be positive" : "must be above " + text_of(field.low);
  return "must be above " + text_of(field.low) + " and at most " + text_of(field.high);
}

}  // namespace caplet
