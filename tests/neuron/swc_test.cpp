// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// SWC: the conventions of docs/formats/swc.md, the shared files with their independent counts, and
// bad input.
#include "import/detail/swc.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "import/detail/importers.h"
#include "support/import_files.h"

namespace caplet::swc_test {
namespace {

using test::capsules_of;
using test::spheres_of;
using testing::HasSubstr;
using testing::StartsWith;

Scene import_text(const std::string& text) {
  return import_swc(test::write_file("neuron.swc", text), test::NoImages());
}

glm::dvec3 center_of(const Shape& shape) { return glm::dvec3(shape.world_from_object[3]); }
double radius_of(const Shape& sphere) { return std::get<SphereShape>(sphere.geometry).radius; }

// --- The shared files: counts by an independent script (NOTICE.md of the data folder) ---

struct FileCounts {
  const char* file;
  std::size_t nodes, segments, roots;
  std::map<int, std::size_t> types;
  std::size_t capsules, spheres;  // by the soma conventions
};
void PrintTo(const FileCounts& counts, std::ostream* out) { *out << counts.file; }

class SwcFile : public testing::TestWithParam<FileCounts> {};

TEST_P(SwcFile, HasTheCountsOfTheNotice) {
  CAPLET_NEEDS_DATA();
  const FileCounts& expected = GetParam();
  const std::filesystem::path path = test::data_folder() / "swc" / expected.file;
  std::ifstream stream(path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(stream)),
                         std::istreambuf_iterator<char>());
  const std::vector<SwcSample> samples = parse_swc(text, path.string());
  std::size_t roots = 0;
  std::map<int, std::size_t> types;
  for (const SwcSample& sample : samples) {
    roots += sample.parent < 0;
    ++types[sample.type];
  }
  EXPECT_EQ(samples.size(), expected.nodes);
  EXPECT_EQ(roots, expected.roots);
  EXPECT_EQ(samples.size() - roots, expected.segments);
  EXPECT_EQ(types, expected.types);

