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

/// Bytes of numbers, one after the other.
class Writer {
 public:
  explicit Writer(bool swapped = false) : swapped_(swapped) {}
  template <class Number>
  Writer& put(Number value) {
    std::array<char, sizeof(Number)> bytes{};
    std::memcpy(bytes.data(), &value, sizeof value);
    if (swapped_) std::reverse(bytes.begin(), bytes.end());
    out_.append(bytes.data(), bytes.size());
    return *this;
  }
  template <class Number>
  Writer& put_at(std::size_t at, Number value) {
    const std::string before = out_.substr(at + sizeof value);
    out_.resize(at);
    put(value);
    out_ += before;
    return *this;
  }
  Writer& fill(std::size_t size) {
    out_.resize(size, '\0');
    return *this;
  }
  Writer& text(const std::string& text) {
    out_ += text;
    return *this;
  }
  const std::string& bytes() const { return out_; }

 private:
  bool swapped_;
  std::string out_;
};

Scene scene_of(const std::string& name, const std::string& bytes,
               const ImportOptions& options = {}) {
  return import_scene(test::write_file(name, bytes), test::NoImages(), options);
}

std::string hair_file(std::uint32_t strands, std::uint32_t points, std::uint32_t flags,
                      const Writer& arrays) {
  Writer out;
  out.text("HAIR")
      .put(strands)
      .put(points)
      .put(flags)
      .put(std::uint32_t{1})
      .put(0.5F)
      .put(0.0F)
      .put(0.9F)
      .put(0.5F)
      .put(0.25F)
      .fill(128);
  return out.bytes() + arrays.bytes();
}

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
std::string trk_file(glm::vec3 p, const std::string& order, const std::array<float, 16>& matrix,
                     bool swapped) {
  Writer out(swapped);
  out.text("TRACK")
      .fill(6)
      .put(std::int16_t{10})
      .put(std::int16_t{20})
      .put(std::int16_t{30})
      .put(2.0F)
      .put(3.0F)
      .put(4.0F)
      .fill(36);
  out.put(std::int16_t{1}).fill(238).put(std::int16_t{2}).fill(440);
  for (const float value : matrix) out.put(value);
  out.fill(948).text(order).fill(992).put(std::int32_t{2}).put(std::int32_t{1000});
  for (int track = 0; track < 2; ++track) {
    out.put(std::int32_t{1 + track});
    for (int i = 0; i <= track; ++i) out.put(p.x).put(p.y).put(p.z).put(7.0F);
    out.put(1.0F).put(1.0F);
  }
  return out.bytes();
}

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
  // z is up.
  EXPECT_EQ(glm::dvec3(scene.shapes[0].world_from_object * glm::dvec4(0, 0, 1, 0)),
            glm::dvec3(0, 1, 0));
}

// --- Scalars ---

/// What tests/fibres/files/make.py gave to nibabel, trx-python and VTK; what the file calls its
/// three columns.
struct Written {
  const char* file;
  std::string columns;
};
const Written written[] = {{"scalars.trk", "columns"},       {"scalars.trx", "columns"},
                           {"scalars.vtk", "three columns"}, {"old.vtk", "three columns"},
                           {"text.vtp", "three columns"},    {"packed.vtp", "three columns"},
                           {"plain.vtp", "three columns"},   {"appended.vtp", "three columns"},
                           {"raw.vtp", "three columns"},     {"raw_packed.vtp", "three columns"},
                           {"big.vtp", "three columns"}};

std::filesystem::path file_of(const Written& one) {
  return test::source_folder() / "tests/fibres/files" / one.file;
}

FibreScalars scalars_of(const Written& one, const std::string& wanted) {
  FibreScalars out;
  out.wanted = wanted;
  const std::filesystem::path path = file_of(one);
  std::ifstream stream(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)),
                          std::istreambuf_iterator<char>());
  const Fibres fibres = path.extension() == ".trx"   ? read_trx(path, &out)
                        : path.extension() == ".trk" ? read_trk(bytes, one.file, &out)
                        : path.extension() == ".vtp" ? read_vtp(bytes, one.file, &out)
                                                     : read_vtk(bytes, one.file, &out);
  EXPECT_EQ(fibres.ends, (std::vector<std::uint64_t>{3, 5})) << one.file;
  EXPECT_EQ(fibres.points.at(4), glm::vec3(0, 3, 5)) << one.file;
  return out;
}

