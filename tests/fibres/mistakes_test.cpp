// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Fibres: what is refused of each format, and rarer forms of what is read.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "fibre_bytes.h"
#include "import/detail/fibres.h"
#include "import/import.h"
#include "present/present.h"
#include "support/import_files.h"
#include "support/zip_text.h"

namespace caplet {
namespace {

using test::complaint;
using test::scene_of;
using test::trk_file;
using test::Writer;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr std::array<float, 16> kIdentity = {2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 0, 0, 0, 1};

TEST(BadTrk, IsRefusedAtItsByte) {
  const auto said = [](const std::string& bytes) {
    return complaint([&] { read_trk(bytes, "x.trk"); });
  };
  for (const bool swapped : {false, true}) {
    EXPECT_EQ(said(trk_file({1, 2, 3}, "RAS", kIdentity, swapped)), "");
    // After the header and the first track's number of points.
    EXPECT_THAT(said(trk_file({kInfinite, 2, 3}, "RAS", kIdentity, swapped)),
                HasSubstr("x.trk: byte 1004: a number is not finite or out of range"));
    EXPECT_THAT(said(trk_file({1, 2, -2e16F}, "RAS", kIdentity, swapped)),
                HasSubstr("x.trk: byte 1012: a number is not finite or out of range"));
  }
  std::string other = trk_file({1, 2, 3}, "RAS", kIdentity, false);
  other[996] = '\0';
  EXPECT_THAT(said(other), HasSubstr("x.trk: byte 996: the header's size is not 1000"));
}

TEST(BadTck, IsRefusedWithItsPlace) {
  const auto said = [](const std::string& bytes) {
    return complaint([&] { read_tck(bytes, "x.tck"); });
  };
  EXPECT_THAT(said("mrtrix"),
              HasSubstr("x.tck:1:1: is no track file: it does not begin with 'mrtrix tracks'"));
  EXPECT_THAT(said("mrtrix tracks\nfile: other.tck 0\nEND\n"),
              HasSubstr("x.tck:2: data in another file are not read"));
  EXPECT_THAT(said("mrtrix tracks\ncount: 1\nfile: . here\nEND\n"),
              HasSubstr("x.tck:3: '. here' is no place in the file"));
  const std::string head = "mrtrix tracks\ndatatype: Float32LE\nEND\n";
  for (const float bad : {kInfinite, std::nanf(""), 2e16F})
    EXPECT_THAT(
        said(
            Writer().text(head).put(1.0F).put(2.0F).put(3.0F).put(4.0F).put(bad).put(6.0F).bytes()),
        HasSubstr(fmt::format("x.tck: byte {}: a number is not finite or out of range",
                              head.size() + 12)));
}

// IEEE 754's binary16: exponents of ones are infinite, or no numbers.
TEST(Trx, HalvesMayBeInfinite) {
  const auto file = [](std::uint16_t last, const std::string& values) {
    return test::zip_of({{"header.json", R"({"NB_VERTICES": 2, "NB_STREAMLINES": 1})"},
                         {"positions.3.float16", Writer().fill(10).put(last).bytes()},
                         {"offsets.uint32", std::string(4, '\0')},
                         {"dpv/heat.2.float16", values}},
                        true);
  };
  const auto values = [&](std::initializer_list<int> bits, const std::string& wanted) {
    Writer raw;
    for (const int one : bits) raw.put(static_cast<std::uint16_t>(one));
    FibreScalars out;
    out.wanted = wanted;
    read_trx(test::write_file("h.trx", file(0x3c00, raw.bytes())), &out);
    return out.values;
  };
  for (const unsigned bad : {0x7c00U, 0xfc00U, 0x7e00U})
    EXPECT_THAT(
        complaint([&] {
          read_trx(test::write_file("h.trx", file(static_cast<std::uint16_t>(bad), "12345678")));
        }),
        HasSubstr("positions.3.float16: point 1 is not finite or out of range"))
        << bad;
  // 1, 2; 0.5, -infinite; 1.5; nothing that is a number.
  EXPECT_THAT(values({0x3c00, 0x3800, 0x4000, 0xfc00}, "heat[0]"), ElementsAre(1, 2));
  EXPECT_THAT(values({0x3c00, 0x3800, 0x4000, 0xfc00}, "heat[1]"), ElementsAre(0.5F, -kInfinite));
  EXPECT_THAT(values({0x3e00, 0, 0x7e00, 0}, "heat[0]"),
              ElementsAre(1.5F, testing::Truly([](float x) { return std::isnan(x); })));
}

std::string vtk_head(const std::string& kind) {
  return "# vtk DataFile Version 5.1\nlines\n" + kind + "\nDATASET POLYDATA\n";
}
const std::string kTextLines = "POINTS 2 float\n0 0 0 1 0 0\nLINES 1 3\n2 0 1\n";

std::string binary_lines(float z = 3) {
  return Writer(true)
      .text(vtk_head("BINARY") + "POINTS 2 float\n")
      .put(0.0F)
      .put(0.0F)
      .put(0.0F)
      .put(1.0F)
      .put(2.0F)
      .put(z)
      .text("\nLINES 2 2\nOFFSETS int\n")
      .put(std::int32_t{0})
      .put(std::int32_t{2})
      .text("\nCONNECTIVITY int\n")
      .put(std::int32_t{1})
      .put(std::int32_t{0})
      .text("\n")
      .bytes();
}

// A field of the whole stands before points and lines, and is passed over.
TEST(Vtk, FieldsOfTheWholeArePassedOver) {
  const Fibres all = read_vtk(vtk_head("ASCII") +
                                  "FIELD FieldData 2\nTIME 1 1 double\n7.5\nother 2 2 int\n"
                                  "1 2 3 4\n" +
                                  kTextLines,
                              "f.vtk");
  EXPECT_EQ(all.points, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}}));
  EXPECT_EQ(all.ends, (std::vector<std::uint64_t>{2}));
}

