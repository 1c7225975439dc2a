// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Any bytes as fibres of the format vtp, coloured by the first numbers that they have.
#include "import/detail/importers.h"
#include "importer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  caplet::test::fuzz_importer(caplet::import_vtp, data, size);
  return caplet::test::fuzz_importer(caplet::import_vtp, data, size, {{{"color", "scalar"}}});
}
