// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt/pbrt.h"

#include "import/detail/gzip_file.h"
#include "import/detail/importers.h"
#include "import/detail/pbrt/builder.h"
#include "import/detail/pbrt/parser.h"
#include "import/import.h"

namespace caplet {

namespace {

Imported import(const std::string& file, std::string text, const ImageReader& images,
                bool needs_light = true) {
  check_text(text, file);
  pbrt::Builder builder(file, images);
  pbrt::Parser(builder.target(), builder.diagnostics()).parse(file, std::move(text));
  return builder.finish(needs_light);
}

}  // namespace

Scene pbrt::import_text(const std::string& file, std::string text, const ImageReader& images) {
  return presented(import(file, std::move(text), images));
}

Scene read_pbrt_text(const std::filesystem::path& file, std::string text,
                     const ImageReader& images) {
  return import(file.string(), std::move(text), images, false).scene;
}

Imported import_pbrt(const std::filesystem::path& path, const ImageReader& images,
                     const ImportOptions&) {
  return import(path.string(), read_text(path, {}), images);
}

}  // namespace caplet
