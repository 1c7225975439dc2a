// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet pick`: reports, tables, and lists of rays longer than memory should hold.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "program.h"
#include "support/data.h"

namespace caplet::pick_test {
namespace {

using test::Result;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// A ball whose name needs quotes in CSV, a capsule without a name, an object of a named and an
/// unnamed ball placed twice, and a floor: in rows along x, so that rays along -z through (x, 0)
/// tell them apart. No shape at x = -2.
std::filesystem::path folder_with_scene() {
  return test::folder_with_scene(
      "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 90\n"
      "Film \"rgb\" \"integer xresolution\" 40 \"integer yresolution\" 20\nWorldBegin\nLightSource "
      "\"infinite\"\n"
      "MakeNamedMaterial \"mat, \xc3\xa9\" \"string type\" \"diffuse\"\nNamedMaterial \"mat, "
      "\xc3\xa9\"\n"
      "Shape \"sphere\" \"string name\" \"ball, \\\"big\\\"\"\n"
      "Material \"diffuse\"\n"
      "Shape \"capsule\" \"point3 p0\" [3 -1 0] \"point3 p1\" [3 1 0] \"float radius\" 0.5\n"
      "ObjectBegin \"pair\"\n"
      "Shape \"sphere\" \"float radius\" 0.5 \"string name\" \"left\"\n"
      "Translate 2 0 0\nShape \"sphere\" \"float radius\" 0.25\nObjectEnd\n"
      "AttributeBegin\nTranslate 5 0 0\nObjectInstance \"pair\"\nAttributeEnd\n"
      "AttributeBegin\nTranslate 9 0 1\nScale 1 1 2\nObjectInstance \"pair\"\nAttributeEnd\n"
      "Translate 0 0 -3\nShape \"disk\" \"float radius\" 1.5\n");
}

const char* const header = "ray,t,object,primitive,surface,material,entering,x,y,z,nx,ny,nz,u,v";

// Through each thing, and one that misses.
const std::vector<double> xs = {0.25, -2, 3, 5, 7, 9, 11};

std::string rays_text() {
  std::ostringstream out;
  out << "# origin, direction: t counts in lengths of two\n";
  for (const double x : xs) out << x << " 0.125 4  0 0 -2\n\n";
  return out.str();
}

/// One line of CSV by RFC 4180.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> out(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      if (quoted && i + 1 < line.size() && line[i + 1] == '"')
        out.back() += line[++i];
      else
        quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      out.emplace_back();
    } else {
      out.back() += line[i];
    }
  }
  return out;
}

/// A column of a structured array.
struct Field {
  std::string name, type;
  std::size_t offset = 0, bytes = 0;
};

/// A one-dimensional structured .npy file, read as its format's description says, by no code of the
/// program's.
struct Table {
  std::vector<Field> fields;
  std::size_t rows = 0, row_bytes = 0;
  std::string data;

  std::string cell(std::size_t row, std::size_t column) const {
    const Field& f = fields[column];
    const char* at = data.data() + row * row_bytes + f.offset;
    const auto number = [&](auto value) {
      std::memcpy(&value, at, sizeof value);
      return value;
    };
    if (f.type == "<i8") return std::to_string(number(std::int64_t{}));
    if (f.type == "<i4") return std::to_string(number(std::int32_t{}));
    if (f.type == "|b1") return std::to_string(number(char{}));
    if (f.type == "<f4") {
      char text[64];
      return {text, std::to_chars(text, text + sizeof text, number(float{})).ptr};
    }
    std::string out;  // <U: UCS4, padded with zeros
    for (std::size_t i = 0; i < f.bytes; i += 4) {
      std::uint32_t c = 0;
      std::memcpy(&c, at + i, 4);
      if (c == 0) break;
      if (c < 0x80) {
        out += static_cast<char>(c);
      } else {
        out += static_cast<char>(0xc0 | c >> 6);
        out += static_cast<char>(0x80 | (c & 0x3f));
      }
    }
    return out;
  }
};

