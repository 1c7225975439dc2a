// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads the `fields` of models (scene/field.h) from the parameters of a statement.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "base/spelling.h"
#include "import/detail/pbrt/parameters.h"
#include "scene/field.h"
#include "scene/material.h"

namespace caplet::pbrt {

/// Reads numbers, flags and choices, which all families share. Fields that are not given keep their
/// values.
struct FieldReader {
  Parameters& parameters;

  void number(const Field& field, double& value) {
    value = parameters.number(field.name, value);
    check(field, value);
  }
  void integer(const Field& field, int& value) {
    value = parameters.integer(field.name, value);
    check(field, value);
  }
  /// Accepts any integer and keeps its 32 bits.
  void seed(const Field& field, std::uint32_t& value) {
    value = static_cast<std::uint32_t>(
        parameters.integer(field.name, static_cast<std::int32_t>(value)));
  }
  void flag(const Field& field, bool& value) { value = parameters.boolean(field.name, value); }
  template <class Names>
  void choice(const Field& field, int& value, const Names& names) {
    const std::string given = parameters.text(field.name, names[static_cast<std::size_t>(value)]);
    const auto found = std::find(names.begin(), names.end(), given);
    if (found != names.end()) {
      value = static_cast<int>(found - names.begin());
      return;
    }
    parameters.error(field.name,
                     "is " + in_quotes(given) + "; the nearest known name is \"" +
                         nearest_name(given, std::vector<std::string>(names.begin(), names.end())) +
                         "\"");
  }

 protected:
  void check(const Field& field, double value) {
    if (!is_within(field, value)) parameters.error(field.name, must_lie_within(field));
  }
};

}  // namespace caplet::pbrt
