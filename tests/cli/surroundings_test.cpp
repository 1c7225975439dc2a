// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Machines that lack something: cache folders that cannot be written, files in the way, no /sys.
// Runs go on, and name what it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "film/image.h"
#include "program.h"
#include "support/data.h"
#include "support/test_device.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using test::Result;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr int not_permitted = 125;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

/// Where PoCL keeps kernels on this machine, so that they need not be compiled anew.
fs::path kernels_of_pocl() {
  if (const std::string named = variable("POCL_CACHE_DIR"); !named.empty()) return named;
  if (const std::string base = variable("XDG_CACHE_HOME"); !base.empty())
    return fs::path(base) / "pocl/kcache";
  return fs::path(variable("HOME")) / ".cache/pocl/kcache";
}

class Lacking : public testing::Test {
 protected:
  void SetUp() override {
    const fs::path own = temporary_ / ("caplet-" + std::to_string(::geteuid()));
    fs::create_directories(own);
    ASSERT_EQ(::chmod(own.c_str(), 0700), 0);
    fs::create_directories(kernels_of_pocl());
    fs::create_symlink(kernels_of_pocl(), own / "pocl");
  }
  Result render(std::map<std::string, std::string> environment,
                const std::function<void()>& in_child = {}) const {
    environment["TMPDIR"] = temporary_.string();
    Result out = test::run_program({"render", "scene.pbrt", "-q", "-o", "out.exr"}, folder_,
                                   environment, in_child);
    if (out.code != 0) return out;
    EXPECT_EQ(read_exr(folder_ / "out.exr").width, 24);
    return out;
  }

  const fs::path folder_ = test::folder_with_scene(), temporary_ = test::temporary_folder();
};

TEST_F(Lacking, AFileOfTheCacheThatIsAFolder) {
  const fs::path cache = test::temporary_folder();
  const std::map<std::string, std::string> with{{"CAPLET_CACHE", cache.string()}};
  ASSERT_EQ(render(with).code, 0);
  std::vector<std::string> names;
  for (const std::string& name : test::names_in(cache)) {
    fs::remove(cache / name);
    fs::create_directories(cache / name / "in the way");
    names.push_back("'" + (cache / name).string() + "' is a folder");
  }
  ASSERT_FALSE(names.empty());
  const Result result = render(with);
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(std::ranges::any_of(names, [&](const std::string& name) {
    return result.err.find(name) != std::string::npos;
  })) << result.err;
}

TEST_F(Lacking, ACacheThatCannotBeWritten) {
  const Result result = render({{"CAPLET_CACHE", "/proc/caplet"}});
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.err, AllOf(HasSubstr("nothing can be kept in the cache: /proc/caplet"),
                                HasSubstr("CAPLET_CACHE")));
}

TEST_F(Lacking, AFolderThatPoclCannotWrite) {
  CAPLET_NEEDS_POCL();
  const Result result = render({{"POCL_CACHE_DIR", "/proc/kernels"}});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err,
              AllOf(HasSubstr("PoCL's cache folder /proc/kernels cannot be used (/proc: "),
                    HasSubstr(temporary_.string()), HasSubstr("POCL_CACHE_DIR")));
  EXPECT_EQ(result.err.find("POCL_CACHE_DIR"), result.err.rfind("POCL_CACHE_DIR"))
      << result.err;  // once
  const Result devices =
      test::run_program({"devices", "--json"}, folder_, {{"POCL_CACHE_DIR", "/proc/kernels"}});
  EXPECT_THAT(devices.out, HasSubstr("Portable Computing Language"));
}

TEST_F(Lacking, AHomeThatCannotBeWritten) {
  CAPLET_NEEDS_POCL();
  const Result result = render({{"HOME", "/proc/home"},
                                {"XDG_CACHE_HOME", ""},
                                {"POCL_CACHE_DIR", ""},
                                {"CAPLET_CACHE", ""}});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, AllOf(HasSubstr("/proc/home/.cache/pocl/kcache"),
                                HasSubstr("/proc/home/.cache/caplet")));
}

TEST_F(Lacking, AnyFolderForPocl) {
  CAPLET_NEEDS_POCL();
  fs::remove_all(temporary_);  // nor for temporary files
  const Result result =
      test::run_program({"render", "scene.pbrt", "-q", "-o", "out.exr"}, folder_,
                        {{"POCL_CACHE_DIR", "/proc/kernels"}, {"TMPDIR", temporary_.string()}});
  EXPECT_NE(result.code, 0);
  EXPECT_THAT(result.err, AllOf(HasSubstr("PoCL's cache folder /proc/kernels cannot be used"),
                                HasSubstr("nor can a temporary one")));
  EXPECT_EQ(test::names_in(folder_), std::vector<std::string>{"scene.pbrt"});
  const Result doctor =
      test::run_program({"doctor", "--timeout", "100"}, folder_,
                        {{"POCL_CACHE_DIR", "/proc/kernels"}, {"TMPDIR", temporary_.string()}});
  EXPECT_THAT(doctor.out, HasSubstr("/proc/kernels cannot be used"));
}

/// An empty folder in place of /sys, as in some containers.
void without_sys() {
  const int spaces = ::geteuid() == 0 ? CLONE_NEWNS : CLONE_NEWNS | CLONE_NEWUSER;
  if (::unshare(spaces) != 0 || ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
      ::mount("none", "/sys", "tmpfs", 0, nullptr) != 0)
    ::_exit(not_permitted);
}

TEST_F(Lacking, ASysThatIsNotMounted) {
  CAPLET_NEEDS_POCL();
  const Result result = render({}, without_sys);
  if (result.code == not_permitted)
    GTEST_SKIP() << "NO NAMESPACE OF ITS OWN FOR /sys: a machine without it is not tried";
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("/sys/devices/system/cpu is not there"));
  const Result doctor = test::run_program({"doctor", "--timeout", "100"}, folder_, {}, without_sys);
  EXPECT_EQ(doctor.code, 0) << doctor.out;
  EXPECT_THAT(doctor.out, AllOf(HasSubstr("note   /sys: devices/system/cpu is not there"),
                                HasSubstr("mount -t sysfs"), HasSubstr("passes the self-test")));
}

}  // namespace
}  // namespace caplet