  const Scene scene = import_scene(path, test::NoImages());
  EXPECT_EQ(capsules_of(scene).p0.size(), expected.capsules);
  EXPECT_EQ(spheres_of(scene).size(), expected.spheres);
  const CapsulesShape capsules = capsules_of(scene);
  EXPECT_EQ(capsules.materials.size(), capsules.p0.size());
  for (const std::uint32_t material : capsules.materials)
    EXPECT_LT(material, scene.materials.size());
  for (const float radius : capsules.radius0) EXPECT_GT(radius, 0);
  for (const float radius : capsules.radius1) EXPECT_GT(radius, 0);
  EXPECT_EQ(scene.lights.size(), 1U);
  EXPECT_TRUE(scene.automatic_camera);
}

INSTANTIATE_TEST_SUITE_P(
    Shared, SwcFile,
    testing::Values(
        FileCounts{"morphio/complexe.swc", 30, 29, 1, {{1, 21}, {2, 9}}, 29, 0},
        FileCounts{"morphio/disconnected_neurite.swc", 10, 8, 2, {{1, 1}, {2, 4}, {3, 5}}, 8, 2},
        FileCounts{"morphio/nrn_ordering.swc",
                   3783,
                   3782,
                   1,
                   {{1, 1}, {2, 103}, {3, 2477}, {4, 1202}},
                   3782,
                   1},
        FileCounts{
            "morphio/simple-heterogeneous-neurite.swc", 9, 8, 1, {{1, 1}, {2, 4}, {3, 4}}, 8, 1},
        FileCounts{"morphio/simple-trailing-space.swc", 3, 2, 1, {{2, 3}}, 2, 0},
        FileCounts{"morphio/simple-windows-eol.swc", 9, 8, 1, {{1, 1}, {2, 4}, {3, 4}}, 8, 1},
        FileCounts{"morphio/soma_cylinders.swc", 6, 5, 1, {{1, 4}, {2, 2}}, 5, 0},
        FileCounts{"morphio/soma_multiple_frustums.swc", 4, 3, 1, {{1, 4}}, 3, 0},
        FileCounts{"morphio/soma_three_points_cylinder.swc", 3, 2, 1, {{1, 3}}, 0, 1},
        FileCounts{
            "neurom/Neuron.swc", 847, 846, 1, {{1, 3}, {2, 211}, {3, 422}, {4, 211}}, 846, 0},
        FileCounts{"neurom/Neuron_3_random_walker_branches.swc",
                   1503,
                   1502,
                   1,
                   {{1, 3}, {2, 500}, {3, 500}, {4, 500}},
                   1502,
                   0},
        FileCounts{"neurom/Neuron_disconnected_components.swc",
                   843,
                   838,
                   5,
                   {{1, 3}, {2, 210}, {3, 420}, {4, 210}},
                   838,
                   0},
        FileCounts{"neurom/Neuron_zero_length_segments.swc",
                   847,
                   846,
                   1,
                   {{1, 3}, {2, 211}, {3, 422}, {4, 211}},
                   846,
                   0},
        FileCounts{"neurom/Neuron_zero_radius.swc", 9, 8, 1, {{1, 3}, {2, 6}}, 8, 0},
        FileCounts{"neurom/multiple_somata.swc", 10, 8, 2, {{1, 2}, {2, 4}, {3, 4}}, 8, 2},
        FileCounts{"neurom/ordering/sample.swc", 53, 52, 1, {{1, 1}, {2, 31}, {3, 21}}, 52, 1},
        FileCounts{"neurom/point_soma.swc", 1, 0, 1, {{1, 1}}, 0, 1},
        FileCounts{"neurom/simple.swc", 9, 8, 1, {{1, 1}, {2, 4}, {3, 4}}, 8, 1},
        FileCounts{"neurom/soma/bifurcating_soma.swc", 15, 14, 1, {{1, 9}, {2, 5}, {3, 1}}, 14, 0},
        FileCounts{
            "neurom/soma/three_pt_soma.swc", 23, 22, 1, {{1, 3}, {2, 10}, {3, 5}, {4, 5}}, 20, 1},
        FileCounts{"neuromorpho/C040600B3.CNG.swc",
                   5543,
                   5542,
                   1,
                   {{1, 1}, {2, 3967}, {3, 1575}},
                   5542,
                   1},
        FileCounts{"neuromorpho_large/173000.swc", 28930, 28929, 1, {{2, 28930}}, 28929, 0}));

// Every file of the folder has its row above.
TEST(SwcFiles, AreAllTested) {
  CAPLET_NEEDS_DATA();
  std::size_t files = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(test::data_folder() / "swc"))
    files += entry.path().extension() == ".swc";
  EXPECT_EQ(files, 22U);
}

// --- Lines ---

constexpr const char* kPlain =
    "1 1 0 0 0 2 -1\n"
    "2 3 3 0 0 1 1\n"
    "3 3 6 0 0 0.5 2\n";

void expect_same_capsules(const Scene& a, const Scene& b) {
  const CapsulesShape first = capsules_of(a), second = capsules_of(b);
  EXPECT_EQ(first.p0, second.p0);
  EXPECT_EQ(first.p1, second.p1);
  EXPECT_EQ(first.radius0, second.radius0);
  EXPECT_EQ(first.radius1, second.radius1);
}

TEST(SwcLines, BlanksCommentsAndLineEndsDoNotMatter) {
  const Scene plain = import_text(kPlain);
  ASSERT_EQ(capsules_of(plain).p0.size(), 2U);
  for (const char* text : {
           "# comment\n\n  1\t1  0 0 0 2 -1   \n# between\n 2 3 3 0 0 1 1 # after\n\t3 3 6 0 0 0.5 "
           "2",
           "1 1 0 0 0 2 -1\r\n2 3 3 0 0 1 1\r\n\r\n3 3 6 0 0 0.5 2\r\n",
           "1 1 0 0 0 2 -1\r2 3 3 0 0 1 1\r3 3 6 0 0 0.5 2\r",
           "\xef\xbb\xbf"
           "1 1 0 0 0 2 -1\n2 3 +3.000 0 0 1e0 1\n3 3 6 0 0 .5 2\n",
           "1 1 0 0 0 2 -1\n2 3 3 0 0 1 1#touching\n3 3 6 0 0 "
           "0.5000000000000000000000000000000000000000000000000000000 2\n",
       }) {
    SCOPED_TRACE(text);
    expect_same_capsules(plain, import_text(text));
  }
}