TEST(Scalars, OfFilesOfOtherPrograms) {
  for (const Written& one : written) {
    const FibreScalars fa = scalars_of(one, "fa");
    EXPECT_TRUE(fa.of_points) << one.file;
    EXPECT_EQ(fa.values, (std::vector<float>{0.1F, 0.2F, 0.3F, 0.4F, 0.5F})) << one.file;
    const FibreScalars column = scalars_of(one, one.columns + "[1]");
    EXPECT_EQ(column.values, (std::vector<float>{1, 4, 7, 10, 13})) << one.file;
    const FibreScalars weight = scalars_of(one, "weight");
    EXPECT_FALSE(weight.of_points) << one.file;
    EXPECT_EQ(weight.values, (std::vector<float>{5, -2}))
        << one.file;  // the cell before the lines is none of them
    const FibreScalars none = scalars_of(one, "FA");
    EXPECT_EQ(none.name, "");
    std::vector<std::string> names = none.names;
    std::ranges::sort(names);
    std::vector<std::string> expected{one.columns + "[0]", one.columns + "[1]", one.columns + "[2]",
                                      "fa", "weight"};
    std::ranges::sort(expected);
    EXPECT_EQ(names, expected) << one.file;
  }
  EXPECT_EQ(scalars_of(written[0], "").name, "columns[0]");
  EXPECT_EQ(scalars_of(written[1], "").name, "columns[0]");
  EXPECT_EQ(scalars_of(written[2], "").name, "weight");  // VTK writes those of cells first
}

// --- VTK's XML ---

std::string vtp(const std::string& piece, const std::string& attributes = "type='PolyData'",
                const std::string& more = "") {
  return "<VTKFile " + attributes + ">\n<PolyData>\n" + piece + "\n</PolyData>" + more +
         "</VTKFile>";
}
std::string vtp_lines(const std::string& connectivity, const std::string& offsets,
                      const std::string& points = "0 0 0 1 0 0 1 1 0",
                      const std::string& more = "") {
  return "<Piece NumberOfPoints='3' NumberOfLines='1'>" + more +
         "<Points><DataArray type='Float32' format='ascii'>" + points +
         "</DataArray></Points>\n<Lines><DataArray Name='connectivity' type='Int32' "
         "format='ascii'>" +
         connectivity + "</DataArray><DataArray Name='offsets' type='Int32' format='ascii'>" +
         offsets + "</DataArray></Lines></Piece>";
}

TEST(Vtp, LinesAreThoseOfTheirOffsets) {
  const Fibres fibres = read_vtp(vtp(vtp_lines("2 0 1", "3")), "a.vtp");
  EXPECT_EQ(fibres.points, (std::vector<glm::vec3>{{1, 1, 0}, {0, 0, 0}, {1, 0, 0}}));
  EXPECT_EQ(fibres.ends, (std::vector<std::uint64_t>{3}));
}

// A piece without numbers of lines has none; one without numbers of points has no points.
TEST(Vtp, PiecesWithoutNumbersAreEmpty) {
  const std::string empty =
      "<Piece NumberOfPoints='1'><Points><DataArray type='Float32' format='ascii'>0 0 "
      "0</DataArray></Points></Piece>";
  EXPECT_EQ(read_vtp(vtp(empty + vtp_lines("2 0 1", "3")), "a.vtp").ends,
            (std::vector<std::uint64_t>{3}));
  std::string one = vtp_lines("0", "1", "0 0 0");
  one.replace(one.find(" NumberOfPoints='3'"), 19, "");
  try {
    read_vtp(vtp(one), "a.vtp");
    ADD_FAILURE() << "was read";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("3 numbers are no 0 points"));
  }
}

