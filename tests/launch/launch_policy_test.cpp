// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Sizes of batches, launches and sort blocks, without a device.
#include "render/detail/launch_policy.h"

#include <gtest/gtest.h>

namespace caplet::test {
namespace {

TEST(Batches, FitInAllAndInOneBuffer) {
  EXPECT_EQ(fitting_batch(1 << 20, 300, 52, 1ull << 40, 1ull << 40), std::size_t{1} << 20);
  EXPECT_EQ(fitting_batch(1 << 20, 300, 52, 300ull << 20, 52ull << 20),
            std::size_t{1} << 20);  // just
  EXPECT_EQ(fitting_batch(1 << 20, 300, 52, (300ull << 20) - 1, 1ull << 40),
            std::size_t{1} << 19);  // not in all
  EXPECT_EQ(fitting_batch(1 << 20, 300, 52, 1ull << 40, (52ull << 20) - 1),
            std::size_t{1} << 19);  // not in one buffer
  EXPECT_EQ(fitting_batch(1 << 20, 300, 52, 300ull << 14, 1ull << 40), std::size_t{1} << 14);
  EXPECT_EQ(fitting_batch(1 << 20, 300, 52, 0, 0), least_batch_paths);
  EXPECT_EQ(fitting_batch(100, 300, 52, 0, 0), 100u);
}

TEST(Chunks, GrowWhileLaunchesAreShortAndShrinkWhenTheyAreLong) {
  EXPECT_EQ(next_chunk(1 << 16, 1 << 20, 0.1),
            std::size_t{1} << 17);  // a sixteenth of a tenth of a second
  EXPECT_EQ(next_chunk(1 << 16, 1 << 20, 1.6),
            std::size_t{1} << 16);  // twice as many would take 0.2 s
  EXPECT_EQ(next_chunk(1 << 16, 1 << 20, 16), std::size_t{1} << 15);  // 1 s
  EXPECT_EQ(next_chunk(1 << 16, 1 << 14, 0.001),
            std::size_t{1} << 16);  // says nothing of whole chunks
  EXPECT_EQ(next_chunk(1 << 16, 1 << 14, 0.6), std::size_t{1} << 15);
  EXPECT_EQ(next_chunk(1 << 10, 1 << 20, 1e6), std::size_t{1} << 10);
  EXPECT_EQ(next_chunk(1 << 30, 1u << 31, 0), std::size_t{1} << 30);
}

TEST(SortLevels, EndInOneSum) {
  const auto text = [](std::size_t bins, std::size_t fan) {
    std::string out;
    for (const SortLevel& level : sort_levels(bins, fan))
      out += std::to_string(level.first) + "+" + std::to_string(level.count) + " ";
    return out + std::to_string(sort_places(bins, fan));
  };
  EXPECT_EQ(text(262144, 64), "0+4096 4096+64 4160+1 266305");
  EXPECT_EQ(text(32768, 64), "0+512 512+8 520+1 33289");
  EXPECT_EQ(text(8, 64), "0+1 9");
  EXPECT_EQ(text(65, 64), "0+2 2+1 68");
  EXPECT_EQ(text(32768, 1u << 31), "0+1 32769");
}

}  // namespace
}  // namespace caplet::test
