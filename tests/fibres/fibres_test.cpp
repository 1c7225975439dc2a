// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Hair and streamlines: the conventions of docs/formats/fibres.md, the shared files, and bad input.
#include "import/detail/fibres.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "fibre_bytes.h"
#include "import/import.h"
#include "support/data.h"
#include "support/import_files.h"
#include "support/zip_text.h"

namespace caplet {
namespace {

using test::complaint;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;

using test::hair_file;
using test::scene_of;
using test::trk_file;
using test::Writer;

TEST(Hair, SegmentsThicknessAndColours) {
  Writer arrays;
  arrays.put(std::uint16_t{2}).put(std::uint16_t{1});
  for (int i = 0; i < 5; ++i) arrays.put(static_cast<float>(i)).put(0.0F).put(-1.0F);
  for (int i = 0; i < 5; ++i) arrays.put(0.2F * static_cast<float>(i + 1));
  for (int i = 0; i < 5; ++i) arrays.put(0.0F);  // transparency
  for (int i = 0; i < 5; ++i) arrays.put(1.0F).put(0.5F).put(0.25F * static_cast<float>(i));
  const Fibres all = read_hair(hair_file(2, 5, 31, arrays), "a.hair");
  EXPECT_EQ(all.ends, (std::vector<std::uint64_t>{3, 5}));
  EXPECT_EQ(all.points[4], glm::vec3(4, 0, -1));
  EXPECT_FLOAT_EQ(all.radii[4], 0.5F);  // thickness is a width
  EXPECT_EQ(all.colors[2], glm::vec3(1, 0.5F, 0.5F));

  const Scene scene = scene_of("a.hair", hair_file(2, 5, 31, arrays));
  const auto& capsules = std::get<CapsulesShape>(scene.shapes.at(0).geometry);
  ASSERT_EQ(capsules.p0.size(), 3u);  // two and one
  EXPECT_EQ(capsules.p1[2], glm::vec3(4, 0, -1));
  EXPECT_FLOAT_EQ(capsules.radius0[2], 0.4F);
  EXPECT_FLOAT_EQ(capsules.radius1[2], 0.5F);
  EXPECT_TRUE(std::holds_alternative<HairMaterial>(scene.materials.at(0).model));
  const Scene colored =
      scene_of("a.hair", hair_file(2, 5, 31, arrays), {{{"color", "file"}, {"radius", "2"}}});
  const auto& painted = std::get<CapsulesShape>(colored.shapes.at(0).geometry);
  const auto color = [&](std::size_t i) {
    return std::get<RgbSpectrum>(
               std::get<DiffuseMaterial>(colored.materials.at(painted.materials.at(i)).model)
                   .reflectance)
        .rgb;
  };
  for (std::size_t i = 0; i < 3;
       ++i)  // a segment has its first point's, within half a step of 1/255
    EXPECT_LT(glm::length(color(i) - glm::dvec3(1, 0.5, 0.25 * static_cast<double>(i < 2 ? i : 3))),
              std::sqrt(3.0) / 509)
        << i;
  EXPECT_EQ(std::get<CapsulesShape>(colored.shapes.at(0).geometry).radius0[1], 2.0F);
}

TEST(Hair, UIsTheLengthAlongEachStrand) {
  Writer arrays;
  arrays.put(std::uint16_t{2}).put(std::uint16_t{1}).put(std::uint16_t{2});
  for (const float x : {0.0F, 1.0F, 4.0F, 0.0F, 2.0F, 5.0F, 5.0F, 5.0F})
    arrays.put(x).put(1.0F).put(0.0F);
  const Scene scene = scene_of("u.hair", hair_file(3, 8, 3, arrays));
  const auto& capsules = std::get<CapsulesShape>(scene.shapes.at(0).geometry);
  // 1 of 4; a strand of one piece; one without length, by its points.
  EXPECT_EQ(capsules.u,
            (std::vector<glm::vec2>{{0, 0.25F}, {0.25F, 1}, {0, 1}, {0, 0.5F}, {0.5F, 1}}));
}

/// How far a component of a capsule's colour is from the file's at most, of so many capsules with
/// random colours, or with those of a line from black to white; and the number of materials.
std::pair<double, std::size_t> worst_color(std::uint32_t count, bool is_line) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> draw(0, 1);
  Writer arrays;
  std::vector<glm::vec3> colors;
  for (std::uint32_t i = 0; i < count; ++i) {
    arrays.put(static_cast<float>(i)).put(0.0F).put(0.0F);
    colors.emplace_back(draw(random), draw(random), draw(random));
    if (is_line) colors.back() = glm::vec3(static_cast<float>(i) / static_cast<float>(count));
  }
  for (const glm::vec3& c : colors) arrays.put(c.x).put(c.y).put(c.z);
  std::string file = hair_file(1, count, 18, arrays);
  const std::uint32_t segments = count - 1;
  std::memcpy(file.data() + 16, &segments, sizeof segments);
  const Scene scene = scene_of("p.hair", file, {{{"color", "file"}}});
  const auto& capsules = std::get<CapsulesShape>(scene.shapes.at(0).geometry);
  double worst = 0;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const glm::dvec3 shown =
        std::get<RgbSpectrum>(
            std::get<DiffuseMaterial>(scene.materials.at(capsules.materials.at(i)).model)
                .reflectance)
            .rgb;
    for (int k = 0; k < 3; ++k)
      worst = std::max(worst, std::abs(shown[k] - static_cast<double>(colors[i][k])));
  }
  return {worst, scene.materials.size()};
}

