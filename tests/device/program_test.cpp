// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Programs and launches: results, build errors, the cache of binaries.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "device/device.h"
#include "device/pocl_needs.h"
#include "support/data.h"
#include "support/environment.h"
#include "support/test_device.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

const std::string count_up =
    "__kernel void count_up(__global uint* x, uint n) { const uint i = (uint)get_global_id(0); if "
    "(i < n) x[i] += STEP + i; }";

/// x of `n` counted, all `size` values.
std::vector<cl_uint> run(const Device& device, const Program& program, cl_uint n, std::size_t size,
                         std::size_t local) {
  Buffer<cl_uint> buffer(device, size);
  buffer.write(std::vector<cl_uint>(size, 0));
  cl::Kernel kernel = program.kernel("count_up");
  set_arguments(device, kernel, buffer, n);
  launch(device, kernel, n, local);
  return buffer.read();
}

template <class Function>
std::string error_of(Function&& function) {
  try {
    function();
  } catch (const RunError& error) {
    return error.what();
  }
  return "no error";
}

class ProgramTest : public testing::Test {
 protected:
  Program build(const std::string& options = "-DSTEP=10") {
    return Program::from_source(device_, "count_up", count_up, options, BinaryCache::always);
  }
  fs::path only_file() const {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
      files.push_back(entry.path());
    EXPECT_EQ(files.size(), 1u);
    return files.at(0);
  }

  fs::path folder_ = test::temporary_folder();
  test::ScopedVariable cache_{"CAPLET_CACHE", folder_.string()};
  Device device_ = test::test_device(Encoding::automatic);
};

TEST_F(ProgramTest, LaunchesRoundUpAndKernelsCheckTheirIndex) {
  const Program program = build();
  EXPECT_EQ(run(device_, program, 3, 5, 4), (std::vector<cl_uint>{10, 11, 12, 0, 0}));
  EXPECT_EQ(run(device_, program, 4, 5, 4), (std::vector<cl_uint>{10, 11, 12, 13, 0}));
  EXPECT_EQ(run(device_, program, 5, 5, 1), (std::vector<cl_uint>{10, 11, 12, 13, 14}));
  EXPECT_EQ(run(device_, program, 0, 2, 4), (std::vector<cl_uint>{0, 0}));
}

TEST_F(ProgramTest, AGroupOfNothingIsRefused) {
  cl::Kernel kernel = build().kernel("count_up");
  EXPECT_THROW(launch(device_, kernel, 1, 0), std::logic_error);
  EXPECT_THROW(launch_items(device_, kernel, 1, 0), std::logic_error);
}

/// Returns a program whose kernel counts how often each item is done, as stages do their items.
Program items_program(const Device& device, const std::string& kernel, const std::string& defines) {
  return Program::from_source(
      device, kernel,
      defines +
          flatten_kernels("typedef struct { __global uint* x; } Stage;\n"
                          "void stage_item(const Stage* s, uint item) { s->x[item] += 1u; }\n"
                          "void stage_share(const Stage* s, uint first, uint end) {\n"
                          "  for (uint item = first; item < end; ++item) stage_item(s, item);\n"
                          "}\n"
                          "__kernel void " +
                          kernel +
                          "(__global uint* x, uint item_count) {\n"
                          "const Stage stage = {x};\n"
                          "#include \"stages/items.cl\"\n}\n"),
      "");
}

TEST_F(ProgramTest, ItemsAreDoneOnce) {
  const Program program = items_program(device_, "do_items", "");
  for (const std::size_t local : {1u, 24u, 64u})
    for (const std::size_t first : {0u, 5u})
      for (const std::size_t count : {1u, 64u, 32767u, 32768u, 32769u, 65536u, 65537u, 200001u}) {
        SCOPED_TRACE(fmt::format("{} items from {} in groups of {}", count, first, local));
        std::vector<cl_uint> expected(first + count + 5000, 0);
        Buffer<cl_uint> done(device_, expected.size());
        done.write(expected);
        std::fill_n(expected.begin() + static_cast<std::ptrdiff_t>(first), count, 1);
        cl::Kernel kernel = program.kernel("do_items");
        set_arguments(device_, kernel, done, static_cast<cl_uint>(first + count));
        launch_items(device_, kernel, count, local, first);
        EXPECT_EQ(done.read() == expected, true);
      }
}

