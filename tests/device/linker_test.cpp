// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `ld` of a portable installation: what of PoCL's arguments LLVM's linker is handed. It takes what
// lies beside it for that linker.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/data.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

struct Output {
  std::vector<std::string> lines;
  int code = 0;
};

Output run(const std::string& command) {
  FILE* const pipe = ::popen((command + " 2>&1").c_str(), "r");
  Output out;
  std::array<char, 4096> line{};
  while (std::fgets(line.data(), static_cast<int>(line.size()), pipe)) {
    out.lines.emplace_back(line.data());
    out.lines.back().pop_back();
  }
  const int status = ::pclose(pipe);
  out.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return out;
}

class Linker : public testing::Test {
 protected:
  Linker() { fs::copy_file(CAPLET_DRIVER_LINKER, folder_ / "ld"); }
  void make_lld(const std::string& script) {
    std::ofstream(folder_ / "lld") << "#!/bin/sh\n" << script << "\n";
    fs::permissions(folder_ / "lld", fs::perms::owner_all);
  }
  std::string ld() const { return "'" + (folder_ / "ld").string() + "'"; }

 private:
  const fs::path folder_ = test::temporary_folder();
};

TEST_F(Linker, LeavesOutLibrariesThatOnlyMachinesWithACompilerHave) {
  make_lld("for one; do echo \"$one\"; done");
  const Output said = run(ld() +
                          " --build-id -m elf_x86_64 -shared -o 'a b.so' -L/usr/lib/gcc/12 -L/lib "
                          "a.o -lm -lgcc --as-needed -lc");
  EXPECT_THAT(said.lines, ElementsAre("--build-id", "-m", "elf_x86_64", "-shared", "-o", "a b.so",
                                      "a.o", "--as-needed", EndsWith("/libm.so.6")));
  EXPECT_TRUE(fs::is_regular_file(said.lines.back()));
  EXPECT_EQ(said.code, 0);
}

TEST_F(Linker, FailsAsItsLinkerDoes) {
  make_lld("exit 3");
  EXPECT_EQ(run(ld() + " a.o").code, 3);
}

TEST_F(Linker, SaysWhatItLacks) {
  const Output said = run(ld() + " a.o");
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.lines, ElementsAre(HasSubstr("/lld: No such file or directory")));
}

}  // namespace
}  // namespace caplet