Table read_table(const std::filesystem::path& path) {
  Table out;
  const std::string bytes = test::read_file(path);
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\1\0", 8));
  const std::size_t length =
      static_cast<unsigned char>(bytes[8]) + 256u * static_cast<unsigned char>(bytes[9]);
  const std::string text = bytes.substr(10, length);
  EXPECT_THAT(text, AllOf(HasSubstr("'fortran_order': False"), HasSubstr(",)")));
  std::size_t at = text.find("'descr': [");
  const std::size_t end = text.find(']', at);
  while ((at = text.find("('", at)) < end) {
    const std::size_t comma = text.find("', '", at), close = text.find("')", at);
    Field f{text.substr(at + 2, comma - at - 2), text.substr(comma + 4, close - comma - 4),
            out.row_bytes, 0};
    f.bytes = std::stoul(f.type.substr(2)) * (f.type[1] == 'U' ? 4 : 1);
    out.row_bytes += f.bytes;
    out.fields.push_back(f);
    at = close;
  }
  out.rows = std::stoul(text.substr(text.find("'shape': (") + 10));
  out.data = bytes.substr(10 + length);
  EXPECT_EQ(out.data.size(), out.rows * out.row_bytes);
  return out;
}

/// float32, C order.
void write_rays(const std::filesystem::path& path, std::size_t count,
                const std::function<void(std::size_t, float*)>& ray) {
  std::ofstream out(path, std::ios::binary);
  std::string text =
      "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(count) + ", 6), }";
  text.resize(117, ' ');
  out << std::string("\x93NUMPY\1\0\x76\0", 10) << text << '\n';
  for (std::size_t i = 0; i < count; ++i) {
    float numbers[6];
    ray(i, numbers);
    out.write(reinterpret_cast<const char*>(numbers), sizeof numbers);
  }
}

TEST(Pick, TablesOfRays) {
  const auto folder = folder_with_scene();
  test::write_file(folder / "rays.txt", rays_text());
  const Result result =
      test::run_program({"pick", "scene.pbrt", "--rays", "rays.txt", "--out", "out.csv"}, folder);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("7 rays, 6 crossings"));
  const auto lines = test::lines_of(test::read_file(folder / "out.csv"));
  ASSERT_EQ(lines.size(), 7u);
  EXPECT_EQ(lines[0], header);
  // The world's shapes are 0 to 2, the instances 3 and 4.
  const std::vector<std::string> objects = {"ball, \"big\"", "1", "left", "3", "left", "4"};
  const std::vector<std::string> rays = {"0", "2", "3", "4", "5", "6"};
  const double top[] = {std::sqrt(1 - 0.0625 - 0.015625),   std::sqrt(0.25),
                        std::sqrt(0.25 - 0.015625),         std::sqrt(0.0625 - 0.015625),
                        1 + 2 * std::sqrt(0.25 - 0.015625), 1 + 2 * std::sqrt(0.0625 - 0.015625)};
  for (std::size_t i = 0; i < 6; ++i) {
    SCOPED_TRACE(lines[i + 1]);
    const auto cells = cells_of(lines[i + 1]);
    ASSERT_EQ(cells.size(), 15u);
    EXPECT_EQ(cells[0], rays[i]);
    EXPECT_EQ(cells[2], objects[i]);
    EXPECT_EQ(cells[3], "0");
    EXPECT_EQ(cells[4], "0");
    EXPECT_EQ(cells[5], i == 0 ? "mat, \xc3\xa9" : "1");
    EXPECT_EQ(cells[6], "1");
    // 16 eps of the origin's distance from the shapes, at most 6, for the parameter; twice that for
    // what is made of it.
    constexpr double bound = 32 * 0x1p-24 * 6;
    EXPECT_NEAR(std::stod(cells[1]), (4 - top[i]) / 2, bound);
    EXPECT_NEAR(std::stod(cells[7]), xs[i + (i > 0)], bound);
    EXPECT_NEAR(std::stod(cells[8]), 0.125, bound);
    EXPECT_NEAR(std::stod(cells[9]), top[i], bound);
    EXPECT_NEAR(std::hypot(std::stod(cells[10]), std::stod(cells[11]), std::stod(cells[12])), 1,
                1e-6);
    EXPECT_GT(std::stod(cells[12]), 0);
  }
}