// VTK writes what it cannot part into each piece.
TEST(Vtp, PiecesAreJoined) {
  std::ifstream stream(test::source_folder() / "tests/fibres/files/pieces.vtp", std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)),
                          std::istreambuf_iterator<char>());
  FibreScalars weight;
  weight.wanted = "weight";
  const Fibres fibres = read_vtp(bytes, "pieces.vtp", &weight);
  EXPECT_EQ(fibres.ends, (std::vector<std::uint64_t>{3, 5, 8, 10}));
  EXPECT_EQ(fibres.points.at(9), glm::vec3(0, 3, 5));
  EXPECT_EQ(weight.values, (std::vector<float>{5, -2, 5, -2}));
  std::string other = bytes;  // the second piece calls it otherwise
  other.replace(other.rfind("Name=\"weight\""), 13, "Name=\"height\"");
  FibreScalars again;
  again.wanted = "weight";
  EXPECT_THAT(complaint([&] { read_vtp(other, "pieces.vtp", &again); }),
              HasSubstr("without the numbers 'weight'"));
}

TEST(Vtp, BadInput) {
  const auto said = [](const std::string& text, FibreScalars* scalars = nullptr) {
    return complaint([&] { read_vtp(text, "x.vtp", scalars); });
  };
  EXPECT_THAT(said("# vtk DataFile"), HasSubstr("x.vtp:1:"));
  EXPECT_THAT(said("<Vtk/>"), HasSubstr("is no XML file of VTK"));
  EXPECT_THAT(said(vtp("", "type='UnstructuredGrid'")),
              HasSubstr("only PolyData is read, not 'UnstructuredGrid'"));
  EXPECT_THAT(said(vtp("", "type='PolyData' byte_order='Middle'")),
              HasSubstr("'Middle' is no order"));
  EXPECT_THAT(said(vtp("", "type='PolyData' header_type='UInt8'")), HasSubstr("'UInt8'"));
  EXPECT_THAT(said(vtp("", "type='PolyData' compressor='vtkLZ4DataCompressor'")),
              HasSubstr("'vtkLZ4DataCompressor' packed is not read"));
  EXPECT_THAT(said(vtp("")), HasSubstr("x.vtp: holds no lines"));
  EXPECT_THAT(said(vtp(vtp_lines("0 1 3", "3"))),
              AllOf(HasSubstr("x.vtp:4:"), HasSubstr("point 3: there are 3")));
  EXPECT_THAT(said(vtp(vtp_lines("0 1 -1", "3"))), HasSubstr("point -1"));
  EXPECT_THAT(said(vtp(vtp_lines("0 1", "3"))), HasSubstr("from 0 to 3 of 2"));
  EXPECT_THAT(said(vtp(vtp_lines("0 1", "2 1"))), HasSubstr("2 offsets of 1 lines"));
  EXPECT_THAT(said(vtp(vtp_lines("0 1", "nan"))), HasSubstr("of 2 indices"));
  EXPECT_THAT(said(vtp(vtp_lines("0 1", "2", "0 0 0"))), HasSubstr("3 numbers are no 3 points"));
  EXPECT_THAT(said(vtp(vtp_lines("0 1", "2", "0 0 0 1 0 0 1 inf 0"))),
              HasSubstr("point 2 is not finite"));
  EXPECT_THAT(said(vtp(vtp_lines("0 x", "2"))), HasSubstr("'x' is not a number"));
  EXPECT_THAT(said(vtp("<Piece NumberOfLines='1'/>")), HasSubstr("<Piece> without points"));
  const auto points = [&](const std::string& array, const std::string& attributes = "",
                          const std::string& appended = "") {
    return said(vtp("<Piece NumberOfPoints='1' NumberOfLines='1'><Points><DataArray " + array +
                        "</DataArray></Points></Piece>",
                    "type='PolyData' " + attributes, appended));
  };
  EXPECT_THAT(points("format='hex'>"), HasSubstr("'hex' is no format"));
  EXPECT_THAT(points("format='binary' type='String'>DAAAAA=="), HasSubstr("'String' is no type"));
  EXPECT_THAT(points("format='binary' type='Float32'>DA"), HasSubstr("announced"));
  EXPECT_THAT(points("format='binary' type='Float32'>DAAAAA==AAAA"),
              HasSubstr("16 bytes are announced, and 12 are there"));
  EXPECT_THAT(points("format='binary' type='Float32'>////////AAAA"),
              HasSubstr("4294967295 bytes are announced"));
  EXPECT_THAT(points("format='binary' type='Float32'>D-AAAA=="), HasSubstr("none of base64"));
  EXPECT_THAT(points("format='appended' type='Float32' offset='9'>", "",
                     "<AppendedData encoding='base64'>_AAAA</AppendedData>"),
              HasSubstr("begins at byte 9 of 4"));
  const std::string packed = "compressor='vtkZLibDataCompressor'";
  EXPECT_THAT(points("format='binary' type='Float32'>AACAfwAAAAAAAAAA", packed),
              HasSubstr("blocks are announced"));
  // One block of 2^30 bytes, packed into 8; and one of 12 that is no deflate.
  EXPECT_THAT(points("format='binary' type='Float32'>AQAAAAAAAEAAAAAACAAAAA==AAAAAAAAAAA=", packed),
              HasSubstr("cannot be packed into 8"));
  EXPECT_THAT(points("format='binary' type='Float32'>AQAAAAwAAAAAAAAACAAAAA==AAAAAAAAAAA=", packed),
              HasSubstr("block 1 is broken"));
  EXPECT_THAT(points("format='binary' type='Float32'>AQAAAAwAAAAAAAAA/////w==AAAAAAAAAAA=", packed),
              HasSubstr("longer than the file"));
  FibreScalars first;
  EXPECT_THAT(said(vtp(vtp_lines("0 1", "2", "0 0 0 1 0 0 1 1 0",
                                 "<PointData><DataArray Name='a' type='Int8' format='ascii'>1 "
                                 "2</DataArray></PointData>")),
                   &first),
              HasSubstr("2 rows of 1 numbers are too few"));
}

