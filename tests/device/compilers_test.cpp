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
      EXPECT_EQ(buffer.read(), std::vector<cl_uint>(6, narrow<cl_uint>(100 + 10 * i + 1)));
    }
  }
  Device device_ = test::test_device();
};

TEST_F(CompilersTest, AnotherProcessCompilesAll) {
  const std::vector<CompileJob> jobs = adding_jobs(3);
  Compilers compilers(device_, jobs, 1);
  ASSERT_EQ(compilers.process_count(), 1u);
  compilers.wait();
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    ASSERT_TRUE(compilers.seconds(i).has_value()) << i;
    EXPECT_LT(0, *compilers.seconds(i)) << i;
  }
  EXPECT_EQ(compilers.take(), std::nullopt);
  expect_results(jobs);
}

TEST_F(CompilersTest, EachJobIsTakenOnce) {
  const std::vector<CompileJob> jobs = adding_jobs(8);
  std::vector<bool> here(jobs.size());
  Compilers compilers(device_, jobs, 2);
  while (const auto job = compilers.take()) {
    ASSERT_LT(*job, jobs.size());
    EXPECT_FALSE(here[*job]);
    here[*job] = true;
    compile(device_, jobs[*job]);
  }
  compilers.wait();
  EXPECT_TRUE(here.front());  // processes take a while to begin
  for (std::size_t i = 0; i < jobs.size(); ++i)
    EXPECT_NE(compilers.seconds(i).has_value(), here[i]) << i;
  expect_results(jobs);
}

TEST_F(CompilersTest, JobsOfAProcessThatFailsAreLeft) {
  std::vector<CompileJob> jobs = adding_jobs(3);
  jobs[1].source = "this is no kernel";
  Compilers compilers(device_, jobs, 1);
  compilers.wait();
  EXPECT_TRUE(compilers.seconds(0).has_value());
  EXPECT_FALSE(compilers.seconds(1).has_value());
  EXPECT_EQ(compilers.take(), 2u);
  EXPECT_THROW(compile(device_, jobs[1]), RunError);
}

TEST_F(CompilersTest, WithoutProcessesAllIsLeft) {
  for (const char* program : {"/bin/false", "/does/not/exist", ""}) {
    set_compiler_program(program);
    const std::vector<CompileJob> jobs = adding_jobs(2);
    Compilers compilers(device_, jobs, 2);
    compilers.wait();
    EXPECT_EQ(compilers.take(), 0u) << program;
    EXPECT_EQ(compilers.take(), 1u) << program;
    EXPECT_EQ(compilers.take(), std::nullopt) << program;
    EXPECT_EQ(compilers.seconds(0), std::nullopt) << program;
  }
}

TEST_F(CompilersTest, AnInterruptEndsThem) {
  const std::vector<CompileJob> jobs = adding_jobs(4);
  Compilers compilers(device_, jobs, 2);
  set_interrupt_requested(true);
  EXPECT_THROW(compilers.wait(), RunError);
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