TEST(SwcLines, MoreColumnsAreIgnored) {
  expect_same_capsules(import_text(kPlain),
                       import_text("1 1 0 0 0 2 -1 0 7 8\n2 3 3 0 0 1 1 1\n3 3 6 0 0 0.5 2 abc\n"));
}

TEST(SwcLines, WholeNumbersMayBeWrittenAsDecimals) {
  expect_same_capsules(
      import_text(kPlain),
      import_text("1.0 1. 0 0 0 2 -1.0\n2.000 3.0 3 0 0 1 1.0\n3e0 3 6 0 0 0.5 0.2e1\n"));
}

TEST(SwcLines, WhatIsTooSmallForANumberIsZero) {
  // A radius of 0 is a missing one: a quarter of the median.
  const CapsulesShape capsules = capsules_of(
      import_text("1 2 0 0 1e-400 1 -1\n2 2 1 -1e-999 0 2 1\n3 2 2 0 0 4 2\n4 2 3 0 0 1e-400 3\n"));
  EXPECT_EQ(capsules.p0[0], glm::vec3(0));
  EXPECT_EQ(capsules.radius1.back(), 0.5F);
}

TEST(SwcLines, ParentsMayFollowAndIdsMayHaveGaps) {
  const Scene scene = import_text("70 3 6 0 0 0.5 50\n50 3 3 0 0 1 9\n9 1 0 0 0 2 -1\n");
  const CapsulesShape capsules = capsules_of(scene);
  ASSERT_EQ(capsules.p0.size(), 2U);
  EXPECT_EQ(capsules.p0[0], glm::vec3(3, 0, 0));
  EXPECT_EQ(capsules.p1[0], glm::vec3(6, 0, 0));
  EXPECT_EQ(capsules.p0[1], glm::vec3(0, 0, 0));
  EXPECT_EQ(capsules.p1[1], glm::vec3(3, 0, 0));
}

// --- Segments ---

TEST(SwcSegments, TaperBetweenRadii) {
  const CapsulesShape capsules = capsules_of(import_text(kPlain));
  EXPECT_EQ(capsules.radius0[1], 1.0F);
  EXPECT_EQ(capsules.radius1[1], 0.5F);
}

TEST(SwcSegments, StartAtTheSomaWithTheirOwnRadius) {
  const CapsulesShape capsules = capsules_of(import_text(kPlain));
  EXPECT_EQ(capsules.p0[0], glm::vec3(0));
  EXPECT_EQ(capsules.radius0[0], 1.0F);
  EXPECT_EQ(capsules.radius1[0], 1.0F);
}

TEST(SwcSegments, UntaperedFilesHoldOneRadius) {
  const CapsulesShape capsules = capsules_of(import_text("1 2 0 0 0 2 -1\n2 2 3 0 0 2 1\n"));
  EXPECT_EQ(capsules.radius0, std::vector<float>{2.0F});
  EXPECT_TRUE(capsules.radius1.empty());
}

