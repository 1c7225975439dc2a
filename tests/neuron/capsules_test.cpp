// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// .capsules files: the grammar of docs/formats/capsules.md, large files in parallel, and bad input.
#include "import/detail/capsules.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "import/import.h"
#include "support/import_files.h"

namespace caplet {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct Asked {
  std::vector<std::string> names;
  std::vector<SourceLocation> places;
  std::uint32_t operator()(const std::string& name, const SourceLocation& where) {
    names.push_back(name);
    places.push_back(where);
    return static_cast<std::uint32_t>(100 + names.size());
  }
};

CapsulesShape read_text(const std::string& text, Asked& asked) {
  return read_capsules(test::write_file("a.capsules", text), std::ref(asked));
}
CapsulesShape read_text(const std::string& text) {
  Asked asked;
  return read_text(text, asked);
}

TEST(Capsules, LinesMayBeSpacedAnyWay) {
  for (const char* text :
       {"<1, 2, 3> <4, 5, 6> 0.5\n", "<1,2,3><4,5,6>0.5",
        "# c\n\n  < 1 ,\t2 , 3 >  <4 ,5, 6 > .5 # end\r\n",
        "\xef\xbb\xbf<1, 2, 3> <4, 5, 6> +0.5\r", "<1e0, 2.0, 3> <4, 5, 6> 5e-1#x"}) {
    SCOPED_TRACE(text);
    const CapsulesShape capsules = read_text(text);
    EXPECT_EQ(capsules.p0, std::vector<glm::vec3>{glm::vec3(1, 2, 3)});
    EXPECT_EQ(capsules.p1, std::vector<glm::vec3>{glm::vec3(4, 5, 6)});
    EXPECT_EQ(capsules.radius0, std::vector<float>{0.5F});
    EXPECT_TRUE(capsules.radius1.empty());
    EXPECT_TRUE(capsules.materials.empty());
  }
}

TEST(Capsules, ASecondRadiusTapers) {
  const CapsulesShape capsules = read_text("<0,0,0> <0,0,1> 0.5 0.25\n<0,0,0> <0,0,1> 0.5\n");
  EXPECT_EQ(capsules.radius0, (std::vector<float>{0.5F, 0.5F}));
  EXPECT_EQ(capsules.radius1, (std::vector<float>{0.25F, 0.5F}));
}

TEST(Capsules, MaterialsAreAskedForOnceInOrderOfFirstUse) {
  Asked asked;
  const CapsulesShape capsules = read_text(
      "<0,0,0> <0,0,1> 1 steel\n<0,0,0> <0,0,1> 1 2 \"red wood\"\n\n<0,0,0> <0,0,1> 1\n<0,0,0> "
      "<0,0,1> 3 steel # again\n",
      asked);
  EXPECT_EQ(asked.names, (std::vector<std::string>{"steel", "red wood", ""}));
  EXPECT_EQ(capsules.materials, (std::vector<std::uint32_t>{101, 102, 103, 101}));
  EXPECT_EQ(asked.places[0].line, 1);
  EXPECT_EQ(asked.places[0].column, 19);
  EXPECT_EQ(asked.places[1].line, 2);
  EXPECT_EQ(asked.places[1].column, 21);
}

TEST(Capsules, WithoutNamesNothingIsAskedFor) {
  Asked asked;
  EXPECT_TRUE(read_text("<0,0,0> <0,0,1> 1\n", asked).materials.empty());
  EXPECT_TRUE(asked.names.empty());
}

TEST(Capsules, AnUnknownMaterialIsRefusedAtItsPlace) {
  const std::filesystem::path path =
      test::write_file("a.capsules", "\n<0,0,0> <0,0,1> 1 nothing\n");
  const auto refuse = [](const std::string& name, const SourceLocation& where) -> std::uint32_t {
    throw InputError(where, "no material " + name);
  };
  EXPECT_EQ(test::complaint([&] { read_capsules(path, refuse); }),
            path.string() + ":2:19: no material nothing");
}

// Several chunks (a megabyte each), with names and tapering in some of them: as the generator wrote
// it, with one thread and with four.
TEST(Capsules, LargeFilesDoNotDependOnThreads) {
  std::string text;
  constexpr int kCount = 60000;
  for (int i = 0; i < kCount; ++i)
    text += fmt::format("<{}, {}, {}> <{}, 0.125, -7> 0.5{}{}\n", i, i + 1, i + 2, -i,
                        i % 1000 == 999 ? " 0.25" : "",
                        i % 3 == 0 ? fmt::format(" m{}", i / 20000) : "");
  ASSERT_GT(text.size(), std::size_t{2} << 20);
  const std::filesystem::path path = test::write_file("large.capsules", text);
  for (const std::size_t threads : {std::size_t{1}, std::size_t{4}}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Asked asked;
    const CapsulesShape capsules = read_capsules(path, std::ref(asked));
    ASSERT_EQ(capsules.p0.size(), static_cast<std::size_t>(kCount));
    EXPECT_EQ(asked.names, (std::vector<std::string>{"m0", "", "m1", "m2"}));
    EXPECT_EQ(asked.places[3].line, 40003) << "40002 is the first multiple of 3 from 40000 on";
    for (int i = 0; i < kCount; ++i) {
      const auto k = static_cast<std::size_t>(i);
      ASSERT_EQ(capsules.p0[k], glm::vec3(i, i + 1, i + 2));
      ASSERT_EQ(capsules.p1[k], glm::vec3(-i, 0.125, -7));
      ASSERT_EQ(capsules.radius1[k], i % 1000 == 999 ? 0.25F : 0.5F);
      const std::uint32_t named[] = {101, 103, 104};
      ASSERT_EQ(capsules.materials[k], i % 3 == 0 ? named[i / 20000] : 102U) << i;
    }
  }
}

TEST(Capsules, ErrorsInLaterChunksHaveTheirLine) {
  std::string text;
  for (int i = 0; i < 100000; ++i) text += "<0, 0, 0> <0, 0, 1> 0.5\n";
  text += "<0, 0, 0> <0, 0, 1> nope\n";
  const std::filesystem::path path = test::write_file("late.capsules", text);
  EXPECT_EQ(test::complaint([&] { read_capsules(path, Asked()); }),
            path.string() + ":100001:21: 'nope' is not a number");
}

struct Bad {
  const char* name;
  std::string text;
  const char* place;
  const char* message;
};
void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }

