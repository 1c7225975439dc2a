// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The first use of a device: what its driver does then is told. A driver that aborts is played by a
// kernel that does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "program.h"
#include "support/data.h"
#include "support/test_device.h"

namespace caplet::trial_test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

test::Result render(const fs::path& kernels, const std::vector<std::string>& more = {}) {
  const fs::path folder = test::temporary_folder();
  std::vector<std::string> words{
      "render", (test::source_folder() / "scenes" / "capsules.pbrt").string(),
      "-o",     "out.exr",
      "--size", "16x16",
      "--spp",  "1"};
  words.insert(words.end(), more.begin(), more.end());
  std::map<std::string, std::string> environment{{"CAPLET_CACHE", (folder / "cache").string()}};
  if (!kernels.empty()) environment["CAPLET_KERNELS"] = kernels.string();
  return test::run_program(words, folder, environment);
}

TEST(Trial, ADriverThatAbortsIsToldOf) {
  CAPLET_NEEDS_POCL();  // a trap of a GPU's is no signal
  const test::Result result = render(test::changed_kernels(
      "stages/extend.cl", "return g->rays.path_ray", "__builtin_trap(); return g->rays.path_ray"));
  EXPECT_EQ(result.code, 1) << result.err;
  EXPECT_EQ(result.signal, 0);
  EXPECT_THAT(result.err,
              AllOf(HasSubstr("its driver ended with signal"), HasSubstr("caplet doctor")));
}

TEST(Trial, WrongKernelsAreRefusedByShape) {
  const test::Result result = render(
      test::changed_kernels("trace/hits.cl", "hit.t = nearest->t;", "hit.t = 2.0f * nearest->t;"));
  EXPECT_EQ(result.code, 1) << result.err;
  EXPECT_THAT(result.err,
              AllOf(HasSubstr("computes wrongly"), HasSubstr("capsule: nearest crossing (extend)"),
                    HasSubstr("sphere: nearest crossing (extend)")));
}

// Camera rays go through the tree by another text where the device tests eight boxes at a time.
TEST(Trial, CameraRaysAreTriedByThemselves) {
  const fs::path kernels =
      test::changed_kernels("trace/stream.cl", "hit_record(&nearest[i]);",
                            "hit_record(&nearest[i]);\n    if (hit.surface == 0) continue;");
  // Whatever this processor is good at.
  test::write_file(kernels / "trace" / "eight.cl",
                   "#define CAPLET_PORTABLE\n" + test::read_file(kernels / "trace" / "eight.cl"));
  const test::Result result = render(kernels, {"--encoding", "wide"});
  EXPECT_EQ(result.code, 1) << result.err;
  EXPECT_THAT(result.err, AllOf(HasSubstr("capsule: nearest crossing (extend_camera)"),
                                Not(HasSubstr("(extend):"))));
}

TEST(Trial, IsMadeOnceForEachEncoding) {
  const test::Result wrong = render({}, {"--encoding", "narrow"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, AllOf(HasSubstr("--encoding"),
                               HasSubstr("'narrow' is not automatic, wide or single")));
  const fs::path cache = test::temporary_folder();
  const auto tested = [&](const std::string& encoding) {
    const test::Result result =
        test::run_program({"pick", (test::source_folder() / "scenes" / "capsules.pbrt").string(),
                           "--pixel", "3,3", "--encoding", encoding},
                          test::temporary_folder(), {{"CAPLET_CACHE", cache.string()}});
    EXPECT_EQ(result.code, 0) << result.err;
    return result.err.find("once, and compiling for it") != std::string::npos;
  };
  EXPECT_TRUE(tested("wide"));
  EXPECT_FALSE(tested("wide"));
  EXPECT_TRUE(tested("single"));
  EXPECT_FALSE(tested("single"));
}

}  // namespace
}  // namespace caplet::trial_test