TEST(Pick, TablesOfAllCrossingsInBothFormats) {
  const auto folder = folder_with_scene();
  test::write_file(folder / "rays.txt", rays_text());
  for (const char* out : {"out.csv", "out.npy"}) {
    const Result result = test::run_program(
        {"pick", "scene.pbrt", "--rays", "rays.txt", "--out", out, "--all", "-q"}, folder);
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "");
  }
  const auto lines = test::lines_of(test::read_file(folder / "out.csv"));
  const Table table = read_table(folder / "out.npy");
  ASSERT_EQ(lines.size(), 14u);
  ASSERT_EQ(table.rows, 13u);
  std::string names;
  for (const Field& f : table.fields) names += (names.empty() ? "" : ",") + f.name;
  EXPECT_EQ(names, header);
  std::string previous_ray;
  double previous_t = 0;
  std::vector<std::string> of_the_ball;
  for (std::size_t i = 0; i < table.rows; ++i) {
    const auto cells = cells_of(lines[i + 1]);
    ASSERT_EQ(cells.size(), table.fields.size());
    for (std::size_t k = 0; k < cells.size(); ++k)
      EXPECT_EQ(table.cell(i, k), cells[k]) << lines[i + 1] << " " << names;
    const double t = std::stod(cells[1]);
    EXPECT_GT(t, cells[0] == previous_ray ? previous_t : 0);
    previous_ray = cells[0];
    previous_t = t;
    EXPECT_GE(std::stod(cells[12]), 0) << "the normal points against the ray, on the way out too";
    if (cells[0] == "0") of_the_ball.push_back(cells[2] + " " + cells[6]);
  }
  EXPECT_THAT(of_the_ball, ElementsAre("ball, \"big\" 1", "ball, \"big\" 0", "2 1"));
}

TEST(Pick, ArraysAndTextAreTheSameRays) {
  const auto folder = folder_with_scene();
  test::write_file(folder / "rays.txt", rays_text());
  write_rays(folder / "rays.npy", xs.size(), [](std::size_t i, float* ray) {
    const float numbers[] = {static_cast<float>(xs[i]), 0.125f, 4, 0, 0, -2};
    std::copy_n(numbers, 6, ray);
  });
  for (const char* rays : {"rays.txt", "rays.npy"})
    ASSERT_EQ(test::run_program({"pick", "scene.pbrt", "--rays", rays, "--out",
                                 std::string(rays) + ".csv", "--all"},
                                folder)
                  .code,
              0);
  EXPECT_EQ(test::read_file(folder / "rays.txt.csv"), test::read_file(folder / "rays.npy.csv"));
  EXPECT_EQ(test::names_in(folder),
            (std::vector<std::string>{"rays.npy", "rays.npy.csv", "rays.txt", "rays.txt.csv",
                                      "scene.pbrt"}));
  // No rays are no error: a table without rows.
  test::write_file(folder / "none.txt", "# nothing\n");
  for (const char* out : {"none.csv", "none.npy"})
    EXPECT_EQ(
        test::run_program({"pick", "scene.pbrt", "--rays", "none.txt", "--out", out}, folder).code,
        0);
  EXPECT_EQ(test::read_file(folder / "none.csv"), std::string(header) + "\n");
  EXPECT_EQ(read_table(folder / "none.npy").rows, 0u);
}

// A ball of radius 1 before the ray: it enters at 4 and leaves at 6.
TEST(Pick, RaysOfStdinHaveLimits) {
  const auto folder = test::folder_with_scene("WorldBegin\nShape \"sphere\"\n");
  const auto rays = folder.parent_path() / (folder.filename().string() + "-rays");
  test::write_file(rays,
                   "0 0 -5 0 0 1\n0 0 -5 0 0 1 5 inf\n0 0 -5 0 0 1 0 3\n0 0 -5 0 0 2 0 2.5\n0 0 -5 "
                   "0 0 1 4.5 5.5\n");
  const Result result =
      test::run_program({"pick", "scene.pbrt", "--rays", "-", "--out", "-", "-q"}, folder, {},
                        [&] { ::dup2(::open(rays.c_str(), O_RDONLY), STDIN_FILENO); });
  ASSERT_EQ(result.code, 0) << result.err;
  const auto lines = test::lines_of(result.out);
  ASSERT_EQ(lines.size(), 4u) << result.out;
  EXPECT_THAT(lines[1], testing::StartsWith("0,4,"));
  EXPECT_THAT(lines[2], testing::StartsWith("1,6,"));
  EXPECT_THAT(lines[3], testing::StartsWith("3,2,"));
}

