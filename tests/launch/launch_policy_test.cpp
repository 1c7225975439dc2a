// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Sizes of batches, launches and sort blocks, without a device.
#include "render/detail/launch_policy.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "base/error.h"

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

TEST(Policy, OfGpusGrowsWithTheirUnits) {
  const auto of = [](std::uint32_t units) { return launch_policy_of(Profile::gpu, units); };
  EXPECT_EQ(of(1).batch_paths, std::size_t{1} << 20);
  EXPECT_EQ(of(63).batch_paths, std::size_t{1} << 20);
  EXPECT_EQ(of(64).batch_paths, std::size_t{1} << 21);
  EXPECT_EQ(of(132).batch_paths, std::size_t{1} << 22);
  EXPECT_EQ(of(1000).batch_paths, std::size_t{1} << 22);
  EXPECT_EQ(of(1).first_chunk, std::size_t{1} << 16);
  EXPECT_EQ(of(20).first_chunk, std::size_t{1} << 17);
  EXPECT_EQ(of(132).first_chunk, std::size_t{1} << 20);
  EXPECT_EQ(launch_policy_of(Profile::cpu, 132).batch_paths, std::size_t{1} << 18);
}

LaunchPolicy policy_told(const char* text, Profile profile = Profile::gpu) {
  ::setenv("CAPLET_LAUNCH", text, 1);
  struct Unset {
    ~Unset() { ::unsetenv("CAPLET_LAUNCH"); }
  } unset;
  return launch_policy_of(profile, 20);
}

TEST(LaunchVariable, ChangesTheNumbersItNames) {
  const LaunchPolicy own = policy_told("");
  LaunchPolicy told = policy_told("paths=4096,local=32,chunk=0,rounds=16");
  EXPECT_EQ(told.batch_paths, 4096u);
  EXPECT_EQ(told.local_size, 32u);
  EXPECT_EQ(told.first_chunk, 0u);
  EXPECT_EQ(told.rounds_unasked, 16);
  EXPECT_EQ(told.counts_on_device, own.counts_on_device);
  EXPECT_EQ(told.sort_fan, own.sort_fan);
  told = policy_told("local=128", Profile::cpu);
  EXPECT_EQ(told.local_size, 128u);
  EXPECT_EQ(told.batch_paths, std::size_t{1} << 18);
}

TEST(LaunchVariable, IsRefusedWithItsName) {
  for (const char* const wrong :
       {"paths=255", "paths=268435457", "local=0", "local=1025", "chunk=1073741825", "chunk=-1",
        "rounds=0", "rounds=65", "rounds", "rounds=", "rounds=4x", "width=8", "=", ","})
    try {
      policy_told(wrong);
      ADD_FAILURE() << wrong << " is taken";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("CAPLET_LAUNCH"), std::string::npos) << wrong;
    }
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
