// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Any bytes as fibres of the format trk, coloured by direction and by the file's first numbers.
#include "import/detail/importers.h"
#include "importer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  caplet::test::fuzz_importer(
      caplet::import_trk, data, size,
      caplet::ImportOptions(std::map<std::string, std::string>{{"color", "scalar"}}));
  return caplet::test::fuzz_importer(caplet::import_trk, data, size);
}