TEST(Hair, ColoursAreAsFineAsTheirNumberAllows) {
  // Half a step of 1/255, and of the coarser steps besides.
  EXPECT_LT(worst_color(4000, false).first, 1 / 509.0);
  EXPECT_LT(worst_color(60000, true).first, 1 / 509.0);
  const auto [worst, materials] = worst_color(60000, false);
  EXPECT_LT(worst, 1 / 30.0 + 1 / 509.0);
  EXPECT_LE(materials, 4096u);
  EXPECT_LE(worst_color(4150, false).second, 4096u);
  EXPECT_GT(materials, 3000u);
}

TEST(Hair, DefaultsOfTheHeader) {
  Writer arrays;
  for (int i = 0; i < 4; ++i) arrays.put(static_cast<float>(i)).put(0.0F).put(0.0F);
  const Fibres two = read_hair(hair_file(2, 4, 2, arrays), "b.hair");
  EXPECT_EQ(two.ends, (std::vector<std::uint64_t>{2, 4}));
  EXPECT_EQ(two.radii, (std::vector<float>{0.25F}));
  EXPECT_EQ(two.colors, (std::vector<glm::vec3>{{0.9F, 0.5F, 0.25F}}));
}

TEST(Tressfx, StrandsOfEqualLength) {
  Writer file;
  file.put(4.0F).put(std::uint32_t{2}).put(std::uint32_t{3}).put(std::uint32_t{160}).fill(160);
  for (int i = 0; i < 6; ++i) file.put(static_cast<float>(i)).put(1.0F).put(2.0F).put(0.0F);
  const Fibres all = read_tressfx(file.bytes(), "a.tfx");
  EXPECT_EQ(all.ends, (std::vector<std::uint64_t>{3, 6}));
  EXPECT_EQ(all.points[5], glm::vec3(5, 1, 2));
  EXPECT_EQ(
      std::get<CapsulesShape>(scene_of("a.tfx", file.bytes()).shapes.at(0).geometry).p0.size(), 4u);
}

/// One track of a point at the millimetres `p`, of a grid of 10 x 20 x 30 voxels of 2 x 3 x 4 mm.

TEST(Trk, PointsAreInTheWorld) {
  // Millimetres (5, 7.5, 14) are the voxel (2.5, 2.5, 3.5) from the corner, (2, 2, 3) from the
  // first middle.
  const std::array<float, 16> identity = {2, 0, 0, 100, 0, 3, 0, 200, 0, 0, 4, 300, 0, 0, 0, 1};
  for (const bool swapped : {false, true}) {
    const Fibres all = read_trk(trk_file({5, 7.5F, 14}, "RAS", identity, swapped), "a.trk");
    EXPECT_EQ(all.ends, (std::vector<std::uint64_t>{1, 3}));
    EXPECT_EQ(all.points[2], glm::vec3(104, 206, 312));
  }
  // The same points counted from the other end of x: the voxel 9 - 2.
  const Fibres flipped = read_trk(trk_file({5, 7.5F, 14}, "LAS", identity, false), "l.trk");
  EXPECT_EQ(flipped.points[0], glm::vec3(100 + 2 * 7, 206, 312));
  // A matrix whose first voxel axis runs left is "LAS" itself.
  const std::array<float, 16> left = {-2, 0, 0, 100, 0, 3, 0, 200, 0, 0, 4, 300, 0, 0, 0, 1};
  EXPECT_EQ(read_trk(trk_file({5, 7.5F, 14}, "LAS", left, false), "m.trk").points[0],
            glm::vec3(96, 206, 312));
  // None at all: as they are.
  EXPECT_EQ(read_trk(trk_file({5, 7.5F, 14}, "", {}, false), "n.trk").points[0],
            glm::vec3(5, 7.5F, 14));
}

