// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// One row a format.
#include "import/detail/importers.h"
#include "import/import.h"

namespace caplet {

const std::vector<Format>& formats() {
  static const std::vector<Format> rows = {
      {"pbrt-v4", {".pbrt", ".pbrt.gz"}, &import_pbrt},
      {"swc", {".swc"}, &import_swc},
      {"capsules", {".capsules"}, &import_capsules_file},
  };
  return rows;
}

}  // namespace caplet