// Files that end early, or of which a byte is another: read, or refused.
TEST(Vtp, ChangedFilesAreReadOrRefused) {
  std::size_t refused = 0;
  for (const Written& one : written) {
    if (!std::string_view(one.file).ends_with(".vtp")) continue;
    std::ifstream stream(file_of(one), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)),
                            std::istreambuf_iterator<char>());
    const auto read = [&](const std::string& changed) {
      FibreScalars scalars;
      try {
        const Fibres fibres = read_vtp(changed, "x.vtp", &scalars);
        EXPECT_EQ(fibres.ends.back(), fibres.points.size());
      } catch (const InputError&) {
        ++refused;
      }
    };
    for (std::size_t i = 0; i < bytes.size(); i += 7) {
      read(bytes.substr(0, i));
      std::string changed = bytes;
      changed[i] = static_cast<char>(changed[i] ^ (1 << i % 8));
      read(changed);
    }
  }
  EXPECT_GT(refused, 3000U);
}

/// Linear sRGB of the first and last colours of matplotlib's viridis, (68, 1, 84) and (253, 231,
/// 37) of 255.
glm::dvec3 decoded(glm::dvec3 srgb) {
  for (int k = 0; k < 3; ++k)
    srgb[k] = srgb[k] <= 0.04045 ? srgb[k] / 12.92 : std::pow((srgb[k] + 0.055) / 1.055, 2.4);
  return srgb;
}

