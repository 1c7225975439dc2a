// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Any bytes as a molecule of the format pqr.
#include "import/detail/importers.h"
#include "importer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return caplet::test::fuzz_importer(caplet::import_pqr, data, size);
}