TEST_F(ProgramTest, SharesHoldEachItemOnce) {
  const Program program = items_program(device_, "do_shares", "#define STAGE_TAKES_SHARES\n");
  // The last of these makes more shares than fit into a row.
  for (const std::size_t count : {1u, 127u, 128u, 100000u, 40000u * 1024u}) {
    Buffer<cl_uint> done(device_, count + 1);
    std::vector<cl_uint> expected(count + 1, 0);
    done.write(expected);
    std::fill_n(expected.begin(), count, 1);
    cl::Kernel kernel = program.kernel("do_shares");
    set_arguments(device_, kernel, done, static_cast<cl_uint>(count));
    launch_shares(device_, kernel, count);
    EXPECT_EQ(done.read() == expected, true) << count;
  }
}

TEST_F(ProgramTest, PoclCompilesAKernelOnceForAllCounts) {
  if (!device_.is_pocl()) GTEST_SKIP() << "the device is not of PoCL";
  const fs::path cache = pocl_cache_folder([](const std::string& name) {
    const char* value = std::getenv(name.c_str());
    return std::string(value ? value : "");
  });
  if (!fs::exists(cache)) GTEST_SKIP() << "PoCL keeps no kernels in '" << cache.string() << "'";
  // PoCL keeps a kernel as PROGRAM/KERNEL/GROUP-SIZE-AND-GRID/KERNEL.so.
  const std::string name =
      fmt::format("do_{}", std::chrono::steady_clock::now().time_since_epoch().count());
  Program program = items_program(device_, name, "");
  program.prepare(name, 64);
  for (const std::size_t count : {64u, 70000u, 300000u}) {
    Buffer<cl_uint> done(device_, count);
    cl::Kernel kernel = program.kernel(name);
    set_arguments(device_, kernel, done, static_cast<cl_uint>(count));
    launch_items(device_, kernel, count, 64);
    device_.finish();
  }
  const auto kept = std::ranges::count_if(
      fs::recursive_directory_iterator(cache),
      [&](const fs::directory_entry& entry) { return entry.path().filename() == name + ".so"; });
  EXPECT_EQ(kept, 1);
}

TEST_F(ProgramTest, OptionsAreDefinitions) {
  EXPECT_EQ(run(device_, build("-DSTEP=7"), 1, 1, 1), std::vector<cl_uint>{7});
}

TEST_F(ProgramTest, PrepareChangesNothing) {
  Program program = build();
  const double before = program.build_seconds();
  const double seconds = program.prepare("count_up", 4);
  EXPECT_EQ(program.build_seconds(), before + seconds);
  EXPECT_EQ(seconds > 0, device_.is_pocl());
  EXPECT_EQ(run(device_, program, 2, 3, 4), (std::vector<cl_uint>{10, 11, 0}));
}

TEST_F(ProgramTest, BuildErrorsCarryTheLogWithTheKernelFile) {
  const fs::path kernels = test::temporary_folder();
  fs::create_directories(kernels / "stages");
  fs::create_directories(kernels / "math");
  std::ofstream(kernels / "stages" / "broken.cl")
      << "#include \"math/wrong.cl\"\n__kernel void broken() {}\n";
  std::ofstream(kernels / "math" / "wrong.cl")
      << "static int fine(void) { return 1; }\nstatic int wrong(void) { return nothing; }\n";
  const test::ScopedVariable variable("CAPLET_KERNELS", kernels.string());
  EXPECT_THAT(error_of([&] { Program(device_, "broken", "-DOPTION=1"); }),
              AllOf(HasSubstr("program 'broken'"), HasSubstr("CL_BUILD_PROGRAM_FAILURE"),
                    HasSubstr("kernels/math/wrong.cl:2"), HasSubstr("nothing"),
                    HasSubstr("-DOPTION=1"), HasSubstr(device_.info().name)));
}

TEST_F(ProgramTest, MissingKernelsAndWrongArgumentsAreNamed) {
  const Program program = build();
  EXPECT_THAT(error_of([&] { program.kernel("other"); }),
              AllOf(HasSubstr("kernel 'other' of program 'count_up'"),
                    HasSubstr("CL_INVALID_KERNEL_NAME")));
  cl::Kernel kernel = program.kernel("count_up");
  EXPECT_THAT(
      error_of([&] {
        set_arguments(device_, kernel, Buffer<cl_uint>(device_, 1), cl_uint{1}, cl_uint{1});
      }),
      AllOf(HasSubstr("argument 2 of kernel 'count_up'"), HasSubstr("CL_INVALID_ARG_INDEX")));
  cl::Kernel bare = program.kernel("count_up");
  EXPECT_THAT(
      error_of([&] { launch(device_, bare, 1, 1); }),
      AllOf(HasSubstr("kernel 'count_up' over 1 work-items"), HasSubstr("CL_INVALID_KERNEL_ARGS")));
}

