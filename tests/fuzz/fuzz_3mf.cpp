// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Any bytes as a 3MF package; those that do not begin as an archive as the model of one.
#include "import/detail/importers.h"
#include "importer.h"
#include "support/zip_text.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (text.starts_with("PK")) return caplet::test::fuzz_importer(caplet::import_3mf, data, size);
  const std::string package = caplet::test::package_3mf(text);
  return caplet::test::fuzz_importer(
      caplet::import_3mf, reinterpret_cast<const std::uint8_t*>(package.data()), package.size());
}
