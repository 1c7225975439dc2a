// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace caplet::schema {

struct Parameter {
  std::string name, doc;
  std::vector<std::string> types =
      {};  // types of pbrt's text: "float", "rgb", "texture", ...; the first is the usual one
  std::string fallback = {};  // the default as text of a scene file; empty: none
  double low = -std::numeric_limits<double>::infinity(),
         high = std::numeric_limits<double>::infinity();  // of numbers
  bool above_low = false;                                 // `low` itself is excluded
  std::string unit = {};
  std::vector<std::string> choices = {};   // all allowed values
  std::vector<std::string> excludes = {};  // parameters that it cannot be combined with
  bool has_effect = true;                  // false: it is read and ignored
};

}  // namespace caplet::schema