TEST(Tck, OfBothByteOrdersAndWidths) {
  for (const bool wide : {false, true})
    for (const bool swapped : {false, true}) {
      const std::string header = std::string("mrtrix tracks\ncount: 2\ndatatype: Float") +
                                 (wide ? "64" : "32") + (swapped ? "BE" : "LE") +
                                 "\nfile: . 100\nEND\n";
      Writer out(swapped);
      out.text(header).fill(100);
      const auto point = [&](double x, double y, double z) {
        for (const double v : {x, y, z}) wide ? out.put(v) : out.put(static_cast<float>(v));
      };
      const double nan = std::numeric_limits<double>::quiet_NaN(),
                   inf = std::numeric_limits<double>::infinity();
      point(1, 2, 3);
      point(4, 5, 6);
      point(nan, nan, nan);
      point(7, 8, 9);
      point(nan, nan, nan);
      point(inf, inf, inf);
      const Fibres all = read_tck(out.bytes(), "a.tck");
      EXPECT_EQ(all.ends, (std::vector<std::uint64_t>{2, 3}));
      EXPECT_EQ(all.points[2], glm::vec3(7, 8, 9));
    }
}

TEST(Vtk, LinesAsTextAndBinary) {
  const std::string head = "# vtk DataFile Version 3.0\nlines\n";
  const Fibres text = read_vtk(head +
                                   "ASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0\n1 1 "
                                   "0\nLINES 2 5\n2 0 1\n1 2\nPOINT_DATA 3\n",
                               "a.vtk");
  EXPECT_EQ(text.ends, (std::vector<std::uint64_t>{2, 3}));
  EXPECT_EQ(text.points[2], glm::vec3(1, 1, 0));
  Writer out(true);
  out.text(head + "BINARY\nDATASET POLYDATA\nPOINTS 2 double\n");
  for (const double v : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0}) out.put(v);
  out.text("\nLINES 1 3\n").put(std::int32_t{2}).put(std::int32_t{1}).put(std::int32_t{0});
  const Fibres binary = read_vtk(out.bytes(), "b.vtk");
  EXPECT_EQ(binary.ends, (std::vector<std::uint64_t>{2}));
  EXPECT_EQ(binary.points[0], glm::vec3(3, 4, 5));
}

TEST(Fibres, ColoursTellDirections) {
  const Scene scene = scene_of("c.vtk",
                               "# vtk DataFile Version 3.0\nlines\nASCII\nDATASET POLYDATA\nPOINTS "
                               "3 float\n0 0 0 -2 0 0 -2 0 5\nLINES 1 4\n3 0 1 2\n");
  const auto& capsules = std::get<CapsulesShape>(scene.shapes.at(0).geometry);
  ASSERT_EQ(capsules.materials.size(), 2u);
  const auto color = [&](std::size_t i) {
    return std::get<RgbSpectrum>(
               std::get<DiffuseMaterial>(scene.materials[capsules.materials[i]].model).reflectance)
        .rgb;
  };
  EXPECT_LT(glm::length(color(0) - glm::dvec3(0.85, 0.05, 0.05)), 1e-12);
  EXPECT_LT(glm::length(color(1) - glm::dvec3(0.05, 0.05, 0.85)), 1e-12);
  ASSERT_TRUE(scene.legend);
  EXPECT_TRUE(scene.legend->of_directions);
  // z is up.
  EXPECT_EQ(glm::dvec3(scene.shapes[0].world_from_object * glm::dvec4(0, 0, 1, 0)),
            glm::dvec3(0, 1, 0));
}

