// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Any bytes as a molecule of the format pdb, and as a cartoon by the file's records and by hydrogen
// bonds.
#include "import/detail/importers.h"
#include "importer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using caplet::import_pdb, caplet::test::fuzz_importer;
  fuzz_importer(import_pdb, data, size);
  fuzz_importer(import_pdb, data, size, {{{"style", "cartoon"}, {"color", "secondary"}}});
  return fuzz_importer(import_pdb, data, size, {{{"style", "cartoon"}, {"secondary", "dssp"}}});
}