TEST(SwcSegments, UIsTheLengthAlongEachBranch) {
  const auto near = [](const std::vector<glm::vec2>& found,
                       const std::vector<glm::vec2>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_FLOAT_EQ(found[i].x, expected[i].x) << i;
      EXPECT_FLOAT_EQ(found[i].y, expected[i].y) << i;
    }
  };
  // From the soma 2, 1 and 3 long to a fork; from there 1, and 1 and 2.
  const CapsulesShape capsules =
      capsules_of(import_text("1 1 0 0 0 1 -1\n2 3 2 0 0 .2 1\n3 3 3 0 0 .2 2\n4 3 6 0 0 .2 3\n5 3 "
                              "6 1 0 .2 4\n6 3 7 0 0 .2 4\n7 3 9 0 0 .2 6\n"));
  near(capsules.u,
       {{0, 1.0F / 3}, {1.0F / 3, 0.5F}, {0.5F, 1}, {0, 1}, {0, 1.0F / 3}, {1.0F / 3, 1}});
  EXPECT_EQ(capsules.u[1].x, capsules.u[0].y);
  // A soma of two segments and one neurite that goes on from it, children before parents.
  near(capsules_of(
           import_text(
               "5 3 9 0 0 .2 4\n4 3 5 0 0 .2 3\n3 1 4 0 0 2 2\n2 1 3 0 0 2 1\n1 1 0 0 0 2 -1\n"))
           .u,
       {{0.2F, 1}, {0, 0.2F}, {0.75F, 1}, {0, 0.75F}});
  near(capsules_of(import_text("1 2 5 5 5 2 -1\n2 2 5 5 5 1 1\n")).u, {{0, 1}});
}

TEST(SwcSegments, KeepZeroLengths) {
  const CapsulesShape capsules = capsules_of(import_text("1 2 5 5 5 2 -1\n2 2 5 5 5 1 1\n"));
  ASSERT_EQ(capsules.p0.size(), 1U);
  EXPECT_EQ(capsules.p0[0], capsules.p1[0]);
}

TEST(SwcSegments, SeveralRootsStayApart) {
  const Scene scene = import_text("1 2 0 0 0 1 -1\n2 2 1 0 0 1 1\n3 2 9 9 9 1 -1\n4 2 9 9 8 1 3\n");
  EXPECT_EQ(capsules_of(scene).p0.size(), 2U);
  EXPECT_TRUE(spheres_of(scene).empty());
}

TEST(SwcSegments, ALoneSampleIsASphere) {
  const std::vector<Shape> spheres = spheres_of(import_text("1 3 1 2 3 4 -1\n"));
  ASSERT_EQ(spheres.size(), 1U);
  EXPECT_EQ(center_of(spheres[0]), glm::dvec3(1, 2, 3));
  EXPECT_EQ(radius_of(spheres[0]), 4);
}

TEST(SwcSegments, MissingRadiiAreAQuarterOfTheMedian) {
  const CapsulesShape capsules =
      capsules_of(import_text("1 2 0 0 0 1 -1\n2 2 1 0 0 2 1\n3 2 2 0 0 4 2\n4 2 3 0 0 0 3\n"));
  EXPECT_EQ(capsules.radius1.back(), 0.5F);
}

TEST(SwcSegments, AllRadiiMissingFollowTheExtent) {
  const CapsulesShape capsules = capsules_of(import_text("1 2 0 0 0 0 -1\n2 2 512 0 0 0 1\n"));
  EXPECT_EQ(capsules.radius0[0], 1.0F);
  EXPECT_EQ(radius_of(spheres_of(import_text("1 1 7 7 7 0 -1\n")).at(0)), 1.0);
}

TEST(SwcSegments, MissingRadiiOfTinyFilesAreNotZero) {
  for (const char* text :
       {"1 2 0 0 0 0 -1\n2 2 1e-45 0 0 0 1\n", "1 2 0 0 0 1e-45 -1\n2 2 1 0 0 0 1\n"})
    EXPECT_GT(capsules_of(import_text(text)).radius0[0], 0) << text;
}

// --- Somata ---

TEST(SwcSoma, OnePointIsASphere) {
  const Scene scene = import_text(kPlain);
  const std::vector<Shape> spheres = spheres_of(scene);
  ASSERT_EQ(spheres.size(), 1U);
  EXPECT_EQ(center_of(spheres[0]), glm::dvec3(0));
  EXPECT_EQ(radius_of(spheres[0]), 2);
  EXPECT_EQ(scene.materials[spheres[0].material].name, "soma");
}

