// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/memory.h"

#include <gtest/gtest.h>

#include <fstream>

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

}  // namespace
}  // namespace caplet
