// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The built program's `verify` on every push: a million rays through the torture set, and some
// through every scene there is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "import/import.h"
#include "program.h"
#include "support/data.h"
#include "support/sanitized.h"
#include "support/thorough.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;

// The program is killed after 300 s: what ctest gives a test is not reached.
void expect_agreement(std::vector<std::string> arguments, std::uint64_t rays) {
  arguments.insert(arguments.begin(), "verify");
  arguments.insert(arguments.end(), {"--rays", std::to_string(rays), "--json"});
  const test::Result result = test::Running(arguments, test::temporary_folder()).wait(300);
  ASSERT_EQ(result.code, 0) << result.out << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("rays"), rays);
  EXPECT_GT(json.at("hits").get<std::uint64_t>(), rays / 20);
  EXPECT_EQ(json.at("disagreements"), 0);
  EXPECT_EQ(json.at("verdict"), "agrees");
}

// All of its scenes, of 250,000 rays each; the first one alone under sanitizers.
TEST(VerifyTortureSet, ManyRays) {
  expect_agreement({}, test::sanitized ? 20'000 : test::thorough() ? 1'000'000 : 50'000);
}

/// Every file of scenes/ that an importer knows, relative to it.
std::vector<std::string> scene_files() {
  const fs::path folder = test::source_folder() / "scenes";
  std::vector<std::string> out;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    for (const Format& format : formats())
      for (const std::string& extension : format.extensions)
        if (entry.path().native().ends_with(extension))
          out.push_back(fs::relative(entry.path(), folder).string());
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());  // of endings that formats share
  return out;
}

class VerifyScenes : public testing::TestWithParam<std::string> {};

TEST_P(VerifyScenes, Agrees) {
  expect_agreement({(test::source_folder() / "scenes" / GetParam()).string()},
                   test::sanitized    ? 2'000
                   : test::thorough() ? 20'000
                                      : 8'000);
}

INSTANTIATE_TEST_SUITE_P(Files, VerifyScenes, testing::ValuesIn(scene_files()),
                         [](const auto& parameter) {
                           std::string name = parameter.param;
                           for (char& c : name)
                             if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
                           return name;
                         });

TEST(VerifyScenes, ThereAreScenesOfEveryFormat) {
  const std::vector<std::string> files = scene_files();
  for (const char* extension : {".pbrt", ".swc", ".capsules"})
    EXPECT_THAT(files, testing::Contains(testing::EndsWith(extension)));
}

// 28,929 capsules: the tree is deeper than that of any scene of the repository.
TEST(VerifyData, ALargeNeuron) {
  CAPLET_NEEDS_DATA();
  expect_agreement({(test::data_folder() / "swc/neuromorpho_large/173000.swc").string()},
                   test::sanitized ? 500 : 20'000);
}

}  // namespace
}  // namespace caplet
