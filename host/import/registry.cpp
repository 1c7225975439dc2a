// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/importers.h"
#include "import/import.h"

namespace caplet {

const std::vector<Format>& formats() {
  static const std::vector<Format> rows = {
#define IMPORTER(function, name, ...) {name, {__VA_ARGS__}, &function},
#include "import/importers.def"
#undef IMPORTER
  };
  return rows;
}

}  // namespace caplet