class BadCapsules : public testing::TestWithParam<Bad> {};

TEST_P(BadCapsules, IsRefusedWithItsPlace) {
  const std::filesystem::path path = test::write_file("bad.capsules", GetParam().text);
  const std::string said = test::complaint([&] { read_capsules(path, Asked()); });
  EXPECT_THAT(said, StartsWith(path.string() + GetParam().place));
  EXPECT_THAT(said, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Texts, BadCapsules,
    testing::Values(
        Bad{"empty", "", ": ", "no capsules"}, Bad{"comments_only", "# a\n", ": ", "no capsules"},
        Bad{"no_bracket", "<9,9,9> <9,9,8> 1\n0 0 0 1 1 1 1\n",
            ":2:1: ", "expected '<' of the first point, not '0 0"},
        Bad{"no_comma", "<0 0, 0> <0,0,1> 1\n", ":1:4: ", "expected ',' of the first point"},
        Bad{"four_numbers", "<0,0,0,0> <0,0,1> 1\n", ":1:7: ", "expected '>' of the first point"},
        Bad{"one_point", "<0,0,0>\n", ":1:8: ", "'<' of the second point is missing"},
        Bad{"no_number", "<9,9,9> <9,9,8> 1\n<0,,0> <0,0,1> 1\n", ":2:4: ", "',' is not a number"},
        Bad{"word", "<9,9,9> <9,9,8> 1\n<0,a,0> <0,0,1> 1\n", ":2:4: ", "'a' is not a number"},
        Bad{"no_radius", "<0,0,0> <0,0,1>\n", ":1:16: ", "a number is missing"},
        Bad{"word_for_radius", "<9,9,9> <9,9,8> 1\n<0,0,0> <0,0,1> steel\n",
            ":2:17: ", "'steel' is not a number"},
        Bad{"huge_radius", "<9,9,9> <9,9,8> 1\n<0,0,0> <0,0,1> +1e21\n",
            ":2:17: ", "'+1e21' is out of range (largest: 1e+16)"},
        Bad{"zero_radius", "<0,0,0> <0,0,1> 0\n", ":1:17: ", "must be positive"},
        Bad{"negative_radius", "<0,0,0> <0,0,1> -1\n", ":1:17: ", "must be positive"},
        Bad{"zero_second_radius", "<0,0,0> <0,0,1> 1 0\n", ":1:19: ", "must be positive"},
        Bad{"nan_radius", "<0,0,0> <0,0,1> nan\n", ":1:17: ", "not finite"},
        Bad{"nan_second_radius", "<0,0,0> <0,0,1> 1 nan\n", ":1:19: ", "not finite"},
        Bad{"infinite", "<0,0,inf> <0,0,1> 1\n", ":1:6: ", "not finite"},
        Bad{"too_large", "<0,0,1e39> <0,0,1> 1\n", ":1:6: ", "out of range"},
        Bad{"half_number", "<9,9,9> <9,9,8> 1\n<0,0,0> <0,0,1> 1 2x\n",
            ":2:19: ", "'2x' is not a number"},
        Bad{"too_much", "<0,0,0> <0,0,1> 1 2 a b\n", ":1:23: ", "follows a complete capsule"},
        Bad{"three_radii", "<9,9,9> <9,9,8> 1\n<0,0,0> <0,0,1> 1 2 3\n", ":2:21: ", "'3'"},
        Bad{"open_quote", "<0,0,0> <0,0,1> 1 \"a\n", ":1:19: ", "does not end"},
        Bad{"empty_name", "<0,0,0> <0,0,1> 1 \"\"\n", ":1:19: ", "is empty"},
        Bad{"bracket_name", "<0,0,0> <0,0,1> 1 <a\n", ":1:19: ", "neither a radius nor a material"},
        Bad{"binary", "<9,9,9> <9,9,8> 1\n" + std::string("<0,\0\x01\x02", 6),
            ":2:4: ", "'\\x00' is not a number"}));

TEST(BadCapsulesFiles, AreNamedAndErrorsCollected) {
  EXPECT_THAT(test::complaint([] { read_capsules("/nonexistent/a.capsules", Asked()); }),
              HasSubstr("No such file"));
  std::string text;
  for (int i = 0; i < 100; ++i) text += "x\n";
  const std::filesystem::path path = test::write_file("many.capsules", text);
  try {
    read_capsules(path, Asked());
    FAIL() << "accepted";
  } catch (const InputError& error) {
    ASSERT_EQ(error.messages().size(), 21U);
    EXPECT_EQ(error.messages()[20], "and 80 more errors");
  }
}

TEST(CapsulesScene, HasAMaterialForEachName) {
  const Scene scene = import_scene(
      test::write_file("bare.capsules",
                       "<0,0,0> <1,0,0> 1 a\n<0,0,0> <1,0,0> 1 b\n<0,0,0> <1,0,0> 1\n"),
      test::NoImages());
  ASSERT_EQ(scene.materials.size(), 3U);
  EXPECT_EQ(scene.materials[0].name, "a");
  EXPECT_EQ(scene.materials[1].name, "b");
  EXPECT_EQ(scene.materials[2].name, "default");
  EXPECT_EQ(test::capsules_of(scene).materials, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(scene.lights.size(), 1U);
}

// The largest numbers that are read leave room for the camera.
TEST(CapsulesScene, OfTheLargestNumbersIsSound) {
  const Scene scene = import_scene(
      test::write_file(
          "far.capsules",
          "<1e16,1e16,1e16> <1e16,1e16,9e15> 1e16\n<-1e16,-1e16,-1e16> <1e16,-1e16,1e16> 1e16\n"),
      test::NoImages());
  Diagnostics diagnostics;
  validate(scene, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors());
}

TEST(CapsulesScene, HasOneMaterialWithoutNames) {
  const Scene scene =
      import_scene(test::write_file("bare.capsules", "<0,0,0> <1,0,0> 1\n"), test::NoImages());
  ASSERT_EQ(scene.materials.size(), 1U);
  EXPECT_EQ(scene.shapes.at(0).material, 0U);
}

}  // namespace
}  // namespace caplet
