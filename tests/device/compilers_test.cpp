// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Kernels compiled by several processes: each job once, and all that goes wrong is left to this
// process.
#include "device/compilers.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>

#include "base/interrupt.h"
#include "support/data.h"
#include "support/environment.h"
#include "support/test_device.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;

/// Kernel number i adds 10 i + 1.
std::vector<CompileJob> adding_jobs(std::size_t count) {
  std::vector<CompileJob> out;
  for (std::size_t i = 0; i < count; ++i)
    out.push_back({fmt::format("add_{}", i),
                   fmt::format("__kernel void add_{}(__global uint* x, uint n) {{ const uint i = "
                               "(uint)get_global_id(0); if (i < n) x[i] += STEP; }}",
                               i),
                   fmt::format("-DSTEP={}", 10 * i + 1), 4});
  return out;
}

class CompilersTest : public testing::Test {
 protected:
  void SetUp() override { set_compiler_program(CAPLET_PROGRAM); }
  void TearDown() override {
    set_compiler_program("");
    set_interrupt_requested(false);
    errno = 0;
    EXPECT_TRUE(::waitpid(-1, nullptr, WNOHANG) == -1 && errno == ECHILD) << "a process is left";
  }
  void expect_results(const std::vector<CompileJob>& jobs) {
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      CompiledKernel compiled = compile(device_, jobs[i]);
      Buffer<cl_uint> buffer(device_, 6);
      buffer.write(std::vector<cl_uint>(6, 100));
      set_arguments(device_, compiled.kernel, buffer, cl_uint{6});
      launch_items(device_, compiled.kernel, 6, compiled.local_size);
      EXPECT_EQ(buffer.read(), std::vector<cl_uint>(6, static_cast<cl_uint>(101 + 10 * i)));
    }
  }
  Device device_ = test::test_device();
};

TEST_F(CompilersTest, ShareAllJobs) {
  for (const std::size_t processes : {0U, 1U, 3U, 9U}) {
    const std::vector<CompileJob> jobs = adding_jobs(8);
    Compilers compilers(device_, jobs, processes);
    EXPECT_EQ(compilers.process_count(), std::min<std::size_t>(processes, 8));
    compilers.finish();
    EXPECT_EQ(compilers.seconds().size(), jobs.size());
    for (const CompileJob& job : jobs) {
      ASSERT_TRUE(compilers.seconds().contains(job.kernel)) << job.kernel;
      EXPECT_LT(0, compilers.seconds().at(job.kernel)) << job.kernel;
      EXPECT_TRUE(is_cached(device_, job)) << job.kernel;
    }
    expect_results(jobs);
  }
}

TEST_F(CompilersTest, AnotherProcessTakesThoseOfTheLongestTexts) {
  std::vector<CompileJob> jobs = adding_jobs(3);
  for (CompileJob& job : jobs) job.source = "this is no kernel";
  jobs[1].source += " and it is the longest";
  Compilers compilers(device_, jobs, 1);
  siginfo_t ended;  // at its first job
  ASSERT_EQ(::waitid(P_ALL, 0, &ended, WEXITED | WNOWAIT), 0);
  try {
    compilers.finish();
    FAIL() << "no error";
  } catch (const RunError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.substr(0, text.find(':')), "program 'add_0'");
  }
}

TEST_F(CompilersTest, WithoutProcessesThisOneCompilesAll) {
  for (const char* program : {"/bin/false", "/does/not/exist", ""}) {
    set_compiler_program(program);
    const std::vector<CompileJob> jobs = adding_jobs(2);
    Compilers compilers(device_, jobs, 2);
    compilers.finish();
    EXPECT_EQ(compilers.seconds().size(), 2u) << program;
  }
}

TEST_F(CompilersTest, AnInterruptEndsThem) {
  const std::vector<CompileJob> jobs = adding_jobs(4);
  Compilers compilers(device_, jobs, 2);
  set_interrupt_requested(true);
  EXPECT_THROW(compilers.finish(), RunError);
}

TEST_F(CompilersTest, WhatIsCachedIsNotCompiledAhead) {
  std::vector<CompileJob> jobs = adding_jobs(2);
  compile_ahead(device_, jobs);
  EXPECT_TRUE(compile_ahead(device_, jobs).empty());
  const test::ScopedVariable elsewhere("CAPLET_CACHE", test::temporary_folder().string());
  for (const CompileJob& job : jobs) EXPECT_FALSE(is_cached(device_, job));
  const test::ScopedVariable alone("CAPLET_COMPILERS", "1");
  EXPECT_TRUE(compile_ahead(device_, jobs).empty());
  for (const CompileJob& job : jobs) EXPECT_FALSE(is_cached(device_, job));
  compile(device_, jobs[0]);
  EXPECT_TRUE(is_cached(device_, jobs[0]));
  CompileJob other = jobs[0];
  other.options = "-DSTEP=5";
  EXPECT_FALSE(is_cached(device_, other));
  other = jobs[0];
  other.local_size = 2;
  EXPECT_NE(is_cached(device_, other), device_.is_pocl());
  other = jobs[0];
  other.source += " ";
  EXPECT_FALSE(is_cached(device_, other));
}

TEST_F(CompilersTest, TheirNumberIsToldByTheVariable) {
  const auto count = [](const char* text) {
    const test::ScopedVariable variable("CAPLET_COMPILERS", text);
    return compiler_count();
  };
  EXPECT_EQ(count("1"), 1u);
  EXPECT_EQ(count("64"), 64u);
  for (const char* wrong : {"0", "65", "-1", "two", "2 ", "1.5", "99999999999999999999"})
    EXPECT_THROW(count(wrong), InputError) << wrong;
  EXPECT_LE(count(""), 8u);
  set_compiler_program("");
  EXPECT_EQ(count("64"), 1u);
  EXPECT_THROW(count("two"), InputError);
}

TEST(CompileJobs, OtherFilesAreRefused) {
  const fs::path folder = test::temporary_folder();
  std::string text(4096, '\0');
  const auto expect_refused = [&](const std::string& contents) {
    std::ofstream(folder / "list", std::ios::binary) << contents;
    const int file = ::open((folder / "list").c_str(), O_RDWR);
    EXPECT_THROW(compile_jobs_of(file), InputError) << contents.size();
    ::close(file);
  };
  expect_refused("");
  expect_refused(text);
  text.replace(0, 15, "caplet compile1");
  text.replace(48, 8, std::string(8, '\x7f'));  // the number of jobs
  expect_refused(text);
  expect_refused(text.substr(0, 40));
  const int nothing = ::open("/dev/null", O_RDWR);
  EXPECT_THROW(compile_jobs_of(nothing), InputError);
  ::close(nothing);
}

}  // namespace
}  // namespace caplet