TEST(SwcSoma, ThreePointsOfNeuroMorphoAreTheSameSphere) {
  // The second as rounded to two decimals by NeuroMorpho.Org, the third with the points swapped.
  for (const char* text :
       {"1 1 1 1 1 9 -1\n2 1 1 -8 1 9 1\n3 1 1 10 1 9 1\n4 3 20 1 1 1 1\n",
        "1 1 1 1 1 7.893 -1\n2 1 1 -6.89 1 7.893 1\n3 1 1 8.89 1 7.893 1\n4 3 20 1 1 1 2\n",
        "1 1 1 1 1 9 -1\n2 1 1 10 1 9 1\n3 1 1 -8 1 9 1\n4 3 20 1 1 1 1\n"}) {
    SCOPED_TRACE(text);
    const Scene scene = import_text(text);
    ASSERT_EQ(spheres_of(scene).size(), 1U);
    EXPECT_EQ(center_of(spheres_of(scene)[0]), glm::dvec3(1));
    EXPECT_EQ(capsules_of(scene).p0.size(), 1U);
  }
}

TEST(SwcSoma, OtherThreePointsAreAChain) {
  for (const char* text :
       {"1 1 0 0 0 9 -1\n2 1 0 -9 0 9 1\n3 1 0 9 0 9 2\n",  // the third is not a child of the first
        "1 1 0 0 0 9 -1\n2 1 0 -9 0 9 1\n3 1 0 -9 0 9 1\n",      // both on one side
        "1 1 0 0 0 9 -1\n2 1 -9 0 0 9 1\n3 1 9 0 0 9 1\n",       // along x
        "1 1 0 0 0 9 -1\n2 1 0 -9 0 4 1\n3 1 0 9 0 4 1\n",       // other radii
        "1 1 0 0 0 9 -1\n2 1 0 -12 0 9 1\n3 1 0 12 0 9 1\n"}) {  // further than the radius
    SCOPED_TRACE(text);
    const Scene scene = import_text(text);
    EXPECT_TRUE(spheres_of(scene).empty());
    EXPECT_EQ(capsules_of(scene).p0.size(), 2U);
  }
}

TEST(SwcSoma, MorePointsAreTaperedCapsules) {
  const CapsulesShape capsules =
      capsules_of(import_text("1 1 0 0 0 40 -1\n2 1 1 0 0 35 1\n3 1 2 0 0 29 2\n4 1 3 0 0 17 3\n"));
  EXPECT_EQ(capsules.radius0, (std::vector<float>{40, 35, 29}));
  EXPECT_EQ(capsules.radius1, (std::vector<float>{35, 29, 17}));
}

TEST(SwcSoma, AtTheEndOfANeuriteIsASphereToo) {
  const Scene scene = import_text("1 3 0 0 0 1 -1\n2 3 5 0 0 1 1\n3 1 9 0 0 3 2\n");
  ASSERT_EQ(spheres_of(scene).size(), 1U);
  const CapsulesShape capsules = capsules_of(scene);
  ASSERT_EQ(capsules.p0.size(), 2U);
  EXPECT_TRUE(capsules.radius1.empty()) << "the segment to the soma keeps the neurite's radius";
  EXPECT_EQ(scene.materials[capsules.materials[1]].name, "basal dendrite");
}

TEST(SwcPalette, HasAMaterialForEachTypeThatOccurs) {
  const Scene scene = import_text(
      "1 1 0 0 0 1 -1\n2 2 1 0 0 1 1\n3 3 2 0 0 1 1\n4 4 3 0 0 1 1\n5 0 4 0 0 1 1\n6 9 5 0 0 1 "
      "1\n");
  std::set<std::string> names;
  for (const Material& material : scene.materials) names.insert(material.name);
  EXPECT_EQ(names, (std::set<std::string>{"soma", "axon", "basal dendrite", "apical dendrite",
                                          "undefined", "type 9"}));
}