TEST(Vtk, OffsetsMayHave32Bits) {
  const Fibres all = read_vtk(binary_lines(), "b.vtk");
  EXPECT_EQ(all.points, (std::vector<glm::vec3>{{1, 2, 3}, {0, 0, 0}}));
  EXPECT_EQ(all.ends, (std::vector<std::uint64_t>{2}));
}

TEST(BadVtk, IsRefusedWithItsPlace) {
  const auto said = [](const std::string& bytes, const std::string& wanted = "") {
    FibreScalars scalars;
    scalars.wanted = wanted;
    return complaint([&] { read_vtk(bytes, "x.vtk", &scalars); });
  };
  const auto text = [&](const std::string& rest, const std::string& wanted = "") {
    return said(vtk_head("ASCII") + rest, wanted);
  };
  EXPECT_THAT(text("GRID 3\n"), HasSubstr("x.vtk:5: 'GRID' is no section that is read"));
  EXPECT_THAT(text("POINTS 2 int\n"), HasSubstr("x.vtk:5: 'int' points are not read"));
  const std::string fields = kTextLines + "POINT_DATA 2\nFIELD more 1\n";
  for (const std::string type : {"string", "utf8_string", "variant"})
    EXPECT_THAT(text(fields + "a 1 2 " + type + "\nx\ny\n"),
                HasSubstr("x.vtk:11: '" + type + "' fields are not read"));
  // 2^62 times 2 is more than 2^63 - 1.
  EXPECT_THAT(text(fields + "a 2 4611686018427387904 float\n1\n", "b"),
              HasSubstr("4611686018427387904 rows are announced"));
  EXPECT_THAT(said(binary_lines(kInfinite)), HasSubstr("point 1 is not finite or out of range"));
  EXPECT_THAT(said(binary_lines(-2e16F)), HasSubstr("point 1 is not finite or out of range"));
  const std::string binary = binary_lines() + "POINT_DATA 2\n";
  EXPECT_THAT(said(binary + "SCALARS a float 1\n" + std::string(8, '\0')),
              HasSubstr("expected LOOKUP_TABLE"));
  // Two rows of three numbers that are passed over take 24 bytes.
  const std::string passed = binary + "SCALARS a float 3\nLOOKUP_TABLE default\n",
                    behind = "SCALARS b float\nLOOKUP_TABLE default\n" + std::string(8, '\0');
  EXPECT_THAT(said(passed + std::string(23, '\0'), "b"),
              HasSubstr("the file ends before what it announces"));
  EXPECT_EQ(said(passed + std::string(24, '\0') + behind, "b"), "");
}

TEST(Fibres, ColoursMayBeOfEachFibre) {
  const Scene scene = scene_of("c.vtk",
                               vtk_head("ASCII") +
                                   "POINTS 5 float\n0 0 0 1 0 0 2 2 0 5 0 0 5 1 0\n"
                                   "LINES 2 7\n3 0 1 2\n2 3 4\n",
                               {{{"color", "fibre"}}});
  const auto& capsules = std::get<CapsulesShape>(scene.shapes.at(0).geometry);
  ASSERT_EQ(capsules.materials.size(), 3U);
  const auto color = [&](std::size_t i) {
    return std::get<RgbSpectrum>(
               std::get<DiffuseMaterial>(scene.materials.at(capsules.materials[i]).model)
                   .reflectance)
        .rgb;
  };
  EXPECT_EQ(capsules.materials[0], capsules.materials[1]);
  EXPECT_NE(capsules.materials[0], capsules.materials[2]);
  // Within half a step of 1/255.
  for (const auto& [segment, fibre] : {std::pair(0, 0), std::pair(2, 1)})
    EXPECT_LT(glm::length(color(static_cast<std::size_t>(segment)) -
                          palette_color(static_cast<std::size_t>(fibre))),
              std::sqrt(3.0) / 509)
        << segment;
}

