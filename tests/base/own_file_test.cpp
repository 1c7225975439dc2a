// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Where a program lies, whatever it is called by.
#include "base/own_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "support/data.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;

TEST(OwnFile, IsThisProgram) { EXPECT_EQ(own_file(), fs::read_symlink("/proc/self/exe")); }

/// The program starts itself under the name of another file, as the script `caplet` of a wheel
/// does.
TEST(OwnFile, IsNotWhatTheProgramIsCalledBy) {
  if (std::getenv("CAPLET_OWN_FILE") != nullptr) {
    EXPECT_EQ(own_file(), fs::read_symlink("/proc/self/exe"));
    return;
  }
  std::string script = (test::temporary_folder() / "caplet").string(),
              filter = "--gtest_filter=OwnFile.IsNotWhat*";
  std::ofstream(script) << "#!/bin/sh\n";
  const pid_t child = ::fork();
  if (child == 0) {
    ::setenv("CAPLET_OWN_FILE", "1", 1);
    char* arguments[] = {script.data(), filter.data(), nullptr};
    ::execv("/proc/self/exe", arguments);
    ::_exit(127);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

}  // namespace
}  // namespace caplet