TEST(Pick, TooManyCrossingsAreAnErrorThatNamesTheRays) {
  const auto folder = folder_with_scene();
  test::write_file(folder / "rays.txt", rays_text());
  test::write_file(folder / "out.csv", "the previous table");
  const Result result = test::run_program(
      {"pick", "scene.pbrt", "--rays", "rays.txt", "--out", "out.csv", "--all", "--limit", "1"},
      folder);
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, HasSubstr("caplet: error: ray 0, 2, 3, 4, 5, 6: more than 1 crossings"));
  EXPECT_THAT(result.err, HasSubstr("--limit"));
  EXPECT_EQ(test::read_file(folder / "out.csv"), "the previous table");
  EXPECT_EQ(test::names_in(folder).size(), 3u);
  const Result two = test::run_program(
      {"pick", "scene.pbrt", "--rays", "rays.txt", "--out", "out.csv", "--all", "--limit", "2"},
      folder);
  EXPECT_EQ(two.code, 1);
  EXPECT_THAT(two.err, HasSubstr("ray 0: more than 2 crossings"));
  EXPECT_EQ(test::run_program({"pick", "scene.pbrt", "--rays", "rays.txt", "--out", "out.csv",
                               "--all", "--limit", "3"},
                              folder)
                .code,
            0);
  const Result one = test::run_program(
      {"pick", "scene.pbrt", "--ray", "0,0,5,0,0,-1", "--all", "--limit", "2"}, folder);
  EXPECT_EQ(one.code, 1);
  EXPECT_EQ(one.out, "");
}

TEST(Pick, JsonOfARayBesideTheReference) {
  const auto folder = folder_with_scene();
  const Result result = test::run_program(
      {"pick", "scene.pbrt", "--ray", "-0.25,0.125,4,0,0,-2", "--json", "--reference"}, folder);
  ASSERT_EQ(result.code, 0) << result.err;
  const auto report = nlohmann::json::parse(result.out);
  EXPECT_EQ(report.at("scene"), "scene.pbrt");
  EXPECT_EQ(report.at("ray").at("origin"), (nlohmann::json{-0.25, 0.125, 4.0}));
  EXPECT_EQ(report.at("ray").at("direction"), (nlohmann::json{0.0, 0.0, -2.0}));
  EXPECT_EQ(report.at("hit"), true);
  EXPECT_EQ(report.at("object"), "ball, \"big\"");
  EXPECT_EQ(report.at("object_id"), 0);
  EXPECT_TRUE(report.at("instance").is_null());
  EXPECT_EQ(report.at("primitive"), 0);
  EXPECT_EQ(report.at("surface"), 0);
  EXPECT_EQ(report.at("material"), "mat, \xc3\xa9");
  EXPECT_EQ(report.at("entering"), true);
  const double z = std::sqrt(1 - 0.0625 - 0.015625);
  const double bound = 32 * 0x1p-24 * 4;  // as above
  EXPECT_NEAR(report.at("t").get<double>(), (4 - z) / 2, bound);
  EXPECT_NEAR(report.at("point").at(2).get<double>(), z, bound);
  EXPECT_NEAR(report.at("normal").at(0).get<double>(), -0.25, bound);
  EXPECT_EQ(report.at("uv").size(), 2u);
  EXPECT_GT(report.at("error").get<double>(), 0);
  const auto& reference = report.at("reference");
  EXPECT_NEAR(reference.at("t").get<double>(), (4 - z) / 2, 1e-12);  // bisected in double
  EXPECT_EQ(reference.at("object"), report.at("object"));
  EXPECT_EQ(reference.at("entering"), true);

  const Result all = test::run_program(
      {"pick", "scene.pbrt", "--ray", "5,0,4,0,0,-1", "--json", "--all", "--reference"}, folder);
  ASSERT_EQ(all.code, 0) << all.err;
  const auto list = nlohmann::json::parse(all.out);
  ASSERT_EQ(list.at("crossings").size(), 2u);
  ASSERT_EQ(list.at("reference").size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(list["crossings"][i].at("object"), "left");
    EXPECT_EQ(list["crossings"][i].at("object_id"), 3);
    EXPECT_EQ(list["crossings"][i].at("instance"), 0);
    EXPECT_EQ(list["crossings"][i].at("entering"), i == 0);
    EXPECT_EQ(list["reference"][i].at("entering"), i == 0);
    EXPECT_NEAR(list["crossings"][i].at("t").get<double>(),
                list["reference"][i].at("t").get<double>(), bound);
  }

  const Result miss = test::run_program(
      {"pick", "scene.pbrt", "--ray", "0,0,50,0,0,1", "--json", "--reference"}, folder);
  ASSERT_EQ(miss.code, 0) << miss.err;
  EXPECT_EQ(nlohmann::json::parse(miss.out).at("hit"), false);
  EXPECT_TRUE(nlohmann::json::parse(miss.out).at("reference").is_null());
}

