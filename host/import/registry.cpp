// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/importers.h"
#include "import/import.h"

namespace caplet {

namespace {

template <auto function>
Imported imported(const std::filesystem::path& path, const ImageReader& images, const ImportOptions& options) {
  return function(path, images, options);
}

}  // namespace

const std::vector<Format>& formats() {
  static const std::vector<Format> rows = {
#define OPTIONS(...) \
  { __VA_ARGS__ }
#define IMPORTER(function, name, options, ...) {name, {__VA_ARGS__}, options, &imported<function>},
#define FULL_IMPORTER IMPORTER
#include "import/importers.def"
#undef IMPORTER
#undef FULL_IMPORTER
#undef OPTIONS
  };
  return rows;
}

}  // namespace caplet
