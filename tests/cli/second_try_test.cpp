// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// PoCL's cache damaged in several ways: each run ends well all the same, and the folder to delete
// is named.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "film/image.h"
#include "program.h"
#include "support/data.h"
#include "support/sanitized.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using test::Result;
using testing::AllOf;
using testing::HasSubstr;

class SecondTry : public testing::Test {
 protected:
  /// A cache that holds what the commands below need: made by the first test of this build, for
  /// those in other processes too.
  static void SetUpTestSuite() {
    const fs::path lock = good().string() + ".lock", made = good() / "made";
    const int file = ::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    ASSERT_EQ(::flock(file, LOCK_EX), 0) << lock;
    if (!fs::exists(made) || fs::last_write_time(made) < fs::last_write_time(CAPLET_PROGRAM)) {
      fs::remove_all(good());
      fs::create_directory(good());
      const fs::path folder = test::temporary_folder();
      for (const auto& arguments : commands(folder))
        test::run_program(arguments, folder, in(good()));
      test::write_file(made, "");
    }
    ::close(file);
  }
  void SetUp() override {
    bool any = false;
    for (const auto& entry : fs::recursive_directory_iterator(good()))
      any = any || entry.path().extension() == ".so";
    if (!any) GTEST_SKIP() << "needs PoCL, with a cache of shared objects";
    write_scene(folder_);
    fs::copy(good(), bad(), fs::copy_options::recursive);
  }

  static void write_scene(const fs::path& folder) {
    test::write_file(
        folder / "scene.pbrt",
        "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n"
        "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n"
        "Sampler \"independent\" \"integer pixelsamples\" 2\nWorldBegin\nLightSource \"infinite\"\n"
        "Shape \"sphere\"\n");
    test::write_file(folder / "rays.txt", "0 0 5 0 0 -1\n0 0.1 5 0 0 -1\n");
  }
  static std::vector<std::vector<std::string>> commands(const fs::path& folder) {
    write_scene(folder);
    return {{"render", "scene.pbrt", "-q", "-o", "out.exr"},
            {"pick", "scene.pbrt", "-q", "--rays", "rays.txt", "--out", "out.csv"},
            {"doctor", "--timeout", "100"}};
  }
  static fs::path good() {
    static const fs::path folder =
        fs::path(CAPLET_PROGRAM).parent_path().parent_path() / "second-try-cache";
    return folder;
  }
  fs::path bad() const { return folder_ / "bad"; }
  static std::map<std::string, std::string> in(const fs::path& cache) {
    return {{"POCL_CACHE_DIR", cache.string()}, {"CAPLET_CACHE", (good() / "caplet").string()}};
  }

  /// Every file of that extension keeps this share of its bytes.
  void cut(const std::string& extension, double share) const {
    for (const auto& entry : fs::recursive_directory_iterator(bad()))
      if (entry.path().extension() == extension)
        fs::resize_file(entry.path(), static_cast<std::uintmax_t>(
                                          share * static_cast<double>(entry.file_size())));
  }
  void expect_named(const Result& result) const {
    EXPECT_EQ(result.code, 0) << result.err << " signal " << result.signal;
    EXPECT_THAT(result.err, AllOf(HasSubstr("trying once more with a fresh cache folder"),
                                  HasSubstr("delete it (rm -r '" + bad().string() + "')")));
  }
  Result render() const {
    return test::run_program({"render", "scene.pbrt", "-q", "-o", "out.exr"}, folder_, in(bad()));
  }

  const fs::path folder_ = test::temporary_folder();
};

// Seen with PoCL 3.1: SIGABRT, SIGBUS, CL_INVALID_KERNEL_NAME.
TEST_F(SecondTry, AfterEmptyKernels) {
  cut(".so", 0);
  expect_named(render());
  EXPECT_EQ(read_exr(folder_ / "out.exr").data_width, 8);
}

TEST_F(SecondTry, AfterKernelsCutInHalf) {
  if (test::sanitized) GTEST_SKIP() << "sanitizers take the signal";
  cut(".so", 0.5);
  expect_named(render());
}

TEST_F(SecondTry, AfterEmptyPrograms) {
  cut(".bc", 0);
  expect_named(render());
}

TEST_F(SecondTry, OfPickLeavesTheWholeTable) {
  cut(".so", 0);
  expect_named(test::run_program(
      {"pick", "scene.pbrt", "-q", "--rays", "rays.txt", "--out", "out.csv"}, folder_, in(bad())));
  EXPECT_EQ(test::lines_of(test::read_file(folder_ / "out.csv")).size(), 3u);
  EXPECT_EQ(test::names_in(folder_),
            (std::vector<std::string>{"bad", "out.csv", "rays.txt", "scene.pbrt"}));
}

TEST_F(SecondTry, DoctorNamesTheFolder) {
  cut(".so", 0);
  const Result result = test::run_program({"doctor", "--timeout", "100"}, folder_, in(bad()));
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.out, AllOf(HasSubstr("wrong  PoCL's cache: " + bad().string() + " is damaged"),
                                HasSubstr("fix: rm -r '" + bad().string() + "'")));
}

TEST_F(SecondTry, IsNotMadeWhereNothingIsDamaged) {
  const Result result = render();
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err, "");
}

}  // namespace
}  // namespace caplet