// docs/formats/swc.md.
TEST(SwcPalette, ColoursAreTheDocumentedOnes) {
  const Scene scene =
      import_text("1 1 0 0 0 1 -1\n2 2 1 0 0 1 1\n3 3 2 0 0 1 1\n4 4 3 0 0 1 1\n5 0 4 0 0 1 1\n");
  std::map<std::string, glm::dvec3> colors;
  for (const Material& material : scene.materials)
    colors[material.name] =
        std::get<RgbSpectrum>(std::get<DiffuseMaterial>(material.model).reflectance).rgb;
  EXPECT_EQ(colors, (std::map<std::string, glm::dvec3>{{"undefined", {0.55, 0.56, 0.52}},
                                                       {"soma", {0.86, 0.62, 0.22}},
                                                       {"axon", {0.20, 0.62, 0.95}},
                                                       {"basal dendrite", {0.95, 0.36, 0.18}},
                                                       {"apical dendrite", {0.66, 0.22, 0.66}}}));
}

/// The names of the materials of the segments, in the order of the file.
std::vector<std::string> segment_materials(const std::string& text) {
  const Scene scene = import_text(text);
  std::vector<std::string> names;
  for (const std::uint32_t material : capsules_of(scene).materials)
    names.push_back(scene.materials[material].name);
  return names;
}

TEST(SwcPalette, ForkAndEndPointsAreOfTheirBranch) {
  using Names = std::vector<std::string>;
  // A fork (5) and two ends (6) of a dendrite; an end right at the soma's first sample.
  EXPECT_EQ(segment_materials("1 1 0 0 0 2 -1\n2 3 3 0 0 1 1\n3 5 4 0 0 1 2\n4 6 5 0 0 1 3\n5 4 5 "
                              "1 0 1 3\n6 6 6 1 0 1 5\n"),
            (Names{"basal dendrite", "basal dendrite", "basal dendrite", "apical dendrite",
                   "apical dendrite"}));
  // A fork at the soma: of what comes after it, children before parents.
  EXPECT_EQ(segment_materials("4 6 5 0 0 1 2\n3 4 5 1 0 1 2\n2 5 3 0 0 1 1\n1 1 0 0 0 2 -1\n"),
            (Names{"apical dendrite", "apical dendrite", "apical dendrite"}));
  // Marks alone.
  EXPECT_EQ(segment_materials("1 5 0 0 0 2 -1\n2 6 3 0 0 1 1\n"), (Names{"undefined"}));
}

// --- Bad input ---

struct Bad {
  const char* name;
  std::string text;
  const char* place;  // after the file's name
  const char* message;
};
void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }

class BadSwc : public testing::TestWithParam<Bad> {};

