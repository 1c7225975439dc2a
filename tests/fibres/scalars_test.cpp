// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Numbers of files of fibres, as other programs wrote them, and VTK's files of XML.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <random>

#include "fibre_bytes.h"
#include "import/detail/fibres.h"
#include "import/import.h"
#include "support/data.h"
#include "support/import_files.h"
#include "support/zip_text.h"

namespace caplet {
namespace {

using test::complaint;
using test::scene_of;
using test::trk_file;
using test::Writer;
using testing::AllOf;
using testing::HasSubstr;

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

}  // namespace
}  // namespace caplet