TEST_F(ProgramTest, TheSecondBuildComesFromTheCache) {
  EXPECT_FALSE(build().from_cache());
  const Program again = build();
  EXPECT_TRUE(again.from_cache());
  EXPECT_EQ(run(device_, again, 2, 2, 2), (std::vector<cl_uint>{10, 11}));
  EXPECT_FALSE(build("-DSTEP=20").from_cache());
  EXPECT_FALSE(
      Program::from_source(device_, "count_up", count_up + "\n", "-DSTEP=10", BinaryCache::always)
          .from_cache());
}

TEST_F(ProgramTest, ABrokenCacheFileIsIgnoredAndReplaced) {
  build();
  const fs::path file = only_file();
  fs::resize_file(file, fs::file_size(file) / 2);
  EXPECT_FALSE(build().from_cache());
  EXPECT_TRUE(build().from_cache());
  std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).seekp(300).put('~').put('~');
  const Program rebuilt = build();
  EXPECT_FALSE(rebuilt.from_cache());
  EXPECT_EQ(run(device_, rebuilt, 1, 1, 1), std::vector<cl_uint>{10});
}

TEST_F(ProgramTest, AnUnusableCacheFolderIsNoError) {
  std::ofstream(folder_ / "file") << "in the way";
  const test::ScopedVariable variable("CAPLET_CACHE", (folder_ / "file").string());
  EXPECT_EQ(run(device_, build(), 1, 1, 1), std::vector<cl_uint>{10});
  EXPECT_FALSE(build().from_cache());
}

cl_program handle_of(const Program& program) {
  return program.kernel("count_up").getInfo<CL_KERNEL_PROGRAM>()();
}

TEST_F(ProgramTest, DevicesOfPoclShareWhatTheyCompile) {
  CAPLET_NEEDS_POCL();
  const Device other = test::test_device(Encoding::automatic);
  EXPECT_EQ(other.context()(), device_.context()());
  EXPECT_NE(other.queue()(), device_.queue()());
  const std::uint64_t before = device_.bytes_allocated();
  const Buffer<cl_uint> buffer(other, 1000);
  EXPECT_EQ(device_.bytes_allocated(), before);
  const Program here = Program::from_source(device_, "count_up", count_up, "-DSTEP=1"),
                there = Program::from_source(other, "count_up", count_up, "-DSTEP=1"),
                unlike = Program::from_source(other, "count_up", count_up, "-DSTEP=2");
  EXPECT_EQ(handle_of(here), handle_of(there));
  EXPECT_NE(handle_of(here), handle_of(unlike));
  EXPECT_EQ(run(other, there, 1, 2, 1), (std::vector<cl_uint>{1, 0}));
  EXPECT_EQ(run(other, unlike, 1, 2, 1), (std::vector<cl_uint>{2, 0}));
  if (device_.info().compute_units < 2) return;
  for (const Device& part : device_.split(2)) EXPECT_NE(part.context()(), device_.context()());
}

TEST_F(ProgramTest, TheOneUsedLongestAgoIsDropped) {
  CAPLET_NEEDS_POCL();
  constexpr int most = 64;
  const auto of_step = [&](int step) {
    return Program::from_source(device_, "count_up", count_up, fmt::format("-DSTEP={}", step));
  };
  const Program first = of_step(1), second = of_step(2), third = of_step(3);
  for (int step = 4; step <= most; ++step) of_step(step);
  EXPECT_EQ(handle_of(of_step(1)), handle_of(first));
  of_step(most + 1);
  EXPECT_EQ(handle_of(of_step(1)), handle_of(first));
  EXPECT_EQ(handle_of(of_step(3)), handle_of(third));
  EXPECT_NE(handle_of(of_step(2)), handle_of(second));
}

TEST_F(ProgramTest, PoclKeepsItsOwnCache) {
  CAPLET_NEEDS_POCL();
  Program::from_source(device_, "count_up", count_up, "-DSTEP=1");
  EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace caplet
