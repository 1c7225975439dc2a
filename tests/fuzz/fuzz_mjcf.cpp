// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Any bytes as an MJCF file, in the pose of its keyframe "k" where that is one.
#include "import/detail/importers.h"
#include "importer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using caplet::ImportOptions;
  using Values = std::map<std::string, std::string>;
  caplet::test::fuzz_importer(caplet::import_mjcf, data, size,
                              ImportOptions(Values{{"groups", "all"}, {"pose", "k"}}));
  return caplet::test::fuzz_importer(caplet::import_mjcf, data, size,
                                     ImportOptions(Values{{"groups", "all"}}));
}