TEST_P(BadSwc, IsRefusedWithItsPlace) {
  const std::filesystem::path path = test::write_file("bad.swc", GetParam().text);
  const std::string said = test::complaint([&] { import_swc(path, test::NoImages()); });
  EXPECT_THAT(said, StartsWith(path.string() + GetParam().place));
  EXPECT_THAT(said, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Texts, BadSwc,
    testing::Values(
        Bad{"empty", "", ": ", "no samples"},
        Bad{"comments_only", "# nothing\n\n", ": ", "no samples"},
        Bad{"few_columns", "# c\n1 1 0 0 0 1\n", ":2:12: ", "parent is missing"},
        Bad{"one_column", "hello\n", ":1:6: ", "type is missing"},
        Bad{"word_for_number", "9 1 0 0 0 1 -1\n1 1 0 zero 0 1 -1\n",
            ":2:7: ", "y: 'zero' is not a number"},
        Bad{"half_number", "9 1 0 0 0 1 -1\n1 1 0 0 0 1.5x -1\n",
            ":2:11: ", "radius: '1.5x' is not a number"},
        Bad{"nan", "1 1 0 0 nan 1 -1\n", ":1:9: ", "not finite"},
        Bad{"infinity", "1 1 -inf 0 0 1 -1\n", ":1:5: ", "not finite"},
        Bad{"too_large", "1 1 1e39 0 0 1 -1\n", ":1:5: ", "out of range"},
        Bad{"beyond_the_camera", "1 1 0 0 0 1 -1\n2 3 0 2e16 0 1 1\n",
            ":2:7: ", "'2e16' is out of range (largest: 1e+16)"},
        Bad{"far_too_large", "1 1 1e999 0 0 1 -1\n", ":1:5: ", "out of range"},
        Bad{"fractional_id", "9 1 0 0 0 1 -1\n1.5 1 0 0 0 1 -1\n",
            ":2:1: ", "id: '1.5' is not a whole number"},
        Bad{"huge_id", "99999999999999999999 1 0 0 0 1 -1\n", ":1:1: ", "not a whole number"},
        Bad{"negative_id", "-3 1 0 0 0 1 -1\n", ":1:1: ", "id: -3 is negative"},
        Bad{"negative_type", "1 -1 0 0 0 1 -1\n", ":1:3: ", "type: -1 is negative"},
        Bad{"negative_radius", "1 1 0 0 0 -0.5 -1\n", ":1:11: ", "radius: -0.5 is negative"},
        Bad{"repeated_id", "1 1 0 0 0 1 -1\n2 3 1 0 0 1 1\n\n2 3 2 0 0 1 1\n",
            ":4: ", "already that of line 2"},
        Bad{"missing_parent", "1 1 0 0 0 1 -1\n2 3 1 0 0 1 7\n", ":2: ", "parent 7 is no sample"},
        Bad{"own_parent", "1 1 0 0 0 1 -1\n2 3 1 0 0 1 2\n", ":2:13: ", "its own parent"},
        Bad{"odd_parent", "1 1 0 0 0 1 -2\n", ":1:13: ", "neither an id nor -1"},
        Bad{"first_cycle", "1 1 0 0 0 1 2\n2 3 1 0 0 1 1\n",
            ":1: ", "sample 1 is its own ancestor"},
        Bad{"cycle", "1 1 0 0 0 1 -1\n2 3 1 0 0 1 4\n3 3 2 0 0 1 2\n4 3 2 0 0 1 3\n",
            ":2: ", "its own ancestor"},
        Bad{"binary",
            "9 1 0 0 0 1 -1\n" + std::string("\x7f"
                                             "ELF\x02\x01\x00\x00 \x01 \x02 \x03 \x04 \x05 \x06",
                                             21),
            ":2:1: ", "'\\x7fELF\\x02\\x01\\x00\\x00' is not a whole number"}));

TEST(BadSwcFiles, AreNamed) {
  EXPECT_THAT(test::complaint([] { import_swc("/nonexistent/neuron.swc", test::NoImages()); }),
              HasSubstr("/nonexistent/neuron.swc: cannot read: No such file"));
  EXPECT_THAT(test::complaint([] { import_swc(test::temporary_folder(), test::NoImages()); }),
              HasSubstr("a folder"));
}

TEST(BadSwcFiles, ErrorsAreCollected) {
  std::string text;
  for (int i = 0; i < 100; ++i) text += "x\n";
  try {
    parse_swc(text, "many.swc");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    ASSERT_EQ(error.messages().size(), 21U);
    EXPECT_THAT(error.messages()[19], StartsWith("many.swc:20:"));
    EXPECT_EQ(error.messages()[20], "and 80 more errors");
  }
}

// A chain of 200,000 samples in reverse order: no recursion, no quadratic time.
TEST(SwcSize, LongReversedChainIsRead) {
  std::string text;
  constexpr int kCount = 200000;
  for (int id = kCount; id > 0; --id)
    text += std::to_string(id) + " 2 " + std::to_string(id) + " 0 0 1 " +
            (id == 1 ? "-1" : std::to_string(id - 1)) + "\n";
  EXPECT_EQ(capsules_of(import_text(text)).p0.size(), kCount - 1U);
}

}  // namespace
}  // namespace caplet::swc_test
