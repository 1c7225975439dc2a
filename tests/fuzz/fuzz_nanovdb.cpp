// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A NanoVDB file either gives a grid of finite densities or is refused: any bytes, and the memory
// of a sound grid with some bytes of it changed.
#include <cmath>
#include <cstring>
#include <string>

#include "import/detail/nanovdb.h"
#include "target.h"

namespace {

constexpr std::size_t root = 736, upper = root + 64 + 32, lower = upper + 8256 + 262144,
                      leaf = lower + 1088 + 32768, end = leaf + 2144;

/// One leaf, uncompressed and without a header (tests/import/nanovdb_test.cpp has the layout).
std::string sound_grid() {
  std::string memory(end, '\0');
  const auto put = [&](std::size_t at, auto value) {
    std::memcpy(&memory[at], &value, sizeof value);
  };
  put(0, std::uint64_t{0x314244566f6e614e});
  put(16, std::uint32_t{32u << 21});
  put(32, std::uint64_t{end});
  std::memcpy(&memory[40], "density", 7);
  for (std::size_t k = 0; k < 3; ++k) put(296 + 88 + 32 * k, 0.5);
  put(636, std::uint32_t{1});
  put(672 + 24, std::uint64_t{root - 672});
  put(root + 24, std::uint32_t{1});
  put(root + 72, std::int64_t{upper - root});
  put(upper + 32 + 4096, std::uint8_t{1});
  put(upper + 8256, std::int64_t{lower - upper});
  put(lower + 32 + 512, std::uint8_t{1});
  put(lower + 1088, std::int64_t{leaf - lower});
  put(leaf + 96, 0.5f);
  return memory;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using caplet::test::require;
  static const std::string sound = sound_grid();
  std::string bytes(reinterpret_cast<const char*>(data), size);
  if (size % 12 == 0 && size > 0) {
    // An offset and eight bytes for it each.
    bytes = sound;
    for (std::size_t i = 0; i < size; i += 12) {
      std::uint32_t at = 0;
      std::memcpy(&at, data + i, 4);
      std::memcpy(&bytes[at % (end - 8)], data + i + 4, 8);
    }
  }
  const caplet::test::MemoryFile file(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                      bytes.size());
  return caplet::test::run_target([&] {
    const caplet::SparseGridPointer grid = caplet::read_nanovdb(file.path(), "density", {});
    if (!grid) return;
    require(grid->values.size() == 512 * grid->bricks.size());
    for (const float value : grid->values) require(std::isfinite(value) && value >= 0);
  });
}
