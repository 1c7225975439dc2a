// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Temporary files of processes that were killed: the next one that writes to the same name removes
// them, and no others.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <functional>
#include <iterator>

#include "base/atomic_file.h"
#include "support/data.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::UnorderedElementsAreArray;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void put(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> out;
  for (const auto& entry : fs::directory_iterator(folder))
    out.push_back(entry.path().filename().string());
  std::ranges::sort(out);
  return out;
}

/// A child that writes to `target`, and calls `meanwhile` when half of it is there.
pid_t writing(const fs::path& target, const std::function<void()>& meanwhile) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  write_atomically(target, [&](const fs::path& path) {
    put(path, "half");
    meanwhile();
    put(path, "of the child");
  });
  ::_exit(0);
}

int signal_of(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

TEST(Leftovers, AreRemovedByTheNextThatWritesThere) {
  const fs::path folder = test::temporary_folder(), target = folder / "a.exr";
  const auto dies = [] { ::kill(::getpid(), SIGKILL); };
  std::vector<std::string> left;
  for (int i = 0; i < 3; ++i) {
    const pid_t child = writing(folder / (i < 2 ? "a.exr" : "other.exr"), dies);
    ASSERT_EQ(signal_of(child), SIGKILL);
    for (const std::string& name : names_in(folder))
      if (name.find(fmt::format(".{}.", child)) != std::string::npos) left.push_back(name);
    // The second child has removed what the first one left.
    ASSERT_EQ(left.size(), static_cast<std::size_t>(i + 1));
    EXPECT_EQ(names_in(folder).size(), i < 2 ? 1u : 2u);
  }
  EXPECT_TRUE(left[2].starts_with(".other.") && left[2].ends_with(".part.exr")) << left[2];
  write_bytes(target, "whole");
  EXPECT_THAT(names_in(folder), ElementsAre(left[2], "a.exr"));
  EXPECT_EQ(text_of(target), "whole");
  write_bytes(folder / "other.exr", "whole too");
  EXPECT_THAT(names_in(folder), ElementsAre("a.exr", "other.exr"));
}

TEST(Leftovers, OfLivingProcessesStay) {
  const fs::path folder = test::temporary_folder(), target = folder / "a.exr";
  std::array<int, 2> begun{}, go_on{};
  ASSERT_TRUE(::pipe(begun.data()) == 0 && ::pipe(go_on.data()) == 0);
  char byte = 0;
  const pid_t child = writing(target, [&] {
    (void)!::write(begun[1], "b", 1);
    (void)!::read(go_on[0], &byte, 1);
  });
  ASSERT_EQ(::read(begun[0], &byte, 1), 1);
  ASSERT_EQ(names_in(folder).size(), 1u);
  write_bytes(target, "of the parent");
  EXPECT_EQ(names_in(folder).size(), 2u);
  EXPECT_EQ(text_of(target), "of the parent");
  ASSERT_EQ(::write(go_on[1], "g", 1), 1);
  EXPECT_EQ(signal_of(child), 0);
  EXPECT_EQ(text_of(target), "of the child");
  EXPECT_THAT(names_in(folder), ElementsAre("a.exr"));
  for (const int end : {begun[0], begun[1], go_on[0], go_on[1]}) ::close(end);
}

TEST(Leftovers, AreNoFilesOfOtherNames) {
  const fs::path folder = test::temporary_folder();
  const std::vector<std::string> others = {
      ".a.1.part.exr",       ".a.1.2.3.part.exr",   ".a.1.x.part.exr",  ".a..1.part.exr",
      ".a.1.2.part.png",     ".a.1.2.part",         ".ab.1.2.part.exr", "a.1.2.part.exr",
      "..a.1.2.part.exr",    ".a.1.2.part.exr.exr", ".a.-1.2.part.exr", ".a.1. 2.part.exr",
      ".A.1.2.part.exr",     ".a.1.2.exr",          ".1.2.part.exr",    ".a.1.2.parted.exr",
      ".a.1.2.partexr",      ".b.a.1.2.part.exr",   ".part.exr",        ".a.part.exr",
      ".a.1.2.part.1.2.exr", ".a.1.2.part.part",    ".a.1.2.part.exr.x"};
  for (const std::string& name : others) put(folder / name, "of somebody");
  fs::create_directory(folder / ".a.1.3.part.exr");
  put(folder / "kept", "kept");
  fs::create_symlink("kept", folder / ".a.1.4.part.exr");
  ASSERT_EQ(::mkfifo((folder / ".a.1.5.part.exr").c_str(), 0600), 0);
  put(folder / ".a.1.6.part.exr", "left");
  write_bytes(folder / "a.exr", "whole");
  std::vector<std::string> there = others;
  there.insert(there.end(),
               {".a.1.3.part.exr", ".a.1.4.part.exr", ".a.1.5.part.exr", "kept", "a.exr"});
  EXPECT_THAT(names_in(folder), UnorderedElementsAreArray(there));
  EXPECT_EQ(text_of(folder / "kept"), "kept");
}

/// Process numbers come again, in containers always the same ones.
TEST(Leftovers, OfTheSameNumbersAreNotInTheWay) {
  const fs::path folder = test::temporary_folder(), target = folder / "a.exr";
  std::string name;
  write_atomically(target, [&](const fs::path& path) { name = path.filename().string(); });
  const std::size_t end = name.find(".part"), begin = name.rfind('.', end - 1) + 1;
  const int number = std::stoi(name.substr(begin, end - begin));
  std::vector<int> held;
  for (int i = 1; i <= 3; ++i) {
    const fs::path next =
        folder / (name.substr(0, begin) + std::to_string(number + i) + name.substr(end));
    held.push_back(::open(next.c_str(), O_CREAT | O_WRONLY, 0600));
    ASSERT_EQ(::flock(held.back(), LOCK_EX | LOCK_NB), 0);
  }
  write_bytes(target, "whole");
  EXPECT_EQ(text_of(target), "whole");
  EXPECT_EQ(names_in(folder).size(), 4u);
  for (const int each : held) ::close(each);
}

}  // namespace
}  // namespace caplet
