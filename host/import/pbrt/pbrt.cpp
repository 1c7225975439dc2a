// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt/pbrt.h"

#include "import/detail/gzip_file.h"
#include "import/detail/importers.h"
#include "import/detail/pbrt/builder.h"
#include "import/detail/pbrt/parser.h"

namespace caplet {

namespace {

Imported import(const std::string& file, std::string text, const ImageReader& images) {
  check_text(text, file);
  pbrt::Builder builder(file, images);
  pbrt::Parser(builder.target(), builder.diagnostics()).parse(file, std::move(text));
  return builder.finish();
}

}  // namespace

Scene pbrt::import_text(const std::string& file, std::string text, const ImageReader& images) {
  return presented(import(file, std::move(text), images));
}

Imported import_pbrt(const std::filesystem::path& path, const ImageReader& images,
                     const ImportOptions&) {
  return import(path.string(), read_text(path, {}), images);
}

}  // namespace caplet
