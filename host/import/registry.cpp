// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <utility>

#include "import/detail/importers.h"
#include "import/import.h"

namespace caplet {

namespace {

template <auto function>
Imported imported(const std::filesystem::path& path, const ImageReader& images,
                  const ImportOptions& options) {
  return function(path, images, options);
}

void set_picture(std::vector<Format>& rows, const char* name, double noise, double least_width) {
  for (Format& format : rows)
    if (format.name == name) {
      format.noise = noise;
      format.least_width = least_width;
    }
}

/// Root elements distinguish formats that share an ending.
const std::vector<std::pair<std::string, std::string>>& xml_roots() {
  static const std::vector<std::pair<std::string, std::string>> rows = {
#define IMPORTER(...)
#define FULL_IMPORTER(...)
#define XML_ROOT(name, root) {name, root},
#include "import/importers.def"
#undef IMPORTER
#undef FULL_IMPORTER
  };
  return rows;
}

}  // namespace

bool is_its_root(const Format& format, std::string_view root) {
  return std::ranges::none_of(
      xml_roots(), [&](const auto& row) { return row.first == format.name && row.second != root; });
}

const std::vector<Format>& formats() {
  static const std::vector<Format> all = [] {
    std::vector<Format> rows = {
#define OPTIONS(...) \
  { __VA_ARGS__ }
#define IMPORTER(function, name, options, ...) {name, {__VA_ARGS__}, options, &imported<function>},
#define FULL_IMPORTER IMPORTER
#include "import/importers.def"
#undef IMPORTER
#undef FULL_IMPORTER
#undef OPTIONS
    };
#define IMPORTER(...)
#define FULL_IMPORTER(...)
#define PICTURE(name, noise, least_width) set_picture(rows, name, noise, least_width);
#include "import/importers.def"
#undef IMPORTER
#undef FULL_IMPORTER
    return rows;
  }();
  return all;
}

}  // namespace caplet
