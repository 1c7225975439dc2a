// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/importers.h"
#include "import/import.h"

namespace caplet {

const std::vector<Format>& formats() {
  static const std::vector<Format> rows = {
#define OPTIONS(...) \
  { __VA_ARGS__ }
#define IMPORTER(function, name, options, ...) {name, {__VA_ARGS__}, options, &function},
#include "import/importers.def"
#undef IMPORTER
#undef OPTIONS
  };
  return rows;
}

}  // namespace caplet
