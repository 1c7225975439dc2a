// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Any bytes as a TRX archive; those that do not begin as one as its arrays: two bytes say how many points and streamlines, and of
// what type they are.
#include "import/detail/importers.h"
#include "importer.h"
#include "support/zip_text.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (text.starts_with("PK") || size < 2) return caplet::test::fuzz_importer(caplet::import_trx, data, size);
  const std::size_t tracks = data[0] % 16U, width = std::size_t{2} << (data[1] % 3U), ends = 4 * (tracks + data[1] / 128U);
  const std::string offsets = text.substr(2, ends), positions = text.substr(std::min(size, 2 + ends));
  const std::string archive =
      caplet::test::zip_of({{"header.json", "{\"NB_VERTICES\": " + std::to_string(positions.size() / (3 * width)) +
                                                ", \"NB_STREAMLINES\": " + std::to_string(tracks) + "}"},
                            {"positions.3.float" + std::to_string(8 * width), positions},
                            {"offsets.uint32", offsets}});
  return caplet::test::fuzz_importer(caplet::import_trx, reinterpret_cast<const std::uint8_t*>(archive.data()), archive.size());
}