// A ball of radius 1 goes from x = 0 to 4 in two seconds; the camera goes with it, to half as far.
TEST(Pick, ScenesThatMoveAtATime) {
  const auto folder = test::temporary_folder();
  std::ofstream(folder / "moving.pbrt")
      << "TransformTimes 0 2\nActiveTransform EndTime\nTranslate -2 0 0\nActiveTransform All\n"
         "Translate 0 0 10\nCamera \"perspective\" \"float shutteropen\" 0.5 \"float "
         "shutterclose\" 1\nFilm \"rgb\" \"integer xresolution\" 3 \"integer yresolution\" 3\n"
         "WorldBegin\nLightSource \"point\"\nActiveTransform EndTime\nTranslate 4 0 0\n"
         "Shape \"sphere\"\n";
  const auto picked = [&](std::vector<std::string> more) {
    std::vector<std::string> all{"pick", "moving.pbrt", "--json", "--reference"};
    all.insert(all.end(), more.begin(), more.end());
    const Result result = test::run_program(all, folder);
    EXPECT_EQ(result.code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  };
  EXPECT_EQ(nlohmann::json::parse(test::run_program({"info", "moving.pbrt", "--json"}, folder).out)
                .at("moving"),
            1);
  const std::string down = "1,0,5,0,0,-1";
  // When the shutter opens the ball is at x = 1.
  for (const auto& report : {picked({"--ray", down}), picked({"--ray", down, "--time", "0.5"})}) {
    EXPECT_NEAR(report.at("t").get<double>(), 4, 1e-5);
    EXPECT_NEAR(report.at("reference").at("t").get<double>(), 4, 1e-9);
  }
  const auto later = picked({"--ray", down, "--time", "0.75"});
  EXPECT_NEAR(later.at("t").get<double>(), 5 - std::sqrt(0.75), 1e-5);
  EXPECT_NEAR(later.at("reference").at("t").get<double>(), 5 - std::sqrt(0.75), 1e-9);
  EXPECT_EQ(picked({"--ray", down, "--time", "2"}).at("hit"), false);
  // The pixel in the middle sees what is before the camera: at 1.2 s it is at x = 1.2, the ball
  // at 2.4.
  EXPECT_EQ(picked({"--pixel", "1,1", "--time", "1.2"}).at("hit"), false);
  EXPECT_NEAR(picked({"--pixel", "1,1", "--time", "0"}).at("point").at(2).get<double>(), -1, 1e-5);
}

// Residues of a cartoon are 3.8 apart, and each reaches halfway to the next.
TEST(Pick, TellsTheResidueOfACartoon) {
  std::string text;
  for (const char* atom : {"    1  CA  GLY A   1       0.000", "    2  CA  LYS A   2       3.800",
                           "    3  CA  ALA A  33A      7.600"})
    text += std::string("ATOM  ") + atom + "   0.000   0.000  1.00  1.00           C\n";
  const std::filesystem::path folder = test::temporary_folder();
  std::ofstream(folder / "c.pdb") << text;
  const auto at = [&](const std::string& x) {
    const Result result = test::run_program(
        {"pick", "c.pdb", "--style", "cartoon", "--json", "--ray", x + ",0,5,0,0,-1"}, folder);
    EXPECT_EQ(result.code, 0) << result.err;
    const auto report = nlohmann::json::parse(result.out);
    EXPECT_NEAR(report.at("t").get<double>(), 5 - 0.28, 0.004);  // of a 20-gon: 0.28 cos(pi / 20)
    return report.at("object").get<std::string>();
  };
  EXPECT_EQ(at("1.8"), "chain A GLY 1");
  EXPECT_EQ(at("2"), "chain A LYS 2");
  EXPECT_EQ(at("5.6"), "chain A LYS 2");
  EXPECT_EQ(at("5.8"), "chain A ALA 33A");
}

// Two of three atoms in line are drawn, each by a --show of its own.
TEST(Pick, SeesWhatEachShowDraws) {
  const std::filesystem::path folder = test::temporary_folder();
  std::ofstream(folder / "m.xyz") << "3\n\nO 0 0 0\nC 9 0 0\nN 18 0 0\n";
  for (const std::vector<std::string>& show :
       {std::vector<std::string>{"--show", "element O: spheres", "--show", "element N: sticks"},
        std::vector<std::string>{"--show=element O: spheres; element N: sticks"}}) {
    const auto at = [&](const std::string& x) {
      std::vector<std::string> words = {"pick", "m.xyz", "--json", "--ray", x + ",0,5,0,0,-1"};
      words.insert(words.end(), show.begin(), show.end());
      const Result result = test::run_program(words, folder);
      EXPECT_EQ(result.code, 0) << result.err;
      return nlohmann::json::parse(result.out);
    };
    EXPECT_NEAR(at("0").at("t").get<double>(), 5 - 1.52, 1e-5);  // Bondi's radius of oxygen
    EXPECT_EQ(at("9").at("hit"), false);
    EXPECT_NEAR(at("18").at("t").get<double>(), 5 - 0.2, 1e-5);
  }
}

TEST(Pick, PixelsOfTheImage) {
  const auto folder = folder_with_scene();
  const auto pick = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"pick", "scene.pbrt", "--json"});
    const Result result = test::run_program(more, folder);
    EXPECT_EQ(result.code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  };
  // The shorter side spans 90 degrees, and pbrt's cameras are left-handed: pixel (x, y) looks along
  // ((20 - x - 0.5) / 10, (10 - y - 0.5) / 10, -1).
  const auto middle = pick({"--pixel", "20,9"});
  EXPECT_EQ(middle.at("object"), "ball, \"big\"");
  EXPECT_EQ(middle.at("pixel"), (nlohmann::json{20, 9}));
  const auto capsule = pick({"--pixel", "13,9"});
  EXPECT_EQ(capsule.at("object"), 1);
  const double depth = 5 - capsule.at("point").at(2).get<double>();
  EXPECT_NEAR(capsule.at("point").at(0).get<double>(), 0.65 * depth, 32 * 0x1p-24 * 5);  // as above
  EXPECT_NEAR(capsule.at("point").at(1).get<double>(), 0.05 * depth, 32 * 0x1p-24 * 5);
  EXPECT_EQ(pick({"--pixel", "0,0"}).at("hit"), false);
  // Another size, and a crop that does not move the pixels.
  EXPECT_EQ(pick({"--pixel", "134,95", "--size", "400x200"}).at("object"), 1);
  EXPECT_EQ(pick({"--pixel", "13,9", "--crop", "13,9,14,10"}).at("point"), capsule.at("point"));
}