// Numbers of points and tracks, and the extent, by nibabel 5.
TEST(SharedFibres, AreThoseOfNibabel) {
  CAPLET_NEEDS_DATA();
  struct Case {
    const char* file;
    Fibres (*read)(std::string_view, const std::string&);
    std::size_t tracks, points;
    glm::vec3 low, high;
  };
  const auto plain_trk = [](std::string_view bytes, const std::string& path) {
    return read_trk(bytes, path);
  };
  const Case cases[] = {
      {"standard.trk", plain_trk, 120, 360, {-0.5F, -1.5F, -1}, {3.5F, 13.5F, 13}},
      {"standard.tck", read_tck, 120, 360, {-0.5F, -1.5F, -1}, {3.5F, 13.5F, 13}},
      {"simple.tck", read_tck, 3, 8, {0, 1, 2}, {12, 13, 14}},
      {"tracks300.trk",
       plain_trk,
       300,
       14576,
       {64.02451F, 78.36036F, 61.47268F},
       {115.55523F, 121.12667F, 91.91046F}}};
  for (const Case& c : cases) {
    std::ifstream stream(test::data_folder() / "fibres/streamlines" / c.file, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)),
                            std::istreambuf_iterator<char>());
    const Fibres all = c.read(bytes, c.file);
    EXPECT_EQ(all.ends.size(), c.tracks) << c.file;
    EXPECT_EQ(all.points.size(), c.points) << c.file;
    glm::vec3 low(all.points.at(0)), high(low);
    for (const glm::vec3& p : all.points) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    // nibabel says five digits after the point.
    EXPECT_LT(glm::length(low - c.low), 2e-5F) << c.file;
    EXPECT_LT(glm::length(high - c.high), 2e-5F) << c.file;
  }
}

TEST(BadFibres, AreRefused) {
  Writer one;
  one.put(0.0F).put(0.0F).put(0.0F);
  EXPECT_THAT(complaint([] { read_hair("BEAR", "x.hair"); }), HasSubstr("HAIR"));
  EXPECT_THAT(complaint([&] { read_hair(hair_file(1, 1000000000, 2, one), "x.hair"); }),
              AllOf(HasSubstr("x.hair"), HasSubstr("1000000000")));
  EXPECT_THAT(complaint([&] { read_hair(hair_file(1, 1, 2, one), "x.hair"); }),
              HasSubstr("beyond the 1 points"));
  EXPECT_THAT(complaint([&] { read_hair(hair_file(1, 1, 0, one), "x.hair"); }),
              HasSubstr("no points"));
  EXPECT_THAT(complaint([] { read_tressfx(Writer().put(3.0F).fill(160).bytes(), "x.tfx"); }),
              HasSubstr("version 4"));
  EXPECT_THAT(complaint([] {
                read_tressfx(
                    Writer().put(4.0F).put(9999999u).put(9999999u).put(160u).fill(160).bytes(),
                    "x.tfx");
              }),
              HasSubstr("announced"));
  EXPECT_THAT(complaint([] {
                read_tressfx(Writer().put(4.0F).put(1u).put(1u).put(160u).fill(200).bytes(),
                             "x.tfx");
              }),
              HasSubstr("1 vertices"));
  std::string trk =
      trk_file({1, 2, 3}, "RAS", {2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 0, 0, 0, 1}, false);
  EXPECT_THAT(complaint([&] { read_trk(trk.substr(0, trk.size() - 20), "x.trk"); }),
              HasSubstr("x.trk"));
  EXPECT_THAT(complaint([&] { read_trk(trk.substr(0, 900), "x.trk"); }), HasSubstr("ends before"));
  EXPECT_THAT(complaint([&] { read_trk(trk.substr(0, trk.size() - 20), "x.trk"); }),
              HasSubstr("x.trk: byte "));
  EXPECT_THAT(complaint([] { read_trk("nothing", "x.trk"); }), HasSubstr("TRACK"));
  std::array<float, 16> endless{};
  endless.fill(std::numeric_limits<float>::infinity());
  EXPECT_THAT(complaint([&] {
                read_trk(trk_file({1, 2, 3}, "RAS", endless, false), "x.trk");
              }),
              AllOf(HasSubstr("x.trk: byte 440"), HasSubstr("not finite")));
  const std::array<float, 16> far = {3e38F, 0, 0, 0, 0, 3e38F, 0, 0, 0, 0, 3e38F, 0, 0, 0, 0, 1};
  EXPECT_THAT(complaint([&] {
                read_trk(trk_file({1e15F, 2, 3}, "RAS", far, false), "x.trk");
              }),
              AllOf(HasSubstr("x.trk: byte 1004"), HasSubstr("out of range in the world")));
  EXPECT_THAT(complaint([] { read_tck("mrtrix tracks\ncount: 1\n", "x.tck"); }),
              HasSubstr("x.tck:3: the header does not end"));
  EXPECT_THAT(complaint([] { read_tck("mrtrix tracks\ndatatype: Int8\nEND\n", "x.tck"); }),
              HasSubstr("x.tck:2"));
  EXPECT_THAT(complaint([] { read_tck("mrtrix tracks\ndatatype: Float32LE\nEND\nabc", "x.tck"); }),
              HasSubstr("infinite point"));
  const std::string head = "# vtk DataFile Version 3.0\nlines\nASCII\nDATASET POLYDATA\n";
  EXPECT_THAT(
      complaint([&] { read_vtk(head + "POINTS 1 float\n0 0 0\nLINES 1 2\n1 4\n", "x.vtk"); }),
      AllOf(HasSubstr("x.vtk:8"), HasSubstr("point 4")));
  EXPECT_THAT(complaint([&] { read_vtk(head + "POINTS 1000000000 float\n0 0 0\n", "x.vtk"); }),
              HasSubstr("ends early"));
  EXPECT_THAT(complaint([&] { read_vtk(head + "POINTS 1 float\n0 0 inf\n", "x.vtk"); }),
              HasSubstr("x.vtk:6"));
  EXPECT_THAT(
      complaint([&] { read_vtk(head + "POINTS 1 float\n0 0 0\nLINES 1 1\n1 0\n", "x.vtk"); }),
      HasSubstr("more points than"));
  EXPECT_THAT(complaint([&] {
                read_vtk(head + "POINTS 1 float\n0 0 0\nLINES 2 9\n1 0 9223372036854775807\n",
                         "x.vtk");
              }),
              HasSubstr("cell 1 has more points than"));
  EXPECT_THAT(complaint([&] { read_vtk(head, "x.vtk"); }), HasSubstr("no lines"));
  EXPECT_THAT(complaint([&] {
                scene_of("r.tck", "mrtrix tracks\n", {{{"radius", "-1"}}});
              }),
              HasSubstr("r.tck"));
  EXPECT_THAT(complaint([&] {
                scene_of(
                    "r.hair",
                    hair_file(1, 2, 2,
                              Writer().put(0.0F).put(0.0F).put(0.0F).put(1.0F).put(0.0F).put(0.0F)),
                    {{{"radius", "-1"}}});
              }),
              AllOf(HasSubstr("--radius"), HasSubstr("not positive")));
}

