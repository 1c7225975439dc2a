// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Signals that end a process at once, and the line under messages.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "base/atomic_file.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/status_line.h"
#include "support/data.h"

namespace caplet {
namespace {

TEST(EndsAtOnce, RemovesWhatIsBeingWritten) {
  const std::filesystem::path folder = test::temporary_folder(), words = folder / "words";
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    [[maybe_unused]] const auto* to = std::freopen(words.c_str(), "w", stderr);
    install_interrupt_handlers();
    { const EndsAtOnce other("not this\n", 3); }
    ::raise(SIGUSR1);  // only sets the flag
    const EndsAtOnce early("last words\n", 7);
    write_atomically(folder / "out", [](const std::filesystem::path& path) {
      std::ofstream(path) << "half" << std::flush;
      ::raise(SIGUSR1);
    });
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 7);
  std::string said;
  std::getline(std::ifstream(words), said);
  EXPECT_EQ(said, "last words");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST(StatusLine, OfAStepIsOneRow) {
  testing::internal::CaptureStderr();
  {
    const StepNotice notice("reading a\nb" + std::string(4000, 'c'), ProgressReporter::Style::bar);
    std::this_thread::sleep_for(std::chrono::seconds(2));
  }
  const std::string said = testing::internal::GetCapturedStderr();
  const std::size_t end = said.find("\x1b[K");
  ASSERT_NE(end, std::string::npos);
  EXPECT_EQ(said.find('\n'), std::string::npos);
  EXPECT_EQ(said.substr(0, 20), "\rcaplet: reading a b");
  EXPECT_EQ(said.substr(end - 5, 5), ": 1 s");
  EXPECT_LE(end, 80U);  // no terminal: 80 columns
}

TEST(StatusLine, StaysUnderMessages) {
  testing::internal::CaptureStderr();
  log::show_line("");  // nothing is shown: nothing to clear
  log::show_line("working");
  log::warn("late");
  log::show_line("");
  log::warn("last");
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "\rworking\x1b[K\r\x1b[Kcaplet: warning: late\nworking\r\x1b[Kcaplet: warning: last\n");
}

}  // namespace
}  // namespace caplet