TEST(Scalars, ColoursAndLegend) {
  const glm::dvec3 lowest = decoded(glm::dvec3(68, 1, 84) / 255.0),
                   highest = decoded(glm::dvec3(253, 231, 37) / 255.0);
  for (const Written& one : written) {
    const auto scene_by = [&](std::map<std::string, std::string> options) {
      return import_scene(file_of(one), test::NoImages(), ImportOptions(std::move(options)));
    };
    const auto color = [](const Scene& scene, std::size_t i) {
      const auto& capsules = std::get<CapsulesShape>(scene.shapes.at(0).geometry);
      return std::get<RgbSpectrum>(
                 std::get<DiffuseMaterial>(scene.materials.at(capsules.materials.at(i)).model)
                     .reflectance)
          .rgb;
    };
    const Scene by_weight = scene_by({{"color", "scalar:weight"}});
    EXPECT_LT(glm::length(color(by_weight, 0) - highest),
              0.005);  // half a step of 255, through the curve's steepest part
    EXPECT_EQ(color(by_weight, 0), color(by_weight, 1));
    EXPECT_LT(glm::length(color(by_weight, 2) - lowest), 0.005);
    ASSERT_TRUE(by_weight.legend);
    EXPECT_EQ(by_weight.legend->title, "weight");
    EXPECT_EQ(by_weight.legend->low, -2);
    EXPECT_EQ(by_weight.legend->high, 5);
    // A segment has the mean of its ends: 0.15, 0.25 and 0.45 of 0.15 to 0.45.
    const Scene by_fa = scene_by({{"color", "scalar:fa"}, {"range", "0.15,0.45"}});
    EXPECT_LT(glm::length(color(by_fa, 0) - lowest), 0.005);
    EXPECT_LT(glm::length(color(by_fa, 2) - highest), 0.005);
    const auto& capsules = std::get<CapsulesShape>(by_fa.shapes.at(0).geometry);
    EXPECT_EQ(by_fa.materials.at(capsules.materials.at(1)).name, "fa 0.25");  // step 21 of 63
    const auto said = [&](std::map<std::string, std::string> options) {
      return complaint([&] { scene_by(std::move(options)); });
    };
    EXPECT_THAT(said({{"color", "scalar:FA"}}),
                AllOf(HasSubstr("--color"), HasSubstr("'FA' is none"), HasSubstr("'weight'")));
    EXPECT_THAT(said({{"color", "scalar:"}}), HasSubstr("--color"));
    EXPECT_THAT(said({{"range", "0,1"}}), AllOf(HasSubstr("--range"), HasSubstr("--color scalar")));
    EXPECT_THAT(said({{"color", "scalars"}}), HasSubstr("direction, fibre, file, scalar"));
  }
}

TEST(Scalars, WithoutValues) {
  // One end of a segment has none: the other's. Both: grey, and not of the range.
  const std::string head =
      "# vtk DataFile Version 3.0\nlines\nASCII\nDATASET POLYDATA\nPOINTS 5 float\n0 0 0 1 0 0 2 0 "
      "0 3 0 0 4 0 0\n"
      "LINES 1 6\n5 0 1 2 3 4\nPOINT_DATA 5\nSCALARS t float\n";
  const Scene scene = scene_of("n.vtk", head + "1 nan nan 3 inf\n", {{{"color", "scalar"}}});
  const auto& capsules = std::get<CapsulesShape>(scene.shapes.at(0).geometry);
  const auto name = [&](std::size_t i) {
    return scene.materials.at(capsules.materials.at(i)).name;
  };
  EXPECT_EQ(name(0), "t 1");
  EXPECT_EQ(name(1), "t unknown");
  EXPECT_EQ(name(2), "t 3");
  EXPECT_EQ(name(3), "t 3");  // beyond the range: its end
  EXPECT_EQ(scene.legend->high, 3);
  EXPECT_THAT(complaint([&] {
                scene_of("n.vtk", head + "nan nan nan nan nan\n", {{{"color", "scalar"}}});
              }),
              HasSubstr("there is no value"));
  EXPECT_THAT(complaint([&] {
                scene_of(
                    "n.hair",
                    hair_file(1, 2, 2,
                              Writer().put(0.0F).put(0.0F).put(0.0F).put(1.0F).put(0.0F).put(0.0F)),
                    {{{"color", "scalar"}}});
              }),
              AllOf(HasSubstr("--color"), HasSubstr("no scalars")));
}

// vtkDataWriter::EncodeString: a blank, '%' and '"' are a '%' and two digits of 16, wherever they
// stand.
TEST(Scalars, NamesOfVtkAreDecoded) {
  const auto title = [](const std::string& written) {
    const Scene scene = scene_of(
        "name.vtk",
        "# vtk DataFile Version 3.0\nlines\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n0 0 0 1 0 0\n"
        "LINES 1 3\n2 0 1\nPOINT_DATA 2\nSCALARS " +
            written + " float\nLOOKUP_TABLE default\n1 2\n",
        {{{"color", "scalar"}}});
    return scene.legend ? scene.legend->title : "";
  };
  EXPECT_EQ(title("water%20content%20%25"), "water content %");
  EXPECT_EQ(title("%22fa%22"), "\"fa\"");
  EXPECT_EQ(title("100%"), "100%");
  EXPECT_EQ(title("a%2"), "a%2");
  EXPECT_EQ(title("a%zz"), "a%zz");
}

