// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/pbrt.h"

#include "import/importers.h"
#include "import/pbrt_file.h"
#include "import/pbrt_parser.h"

namespace caplet {

Scene pbrt::import_text(const std::string& file, std::string text, const ImageReader& images) {
  check_text(text, file);
  return Parser(file, images).parse(std::move(text));
}

Scene import_pbrt(const std::filesystem::path& path, const ImageReader& images) {
  return pbrt::import_text(path.string(), pbrt::read_text(path, {}), images);
}

}  // namespace caplet
