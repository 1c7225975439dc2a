// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace caplet::schema {

struct Parameter {
  std::string name, doc;
  std::vector<std::string> types = {};  // of pbrt's text: "float", "rgb", "texture", ...; the first is the usual one
  std::string fallback = {};            // what it is where nothing is given, as scene files would have it; empty: nothing
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();  // of numbers
  bool above_low = false;  // `low` itself is out of the range
  std::string unit = {};
  std::vector<std::string> choices = {};   // all that there are
  std::vector<std::string> excludes = {};  // not together with these
  bool has_effect = true;                  // else it is read and ignored
};

}  // namespace caplet::schema