TEST(Fibres, WhatIsAskedForIsThere) {
  EXPECT_THAT(complaint([] {
                scene_of("c.vtk", vtk_head("ASCII") + kTextLines, {{{"color", "file"}}});
              }),
              HasSubstr("--color: the file has no colours"));
  const auto said = [](int scalars) {
    std::string text = vtk_head("ASCII") + kTextLines + "POINT_DATA 2\n";
    for (int i = 0; i < scalars; ++i)
      text += fmt::format("SCALARS s{} float\nLOOKUP_TABLE default\n1 2\n", i);
    return complaint([&] { scene_of("s.vtk", text, {{{"color", "scalar:none"}}}); });
  };
  EXPECT_THAT(said(2), AllOf(HasSubstr("--color: 'none' is none of the scalars of "),
                             testing::EndsWith("s.vtk: 's0', 's1'")));
  EXPECT_THAT(said(20), testing::EndsWith("'s18', 's19'"));
  EXPECT_THAT(said(23), testing::EndsWith("'s18', 's19', and 3 more"));
}

// Fibres of lengths 1, 2, ... along x, the f-th at y = f, whose ends' values are f and 3 f.
std::string comb(int count) {
  std::string points, lines, values;
  for (int f = 0; f < count; ++f) {
    points += fmt::format("0 {0} 0 {1} {0} 0\n", f, f + 1);
    lines += fmt::format("2 {} {}\n", 2 * f, 2 * f + 1);
    values += fmt::format("{} {}\n", f, 3 * f);
  }
  return vtk_head("ASCII") +
         fmt::format(
             "POINTS {} float\n{}LINES {} {}\n{}POINT_DATA {}\nSCALARS s float\n"
             "LOOKUP_TABLE default\n{}",
             2 * count, points, count, 3 * count, lines, 2 * count, values);
}

/// The y of what is drawn.
std::vector<float> drawn(int count, const ImportOptions& options) {
  const Scene scene = scene_of("c.vtk", comb(count), options);
  std::vector<float> out;
  for (const glm::vec3& p : std::get<CapsulesShape>(scene.shapes.at(0).geometry).p0)
    out.push_back(p.y);
  EXPECT_EQ(scene.contents.at(0), (std::pair<std::string, std::uint64_t>("fibres", out.size())));
  return out;
}

TEST(FibreChoice, ByLengthAndValue) {
  using Drawn = std::vector<float>;
  EXPECT_EQ(drawn(5, {{{"lengths", "2,4"}}}), (Drawn{1, 2, 3}));
  EXPECT_EQ(drawn(5, {{{"color", "scalar"}, {"values", "2,6"}}}), (Drawn{1, 2, 3}));
  EXPECT_EQ(drawn(5, {{{"color", "scalar"}, {"values", "2,6"}, {"lengths", "4,9"}}}), (Drawn{3}));
  const auto told = [](const ImportOptions& options) {
    return complaint([&] { drawn(5, options); });
  };
  EXPECT_THAT(told({{{"values", "2,6"}}}), HasSubstr("--values: goes with --color scalar"));
  EXPECT_THAT(told({{{"lengths", "9,12"}}}), HasSubstr("leave none of 5 fibres"));
  EXPECT_THAT(told({{{"lengths", "9"}}}), HasSubstr("--lengths: '9' is not LOW,HIGH"));
}

TEST(FibreOpacity, IsTheShapes) {
  const auto alpha = [](const ImportOptions& options) {
    return scene_of("c.vtk", comb(2), options).shapes.at(0).alpha;
  };
  EXPECT_FALSE(alpha({}));
  EXPECT_FALSE(alpha({{{"opacity", "1"}}}));
  const auto quarter = alpha({{{"opacity", "0.25"}}});
  ASSERT_TRUE(quarter);
  EXPECT_EQ(std::get<ConstantSpectrum>(quarter->value).value, 0.25);
  EXPECT_THAT(complaint([&] {
                (void)alpha({{{"opacity", "0"}}});
              }),
              HasSubstr("--opacity: '0' is no number above 0 and up to 1"));
}

// A share is even to within four deviations of a binomial count, and holds that of any smaller one.
TEST(FibreChoice, ByShare) {
  constexpr int count = 4000;
  const std::vector<float> all = drawn(count, {{{"share", "1"}}}),
                           half = drawn(count, {{{"share", "0.5"}}}),
                           tenth = drawn(count, {{{"share", "0.1"}}});
  EXPECT_EQ(all.size(), std::size_t{count});
  EXPECT_NEAR(static_cast<double>(half.size()), 2000, 4 * std::sqrt(count * 0.25));
  EXPECT_NEAR(static_cast<double>(tenth.size()), 400, 4 * std::sqrt(count * 0.09));
  EXPECT_TRUE(std::ranges::includes(half, tenth));
  for (const char* share : {"0", "-0.5", "1.5", "nan", "half"})
    EXPECT_THAT(complaint([&] {
                  drawn(5, {{{"share", share}}});
                }),
                AllOf(HasSubstr("--share: "), HasSubstr("no number above 0 and up to 1")));
}

}  // namespace
}  // namespace caplet