// --- TRX ---

std::string trx_file(const std::string& type, const std::string& positions,
                     const std::string& offset_type, const std::string& offsets, int points,
                     int tracks) {
  return test::zip_of({{"header.json", "{\"NB_VERTICES\": " + std::to_string(points) +
                                           ", \"NB_STREAMLINES\": " + std::to_string(tracks) +
                                           ", \"DIMENSIONS\": [1, 1, 1]}"},
                       {"dps/score.float32", "abcd"},
                       {"positions.3." + type, positions},
                       {"offsets." + offset_type, offsets}},
                      true);
}
Fibres trx_of(const std::string& bytes) { return read_trx(test::write_file("a.trx", bytes)); }

TEST(Trx, OfAllWidths) {
  Writer half, wide;
  // 1, 100, -2; the largest; the smallest.
  for (const int bits : {0x3c00, 0x5640, 0xc000, 0x7bff, 0x0001, 0x8000})
    half.put(static_cast<std::uint16_t>(bits));
  for (const double value : {1.0, 100.0, -2.0, 65504.0, 0x1p-24, 0.0}) wide.put(value);
  const std::string one = Writer().put(std::uint32_t{0}).put(std::uint32_t{1}).bytes();
  const std::string with_end =
      Writer().put(std::uint64_t{0}).put(std::uint64_t{1}).put(std::uint64_t{2}).bytes();
  for (const Fibres& all : {trx_of(trx_file("float16", half.bytes(), "uint32", one, 2, 2)),
                            trx_of(trx_file("float64", wide.bytes(), "uint64", with_end, 2, 2))}) {
    EXPECT_EQ(all.ends, (std::vector<std::uint64_t>{1, 2}));
    EXPECT_EQ(all.points, (std::vector<glm::vec3>{{1, 100, -2}, {65504, 0x1p-24F, 0}}));
  }
}

