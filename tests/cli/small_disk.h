// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <gtest/gtest.h>
#include <sys/mount.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>

#include "program.h"

namespace caplet::test {

/// A file system of some pages while the object lives.
class SmallDisk {
 public:
  explicit SmallDisk(const std::filesystem::path& folder) : folder_(folder) {
    mounted_ = ::mount("tmpfs", folder.c_str(), "tmpfs", 0, "size=128k") == 0;
    if (!mounted_) std::printf("no file system can be mounted here: %s\n", std::strerror(errno));
  }
  ~SmallDisk() {
    if (mounted_) ::umount2(folder_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  bool mounted() const { return mounted_; }
  /// Takes all but `pages` of what is free.
  void leave(std::uintmax_t pages) const {
    std::filesystem::remove(folder_ / "filler");
    const std::uintmax_t free = std::filesystem::space(folder_).available,
                         page = static_cast<std::uintmax_t>(::getpagesize());
    write_file(folder_ / "filler", std::string(free - pages * page, 'x'));
    EXPECT_EQ(std::filesystem::space(folder_).available, pages * page);
  }

 private:
  std::filesystem::path folder_;
  bool mounted_ = false;
};

}  // namespace caplet::test