TEST(Pick, WordsForPeople) {
  const auto folder = folder_with_scene();
  const Result result =
      test::run_program({"pick", "scene.pbrt", "--pixel", "20,9", "--reference"}, folder);
  ASSERT_EQ(result.code, 0) << result.err;
  for (const char* word :
       {"pixel ", "ray ", "object ", "primitive ", "surface ", "material ", "t ", "entering",
        "point ", "normal ", "uv ", "reference ", "ball, \"big\"", "mat, \xc3\xa9"})
    EXPECT_THAT(result.out, HasSubstr(word));
  EXPECT_THAT(test::run_program({"pick", "scene.pbrt", "--pixel", "0,0"}, folder).out,
              HasSubstr("nothing"));
}

TEST(Pick, MillionsOfRaysDoNotFillMemory) {
  const auto folder = folder_with_scene();
  std::mt19937 random(1);
  const auto write = [&](const char* name, std::size_t count) {
    write_rays(folder / name, count, [&](std::size_t, float* ray) {
      std::uniform_real_distribution<float> unit(-1, 1);
      const float numbers[] = {unit(random), unit(random), 4, 0, 0, -1};
      std::copy_n(numbers, 6, ray);
    });
  };
  // The peak of all programs that were run so far, in KiB.
  const auto peak = [] {
    rusage usage{};
    ::getrusage(RUSAGE_CHILDREN, &usage);
    return usage.ru_maxrss;
  };
  constexpr std::size_t few = 500'000, many = 2'000'000;
  write("few.npy", few);
  write("many.npy", many);
  long peaks[2] = {};
  std::size_t i = 0;
  for (const char* name : {"few.npy", "many.npy"}) {
    ASSERT_EQ(
        test::run_program({"pick", "scene.pbrt", "--rays", name, "--out", "out.npy", "-q"}, folder)
            .code,
        0);
    peaks[i++] = peak();
  }
  const Table table = read_table(folder / "out.npy");
  EXPECT_GT(table.rows, many / 2);
  // 1.5 million more rays are 36 MB of input and more of output; what is held at a time is a
  // quarter of a million.
  EXPECT_LT(peaks[1] - peaks[0], 24 * 1024);
}

}  // namespace
}  // namespace caplet::pick_test
