// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <vector>

#include "support/data.h"

namespace caplet {
namespace {

void write(const std::filesystem::path& path, const char* text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

TEST(FreeMemory, IsThatOfTheMachineAndItsGroup) {
  const std::filesystem::path root = test::temporary_folder();
  EXPECT_EQ(free_memory(root), std::nullopt);
  write(root / "proc/meminfo", "MemTotal: 900 kB\nMemAvailable:    700 kB\n");
  EXPECT_EQ(free_memory(root), 700U * 1024);
  write(root / "sys/fs/cgroup/memory.max", "max\n");
  write(root / "sys/fs/cgroup/memory.current", "5000\n");
  EXPECT_EQ(free_memory(root), 700U * 1024);
  write(root / "sys/fs/cgroup/memory.max", "25000\n");
  EXPECT_EQ(free_memory(root), 20000U);
  write(root / "sys/fs/cgroup/memory.max", "4000\n");
  EXPECT_EQ(free_memory(root), 0U);
  write(root / "sys/fs/cgroup/memory.max", "9000000\n");
  EXPECT_EQ(free_memory(root), 700U * 1024);
}

TEST(FreeMemory, OfThisMachineIsSaid) { EXPECT_LT(1U << 20, free_memory().value_or(0)); }

TEST(ReleasePages, GivesBackWholePagesAlone) {
  constexpr std::size_t page = 4096;
  std::vector<char> bytes(16 * page, 'x');
  release_pages(bytes.data() + 3 * page + 1, 5 * page);
  const auto given = [](char byte) { return byte == 0; };
  const std::size_t first = static_cast<std::size_t>(std::ranges::find_if(bytes, given) -
                                                     bytes.begin()),
                    count = static_cast<std::size_t>(std::ranges::count_if(bytes, given));
  EXPECT_LE(3 * page + 1, first);
  EXPECT_LE(first + count, 8 * page + 1);
#ifdef __linux__
  EXPECT_EQ(count, 4 * page);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(&bytes[first]) % page, 0u);
#endif
  for (std::size_t i = first; i < first + count; ++i) EXPECT_EQ(bytes[i], 0);
}

TEST(ReleasePages, OfLessThanAPageGivesNothing) {
  std::vector<char> bytes(100, 'x');
  release_pages(bytes.data(), bytes.size());
  release_pages(bytes.data(), 0);
  EXPECT_EQ(bytes, std::vector<char>(100, 'x'));
}

}  // namespace
}  // namespace caplet