TEST(BadScalars, AreRefused) {
  const std::string head =
      "# vtk DataFile Version 3.0\nlines\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n0 0 0 1 0 "
      "0\nLINES 1 3\n2 0 1\n";
  const auto said = [&](const std::string& rest, const std::string& wanted = "") {
    FibreScalars scalars;
    scalars.wanted = wanted;
    return complaint([&] { read_vtk(head + rest, "x.vtk", &scalars); });
  };
  EXPECT_EQ(said("POINT_DATA 2\nSCALARS a float\nLOOKUP_TABLE default\n1 2\n"), "");
  EXPECT_THAT(said("POINT_DATA 3\n"), HasSubstr("there are 2"));
  EXPECT_THAT(said("CELL_DATA 2\n"), HasSubstr("there are 1"));
  EXPECT_THAT(said("POINT_DATA 2\nSCALARS a float\nLOOKUP_TABLE default\n1 x\n"),
              AllOf(HasSubstr("x.vtk:12"), HasSubstr("'x'")));
  EXPECT_THAT(said("POINT_DATA 2\nSCALARS a float\n1\n"), HasSubstr("ends early"));
  EXPECT_THAT(said("POINT_DATA 2\nSCALARS a colour\n1\n"), HasSubstr("'colour' is no type"));
  EXPECT_THAT(said("POINT_DATA 2\nFIELD f 1\na 1 3 float\n1 2 3\n"),
              HasSubstr("has 3 rows; there are 2 points"));
  EXPECT_THAT(said("POINT_DATA 2\nFIELD f 1\na 99999999 99999999999999 float\n1 2 3\n", "b"),
              HasSubstr("x.vtk"));
  EXPECT_THAT(said("POINT_DATA 2\nPICTURES f 1\n"), HasSubstr("'PICTURES'"));
  EXPECT_EQ(complaint([&] { read_vtk(head + "POINT_DATA 2\nPICTURES f 1\n", "x.vtk"); }),
            "");  // nothing is asked of it
  const auto offsets = [](const std::string& rest) {
    return complaint([&] {
      read_vtk(
          "# vtk DataFile Version 5.1\nlines\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n0 0 0 1 0 "
          "0\nLINES 2 2\n" +
              rest,
          "x.vtk");
    });
  };
  EXPECT_EQ(offsets("OFFSETS vtktypeint64\n0 2\nCONNECTIVITY vtktypeint64\n0 1\n"), "");
  EXPECT_THAT(offsets("OFFSETS vtktypeint64\n0 3\nCONNECTIVITY vtktypeint64\n0 1\n"),
              HasSubstr("from 0 to 3 of 2"));
  EXPECT_THAT(offsets("OFFSETS vtktypeint64\n0 2\n0 1\n"), HasSubstr("CONNECTIVITY"));
  const auto trx = [](const std::string& name, const std::string& values) {
    const std::string header = "{\"NB_VERTICES\": 2, \"NB_STREAMLINES\": 1}", points(24, '\0');
    const std::string bytes = test::zip_of({{"header.json", header},
                                            {"positions.3.float32", points},
                                            {"offsets.uint32", std::string(4, '\0')},
                                            {name, values}},
                                           true);
    FibreScalars scalars;
    return complaint([&] { read_trx(test::write_file("s.trx", bytes), &scalars); });
  };
  EXPECT_EQ(trx("dpv/a.uint8", "ab"), "");
  EXPECT_THAT(trx("dpv/a.uint8", "abc"), HasSubstr("2 values of 1 bytes"));
  EXPECT_THAT(trx("dpv/a.bit", "a"), HasSubstr("'bit' is no type"));
  EXPECT_THAT(trx("dps/a.99999.uint8", "a"), HasSubstr("99999 columns"));
  // The last track's properties are cut off.
  const std::string trk =
      trk_file({1, 2, 3}, "RAS", {2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 0, 0, 0, 1}, false);
  EXPECT_THAT(
      complaint([&] { read_trk(std::string_view(trk).substr(0, trk.size() - 4), "x.trk"); }),
      HasSubstr("announced"));
  FibreScalars unnamed;
  unnamed.wanted = "property 2";
  read_trk(trk, "x.trk", &unnamed);
  EXPECT_EQ(unnamed.names, (std::vector<std::string>{"scalar 1", "property 1", "property 2"}));
  EXPECT_EQ(unnamed.values, (std::vector<float>{1, 1}));
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
