// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The driver of a portable installation, for which this machine's PoCL stands here: in a folder of
// links, with a linker that leaves a trace.
#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <link.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "device/pocl_needs.h"
#include "program.h"
#include "support/data.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using test::Result;
using testing::EndsWith;
using testing::HasSubstr;

/// The folder of the machine's PoCL library; empty: there is none.
fs::path folder_of_pocl() {
  void* const library = ::dlopen("libpocl.so.2", RTLD_LAZY | RTLD_LOCAL);
  link_map* map = nullptr;
  if (library == nullptr || ::dlinfo(library, RTLD_DI_LINKMAP, &map) != 0) return {};
  return fs::canonical(map->l_name).parent_path();
}

class Bundled : public testing::Test {
 protected:
  void SetUp() override {
    const fs::path pocl = folder_of_pocl(), library = driver_ / "lib/caplet";
    if (pocl.empty() || !fs::exists(pocl / "../../share/pocl"))
      GTEST_SKIP() << "needs a PoCL that can be moved (libpocl.so.2)";
    fs::create_directories(library);
    fs::create_directories(driver_ / "share");
    fs::create_directories(driver_ / "bin");
    fs::create_symlink(pocl / "libpocl.so.2", library / "libpocl-caplet.so.2");
    fs::create_symlink(pocl / "pocl", library / "pocl");
    fs::create_symlink(fs::canonical(pocl / "../../share/pocl"), driver_ / "share/pocl");
    test::write_file(driver_ / "bin/ld", "#!/bin/sh\ntouch '" + trace_.string() +
                                             "'\nPATH=${PATH#*:}\nexec ld \"$@\"\n");
    fs::permissions(driver_ / "bin/ld", fs::perms::owner_all);
    fs::create_directories(none_);
  }
  /// `kernels`: POCL_CACHE_DIR.
  Result run(const std::vector<std::string>& arguments, const std::string& kernels = "") const {
    return test::run_program(arguments, folder_,
                             {{"CAPLET_BUNDLED_DRIVER", driver_.string()},
                              {"OCL_ICD_VENDORS", none_.string()},
                              {"POCL_CACHE_DIR", kernels},
                              {"CAPLET_CACHE", cache_.string()}});
  }

  const fs::path folder_ = test::folder_with_scene(), temporary_ = test::temporary_folder();
  const fs::path driver_ = temporary_ / "pocl", none_ = temporary_ / "none",
                 cache_ = temporary_ / "cache", trace_ = temporary_ / "linked";
};

TEST_F(Bundled, IsListedAsSuch) {
  const Result result = run({"devices", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  const auto devices = nlohmann::json::parse(result.out);
  ASSERT_EQ(devices.size(), 1u);
  EXPECT_EQ(devices[0].at("bundled"), true);
  EXPECT_EQ(devices[0].at("index"), 0);
  EXPECT_THAT(devices[0].at("platform").get<std::string>(), EndsWith(", bundled with Caplet"));
}

TEST_F(Bundled, CompilesWithItsOwnLinkerAndCache) {
  const Result result = run({"pick", "scene.pbrt", "--pixel", "3,3"});  // the fewest kernels
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(fs::exists(trace_));
  ASSERT_TRUE(fs::is_directory(cache_ / "pocl"));
  EXPECT_FALSE(fs::is_empty(cache_ / "pocl"));
}

TEST_F(Bundled, MakesAMachineWithoutDriversAWholeOne) {
  // The machine's own cache saves compiling all kernels once more.
  const Result result =
      run({"doctor", "--timeout", "100"}, pocl_cache_folder([](const std::string& name) {
                                            const char* value = std::getenv(name.c_str());
                                            return std::string(value ? value : "");
                                          }).string());
  EXPECT_EQ(result.code, 0) << result.out;
  EXPECT_THAT(result.out, HasSubstr("no OpenCL driver is registered"));
  EXPECT_THAT(result.out, HasSubstr("the bundled one is used"));
  EXPECT_THAT(result.out, HasSubstr("bundled driver: the driver "));
  EXPECT_THAT(result.out, HasSubstr("passes the self-test"));
}

TEST_F(Bundled, OneThatCannotBeLoadedIsNamed) {
  fs::remove(driver_ / "lib/caplet/libpocl-caplet.so.2");
  test::write_file(driver_ / "lib/caplet/libpocl-caplet.so.2", "no library");
  const Result result = run({"render", "scene.pbrt", "-o", "out.exr"});
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, HasSubstr("the bundled OpenCL driver cannot be loaded: "));
  EXPECT_THAT(result.err, HasSubstr("no OpenCL device was found"));
}

}  // namespace
}  // namespace caplet
