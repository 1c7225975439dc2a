// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Any bytes as a molecule of the format mmcif, as a crystal whose whole cell is drawn, and as a
// cartoon.
#include "import/detail/importers.h"
#include "importer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  caplet::test::fuzz_importer(caplet::import_mmcif, data, size);
  caplet::test::fuzz_importer(caplet::import_mmcif, data, size, {{{"assembly", "cell"}}});
  return caplet::test::fuzz_importer(caplet::import_mmcif, data, size, {{{"style", "cartoon"}}});
}
