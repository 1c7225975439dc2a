// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Any bytes as a TRX archive; those that do not begin as one as its arrays: two bytes say how many
// points and streamlines, and of what type they are. Coloured by the first numbers of points too.
#include "import/detail/importers.h"
#include "importer.h"
#include "support/zip_text.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const caplet::ImportOptions by_scalar(std::map<std::string, std::string>{{"color", "scalar"}});
  if (text.starts_with("PK") || size < 2) {
    caplet::test::fuzz_importer(caplet::import_trx, data, size, by_scalar);
    return caplet::test::fuzz_importer(caplet::import_trx, data, size);
  }
  const std::size_t tracks = data[0] % 16U, width = std::size_t{2} << (data[1] % 3U),
                    ends = 4 * (tracks + data[1] / 128U);
  const std::string offsets = text.substr(2, ends),
                    positions = text.substr(std::min(size, 2 + ends));
  const std::string archive = caplet::test::zip_of(
      {{"header.json", "{\"NB_VERTICES\": " + std::to_string(positions.size() / (3 * width)) +
                           ", \"NB_STREAMLINES\": " + std::to_string(tracks) + "}"},
       {"positions.3.float" + std::to_string(8 * width), positions},
       {"offsets.uint32", offsets},
       {"dpv/value.uint8", positions.substr(0, positions.size() / (3 * width))}});
  caplet::test::fuzz_importer(caplet::import_trx,
                              reinterpret_cast<const std::uint8_t*>(archive.data()), archive.size(),
                              by_scalar);
  return caplet::test::fuzz_importer(
      caplet::import_trx, reinterpret_cast<const std::uint8_t*>(archive.data()), archive.size());
}
