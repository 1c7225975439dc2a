// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Folders that PoCL can use, and whose they are.
#include "device/pocl_needs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "support/data.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(PoclNeeds, AFolderThatCanBeMade) {
  const fs::path folder = test::temporary_folder();
  EXPECT_EQ(why_unwritable(folder), "");
  EXPECT_EQ(why_unwritable(folder / "not" / "there" / "yet"), "");
  EXPECT_EQ(entries(folder), 0u);
  std::ofstream(folder / "file") << "in the way";
  EXPECT_THAT(why_unwritable(folder / "file"), HasSubstr("file is not a folder"));
  EXPECT_THAT(why_unwritable(folder / "file" / "sub"), HasSubstr("file is not a folder"));
  fs::create_symlink(folder / "nowhere", folder / "link");
  EXPECT_THAT(why_unwritable(folder / "link" / "sub"), HasSubstr("link is not a folder"));
  EXPECT_THAT(why_unwritable("/proc/caplet"),
              HasSubstr("/proc: "));  // where root makes nothing, either
  if (::geteuid() == 0) return;       // who may write anywhere
  fs::permissions(folder, fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THAT(why_unwritable(folder / "sub"), HasSubstr("Permission denied"));
  fs::permissions(folder, fs::perms::owner_all);
}

TEST(PoclNeeds, APrivateFolderIsNobodyElses) {
  const fs::path temporary = test::temporary_folder();
  const auto folder = private_folder(temporary);
  ASSERT_TRUE(folder);
  struct stat status {};
  ASSERT_EQ(::lstat(folder->c_str(), &status), 0);
  EXPECT_TRUE(S_ISDIR(status.st_mode));
  EXPECT_EQ(status.st_mode & 0777, 0700u);
  EXPECT_EQ(status.st_uid, ::geteuid());
  EXPECT_EQ(private_folder(temporary), folder);
  ASSERT_EQ(::chmod(folder->c_str(), 0770), 0);  // others put programs in it
  EXPECT_EQ(private_folder(temporary), std::nullopt);
  fs::remove(*folder);
  fs::create_directory(temporary / "elsewhere");
  ASSERT_EQ(::chmod((temporary / "elsewhere").c_str(), 0700), 0);
  fs::create_symlink(temporary / "elsewhere", *folder);
  EXPECT_EQ(private_folder(temporary), std::nullopt);
  fs::remove(*folder);
  std::ofstream(*folder) << "in the way";
  EXPECT_EQ(private_folder(temporary), std::nullopt);
  EXPECT_EQ(private_folder(temporary / "missing"), std::nullopt);
  if (::geteuid() != 0) return;
  fs::remove(*folder);
  ASSERT_EQ(::mkdir(folder->c_str(), 0700), 0);
  ASSERT_EQ(::chown(folder->c_str(), 12345, 12345), 0);
  EXPECT_EQ(private_folder(temporary), std::nullopt);
}

TEST(PoclNeeds, ProcessorsInSys) {
  const fs::path sys = test::temporary_folder();
  EXPECT_FALSE(tells_of_processors(sys));
  fs::create_directories(sys / "devices/system/cpu");
  EXPECT_TRUE(tells_of_processors(sys));
}

}  // namespace
}  // namespace caplet