// Numbers of what tests/lattices/files/make.py gave to trx-python 0.6.
TEST(Trx, AFileOfTrxPython) {
  const Fibres all = read_trx(test::source_folder() / "tests/lattices/files/trx_python.trx");
  EXPECT_EQ(all.ends, (std::vector<std::uint64_t>{2, 5, 6}));
  EXPECT_EQ(all.points,
            (std::vector<glm::vec3>{
                {0, 0, 0}, {1, 0.5F, 0}, {-2, 8, 1}, {0.25F, 100, 3}, {4, 4, 4}, {7, 0, -1}}));
}

TEST(BadTrx, IsRefused) {
  const std::string points(36, '\0'),
      good = Writer().put(std::uint32_t{0}).put(std::uint32_t{2}).bytes();
  const auto said = [](const std::string& bytes) { return complaint([&] { trx_of(bytes); }); };
  EXPECT_EQ(said(trx_file("float32", points, "uint32", good, 3, 2)), "");
  EXPECT_THAT(said("not a zip"), HasSubstr("no zip archive"));
  EXPECT_THAT(said(test::zip_of({{"header.json", "{]"}})),
              AllOf(HasSubstr("header.json: byte 2"), HasSubstr("no JSON")));
  EXPECT_THAT(said(test::zip_of({{"header.json", "{\"NB_VERTICES\": 1e999}"}})),
              HasSubstr("header.json: a number is out of range"));
  EXPECT_THAT(said(test::zip_of({{"header.json", "{\"NB_VERTICES\": -1}"}})),
              HasSubstr("NB_VERTICES"));
  EXPECT_THAT(said(trx_file("float32", points, "uint32", good, 1000000000, 2)),
              AllOf(HasSubstr("3000000000"), HasSubstr("36 bytes")));
  EXPECT_THAT(said(trx_file("float32", points, "uint32", good, 3, 1000000000)),
              HasSubstr("1000000000 streamlines"));
  // One more than the greatest number of streamlines is 0, as many as there are.
  EXPECT_THAT(said(test::zip_of(
                  {{"header.json", R"({"NB_VERTICES": 0, "NB_STREAMLINES": 18446744073709551615})"},
                   {"positions.3.float32", ""},
                   {"offsets.uint32", ""}})),
              HasSubstr("18446744073709551615 streamlines"));
  EXPECT_THAT(said(trx_file("int8", points, "uint32", good, 3, 2)),
              HasSubstr("positions are float16"));
  EXPECT_THAT(said(trx_file("float32", points, "float32", good, 3, 2)), HasSubstr("offsets are"));
  EXPECT_THAT(said(trx_file("float32", points, "uint32", Writer().put(0u).put(9u).bytes(), 3, 2)),
              HasSubstr("streamline 0 ends at point 9"));
  EXPECT_THAT(said(trx_file("float32", points, "uint32", Writer().put(1u).put(2u).bytes(), 3, 2)),
              HasSubstr("does not begin"));
  EXPECT_THAT(
      said(trx_file("float32", points, "uint32", Writer().put(0u).put(1u).put(2u).bytes(), 3, 2)),
      HasSubstr("ends at point 2 of 3"));
  // An array that is missing, or is of another number of columns than the format says, is named.
  const std::pair<std::string, std::string> header{"header.json",
                                                   R"({"NB_VERTICES": 3, "NB_STREAMLINES": 2})"};
  EXPECT_THAT(said(test::zip_of({header, {"offsets.uint32", good}})),
              EndsWith("the archive has no positions"));
  EXPECT_THAT(said(test::zip_of({header, {"positions.3.float32", points}})),
              EndsWith("the archive has no offsets"));
  EXPECT_THAT(
      said(test::zip_of({header, {"positions.2.float32", points}, {"offsets.uint32", good}})),
      AllOf(HasSubstr("positions.2.float32"), HasSubstr("have 3 columns")));
  const std::string infinite =
      Writer().put(0.0F).put(std::numeric_limits<float>::infinity()).put(0.0F).bytes() +
      points.substr(12);
  EXPECT_THAT(said(trx_file("float32", infinite, "uint32", good, 3, 2)),
              HasSubstr("point 0 is not finite"));
}

}  // namespace
}  // namespace caplet
