// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// PLY bytes either give a mesh whose indices are in range, or are refused by InputError.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "base/log.h"
#include "import/ply.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  spdlog::set_level(spdlog::level::off);
  try {
    const auto mesh = caplet::parse_ply("fuzz.ply", {reinterpret_cast<const char*>(data), size});
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t vertex : triangle)
        if (vertex >= mesh.positions.size()) std::abort();
  } catch (const caplet::InputError&) {
  }
  return 0;
}
