// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// PLY in all its encodings, and broken.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <sstream>

#include "import/detail/ply.h"
#include "import_text.h"

namespace caplet::test {
namespace {

namespace fs = std::filesystem;

/// Appends values to a PLY body in one of the three encodings.
class Writer {
 public:
  explicit Writer(std::string encoding) : encoding_(std::move(encoding)) {
    head_ = "ply\nformat " + encoding_ + " 1.0\n";
  }
  Writer& header(const std::string& lines) {
    head_ += lines;
    return *this;
  }
  template <class T>
  Writer& value(T value) {
    if (encoding_ == "ascii") {
      std::ostringstream text;
      text.precision(17);
      text << +value << ' ';
      body_ += text.str();
      return *this;
    }
    std::string raw(reinterpret_cast<const char*>(&value), sizeof(value));
    if (encoding_ == "binary_big_endian") std::reverse(raw.begin(), raw.end());
    body_ += raw;
    return *this;
  }
  Writer& line() {
    if (encoding_ == "ascii") body_ += "\n";
    return *this;
  }
  std::string bytes() const { return head_ + "end_header\n" + body_; }

 private:
  std::string encoding_, head_, body_;
};

constexpr const char* xyz = "property float x\nproperty float y\nproperty float z\n";

class PlyEncodings : public testing::TestWithParam<const char*> {};

TEST_P(PlyEncodings, PolygonsExtrasNormalsAndUvs) {
  Writer ply(GetParam());
  ply.header("comment a square and a triangle\nelement vertex 5\n")
      .header("property double x\nproperty double y\nproperty double z\nproperty uchar red\n")
      .header(
          "property float nx\nproperty float ny\nproperty float nz\nproperty float confidence\n")
      .header(
          "property float s\nproperty float t\nelement face 2\nproperty list uint ushort "
          "vertex_index\n");
  for (int i = 0; i < 5; ++i) {
    ply.value(0.1 * i).value(1.0 + i).value(-0.5 * i).value(static_cast<std::uint8_t>(200));
    ply.value(0.f)
        .value(0.f)
        .value(1.f)
        .value(0.25f)
        .value(static_cast<float>(i) / 8)
        .value(0.5f)
        .line();
  }
  ply.value(std::uint32_t{4});
  for (int k : {0, 1, 2, 3}) ply.value(static_cast<std::uint16_t>(k));
  ply.line().value(std::uint32_t{3});
  for (int k : {4, 2, 0}) ply.value(static_cast<std::uint16_t>(k));
  const TriangleMeshShape mesh = parse_ply("test.ply", ply.line().bytes());
  ASSERT_EQ(mesh.positions.size(), 5u);
  for (int i = 0; i < 5; ++i) {
    const auto at = static_cast<std::size_t>(i);
    EXPECT_EQ(mesh.positions[at],
              glm::vec3(static_cast<float>(0.1 * i), static_cast<float>(1.0 + i),
                        static_cast<float>(-0.5 * i)));
    EXPECT_EQ(mesh.normals[at], glm::vec3(0, 0, 1));
    EXPECT_EQ(mesh.uvs[at], glm::vec2(static_cast<float>(i) / 8, 0.5f));
  }
  using T = std::array<std::uint32_t, 3>;
  EXPECT_THAT(mesh.triangles, testing::ElementsAre(T{0, 1, 2}, T{0, 2, 3}, T{4, 2, 0}));
}

TEST_P(PlyEncodings, OtherElementsAndFacesFirst) {
  Writer ply(GetParam());
  ply.header("element edge 2\nproperty int a\nproperty list uchar float b\nelement face 1\n")
      .header(
          "property uchar flags\nproperty list uchar int vertex_indices\nproperty list uchar float "
          "texcoord\n")
      .header(std::string("element vertex 3\n") + xyz);
  ply.value(7)
      .value(std::uint8_t{0})
      .line()
      .value(8)
      .value(std::uint8_t{2})
      .value(1.f)
      .value(2.f)
      .line();
  ply.value(std::uint8_t{1}).value(std::uint8_t{3}).value(2).value(1).value(0);
  ply.value(std::uint8_t{2}).value(0.f).value(0.f).line();
  for (float v : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 9.876543e-5f}) ply.value(v);
  const TriangleMeshShape mesh = parse_ply("test.ply", ply.line().bytes());
  using T = std::array<std::uint32_t, 3>;
  EXPECT_THAT(mesh.triangles, testing::ElementsAre(T{2, 1, 0}));
  EXPECT_THAT(mesh.positions, testing::ElementsAre(glm::vec3(0, 0, 0), glm::vec3(1, 0, 0),
                                                   glm::vec3(0, 1, 9.876543e-5f)));
}

TEST_P(PlyEncodings, BodyStartsWithTheByteOfANewline) {
  const float x = std::bit_cast<float>(0x0a00000a);  // in either byte order
  Writer ply(GetParam());
  ply.header(std::string("element vertex 3\n") + xyz +
             "element face 1\nproperty list uchar int vertex_indices\n");
  for (float v : {x, 1.f, 2.f, 3.f, 4.f, 5.f, 6.f, 7.f, 9.f}) ply.value(v);
  ply.line().value(std::uint8_t{3}).value(0).value(1).value(2);
  const TriangleMeshShape mesh = parse_ply("test.ply", ply.bytes());
  EXPECT_THAT(mesh.positions,
              testing::ElementsAre(glm::vec3(x, 1, 2), glm::vec3(3, 4, 5), glm::vec3(6, 7, 9)));
  EXPECT_EQ(mesh.triangles.size(), 1u);
}

TEST_P(PlyEncodings, TruncationAtEveryByte) {
  Writer ply(GetParam());
  ply.header(std::string("element vertex 3\n") + xyz +
             "element face 2\nproperty list uchar int vertex_indices\n");
  for (float v : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) ply.value(v);
  for (int face = 0; face < 2; ++face) ply.line().value(std::uint8_t{3}).value(0).value(1).value(2);
  const std::string whole = ply.bytes();
  EXPECT_EQ(parse_ply("test.ply", whole).triangles.size(), 2u);
  // The last byte of the ascii form is a blank, and the one before it a whole digit.
  const std::size_t last = whole.size() - (std::string(GetParam()) == "ascii" ? 2 : 1);
  for (std::size_t size = 0; size <= last; ++size)
    EXPECT_THROW(parse_ply("test.ply", whole.substr(0, size)), InputError)
        << size << " bytes of " << whole.size();
}

TEST_P(PlyEncodings, NumbersOfEachType) {
  Writer ply(GetParam());
  ply.header("element vertex 3\nproperty char x\nproperty short y\nproperty ushort z\n")
      .header("property uint nx\nproperty int ny\nproperty uchar nz\n")
      .header("element face 1\nproperty list char short vertex_indices\n");
  for (int i = 0; i < 3; ++i)
    ply.value(static_cast<std::int8_t>(-128 + i))
        .value(static_cast<std::int16_t>(-32768 + i))
        .value(static_cast<std::uint16_t>(65535 - i))
        .value(std::uint32_t{4'000'000'000})
        .value(std::int32_t{-2'000'000'000})
        .value(std::uint8_t{255})
        .line();
  ply.value(std::int8_t{3});
  for (int k : {2, 1, 0}) ply.value(static_cast<std::int16_t>(k));
  const TriangleMeshShape mesh = parse_ply("test.ply", ply.line().bytes());
  EXPECT_THAT(mesh.positions,
              testing::ElementsAre(glm::vec3(-128, -32768, 65535), glm::vec3(-127, -32767, 65534),
                                   glm::vec3(-126, -32766, 65533)));
  EXPECT_EQ(mesh.normals.at(0), glm::vec3(4e9F, -2e9F, 255));
  using T = std::array<std::uint32_t, 3>;
  EXPECT_THAT(mesh.triangles, testing::ElementsAre(T{2, 1, 0}));
}

INSTANTIATE_TEST_SUITE_P(Import, PlyEncodings,
                         testing::Values("ascii", "binary_little_endian", "binary_big_endian"));

TEST(Ply, CarriageReturnsAndGzip) {
  const std::string text =
      "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty float x\r\nproperty float "
      "y\r\nproperty float z\r\n"
      "element face 1\r\nproperty list uchar int vertex_indices\r\nend_header\r\n0 0 0\r\n1 0 "
      "0\r\n0 1 0\r\n3 0 1 2\r\n";
  const fs::path path = temporary_folder() / "mesh.ply.gz";
  const gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  gzclose(file);
  EXPECT_EQ(read_ply(path, {}).triangles.size(), 1u);
}

TEST(Ply, BrokenFiles) {
  const std::string vertex = std::string("element vertex 3\n") + xyz;
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  const std::string ascii = "ply\nformat ascii 1.0\n", points = "0 0 0\n1 0 0\n0 1 0\n";
  const auto complaint = [](const std::string& bytes) {
    return complaint_of([&] { parse_ply("m.ply", bytes); });
  };
  EXPECT_EQ(complaint("solid"), "m.ply:1: this is no PLY file (it does not start with \"ply\")");
  std::string many = ascii;
  for (int i = 0; i < 2000; ++i) many += "element e" + std::to_string(i) + " 0\n";
  EXPECT_EQ(complaint(many), "m.ply:1027: more than 1024 elements");
  EXPECT_EQ(complaint(ascii + "element vertex 3\n"),
            "m.ply:4: the PLY header does not end (no end_header)");
  EXPECT_EQ(complaint(ascii + vertex + face + "end_header\n" + points + "3 0 1 3\n"),
            "m.ply:13: a PLY face has the vertex index 3, but there are 3 vertices");
  EXPECT_EQ(complaint(ascii + vertex + face + "end_header\n" + points + "3 0 1 -1\n"),
            "m.ply:13: a PLY face has the vertex index -1, but there are 3 vertices");
  EXPECT_EQ(complaint(ascii + vertex + face + "end_header\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"),
            "m.ply:11: a vertex position is not finite (\"y\")");
  EXPECT_EQ(complaint(ascii + vertex + face + "end_header\n0 0 0\n1 0 zero\n0 1 0\n3 0 1 2\n"),
            "m.ply:11: \"zero\" is no number");
  EXPECT_EQ(complaint(ascii + "element vertex 4000000000\n" + xyz + face + "end_header\n" + points),
            "m.ply: the PLY file is truncated: its header promises 4000000000 of \"vertex\", more "
            "than fit into its 181 bytes");
  // 12 bytes each.
  const auto binary = [&](int count) {
    return complaint("ply\nformat binary_little_endian 1.0\nelement vertex " +
                     std::to_string(count) + "\n" + xyz + face + "end_header\n" +
                     std::string(24, '\0'));
  };
  EXPECT_THAT(binary(2), testing::Not(testing::HasSubstr("of \"vertex\"")));
  EXPECT_THAT(binary(3), testing::HasSubstr("its header promises 3 of \"vertex\""));
  EXPECT_EQ(complaint(ascii + vertex + "end_header\n" + points), "m.ply: the PLY file has no face");
  EXPECT_EQ(complaint("ply\nformat ascii 2.0\n"),
            "m.ply:2: the PLY format line must be \"format\", an encoding and \"1.0\"");
}

TEST(Ply, BrokenHeaders) {
  const std::string vertex = std::string("element vertex 3\n") + xyz;
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  const std::string ascii = "ply\nformat ascii 1.0\n", points = "0 0 0\n1 0 0\n0 1 0\n";
  std::string many = ascii + "element vertex 3\n";
  for (int i = 0; i < 1025; ++i) many += "property float p" + std::to_string(i) + "\n";
  const std::pair<std::string, std::string> cases[] = {
      {"plie\nformat ascii 1.0\n", "m.ply:1: this is no PLY file (it does not start with \"ply\")"},
      {"ply\nmaterial red\n", "m.ply:2: unknown PLY header line"},
      {"ply\nformat binary_middle_endian 1.0\n",
       "m.ply:2: unknown PLY encoding \"binary_middle_endian\""},
      {"ply\nelement vertex 3\nend_header\n", "m.ply:3: the PLY header has no format line"},
      {ascii + "element vertex\n",
       "m.ply:3: a PLY element line must be \"element\", a name and a count"},
      {ascii + "element vertex 3x\n", "m.ply:3: \"3x\" is no element count"},
      {ascii + "element vertex -3\n", "m.ply:3: \"-3\" is no element count"},
      {ascii + vertex + "element vertex 3\n", "m.ply:7: the element \"vertex\" is declared twice"},
      {ascii + "property float x\n", "m.ply:3: a PLY property before any element"},
      {ascii + "element face 1\nproperty list uchar vertex_indices\n",
       "m.ply:4: a PLY property line must be \"property\" [list type] type name"},
      {ascii + "element face 1\nproperty int\n",
       "m.ply:4: a PLY property line must be \"property\" [list type] type name"},
      {ascii + "element face 1\nproperty half x\n", "m.ply:4: unknown PLY type \"half\""},
      {ascii + "element face 1\nproperty list float int vertex_indices\n",
       "m.ply:4: the length of a PLY list must be an integer"},
      {ascii + vertex + "property float y\n", "m.ply:7: the property \"y\" is declared twice"},
      {many, "m.ply:1028: more than 1024 properties"},
      {ascii + "element vertex 3\n" + face + "end_header\n" + points,
       "m.ply: the PLY element \"vertex\" has no properties"},
      {ascii + "element vertex 1\nproperty float x\nproperty float z\n" + face +
           "end_header\n0 0\n3 0 0 0\n",
       "m.ply: the PLY file's vertices have no \"y\""},
      {ascii + vertex + "element face 1\nproperty list uchar float vertex_indices\nend_header\n" +
           points + "3 0 1 2\n",
       "m.ply: the PLY file's faces have no list \"vertex_indices\""},
      {ascii + vertex + face + "end_header\n" + points + "2 0 1\n",
       "m.ply: the PLY file has no face with three corners"},
      {ascii + vertex + face + "end_header\n" + points + "256 0 1 2\n",
       "m.ply:13: \"256\" is no integer of the declared type"},
      {ascii + vertex + face + "end_header\n" + points + "-1 0 1 2\n",
       "m.ply:13: \"-1\" is no integer of the declared type"},
      {ascii + vertex + face + "end_header\n" + points + "3 0 1.5 2\n",
       "m.ply:13: \"1.5\" is no integer of the declared type"}};
  for (const auto& [bytes, said] : cases)
    EXPECT_EQ(complaint_of([&, &bytes = bytes] { parse_ply("m.ply", bytes); }), said);
  // What no double has is 0, or as large as nothing.
  EXPECT_EQ(parse_ply("m.ply", ascii + vertex + face +
                                   "end_header\n1e-400 -1e-400 7\n1 0 0\n0 1 0\n3 0 1 2\n")
                .positions.at(0),
            glm::vec3(0, 0, 7));
  EXPECT_EQ(complaint_of([&] {
              parse_ply("m.ply",
                        ascii + vertex + face + "end_header\n1e400 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
            }),
            "m.ply:10: a vertex position is not finite (\"x\")");
}

TEST(Ply, FilesOfSeveralTimesAreAMeshThatMoves) {
  const std::filesystem::path folder = temporary_folder();
  const auto write = [&](const std::string& name, const std::string& vertices,
                         const std::string& face = "3 0 1 2\n", bool has_normals = true) {
    write_file(
        folder / name,
        "ply\nformat ascii 1.0\nelement vertex 3\n" + std::string(xyz) +
            (has_normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "") +
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n" + vertices +
            face);
    return "\"" + (folder / name).string() + "\"";
  };
  const std::string first = write("1.ply", "0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n"),
                    second = write("2.ply", "0 0 2 0 1 0\n1 0 2 0 0 1\n0 1 2 0 0 1\n");
  const auto shape = [](const std::string& files) {
    return "Shape \"plymesh\" \"string filename\" [" + files + "] \"float times\" [1 1.5]";
  };
  const Scene scene = world_of(shape(first + " " + second));
  const auto& mesh = std::get<TriangleMeshShape>(scene.shapes.at(0).geometry);
  EXPECT_EQ(mesh.times, (std::vector<double>{1, 1.5}));
  EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{
                                {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2}, {1, 0, 2}, {0, 1, 2}}));
  EXPECT_EQ(mesh.normals.size(), 6u);
  EXPECT_EQ(mesh.normals[3], glm::vec3(0, 1, 0));
  const std::string turned = write("3.ply", "0 0 2 0 1 0\n1 0 2 0 0 1\n0 1 2 0 0 1\n", "3 0 2 1\n"),
                    flat = write("4.ply", "0 0 2\n1 0 2\n0 1 2\n", "3 0 1 2\n", false);
  for (const std::string& other : {turned, flat})
    EXPECT_THAT(complaint_of([&] { world_of(shape(first + " " + other)); }),
                testing::HasSubstr("has other vertices, faces or normals than"));
  EXPECT_THAT(complaint_of([&] { world_of(shape(first + " \"none.ply\"")); }),
              testing::HasSubstr("none.ply"));
}

TEST(Ply, NormalsThatAreNoneAreLeftOut) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 3\n" + std::string(xyz) +
                           "property float nx\nproperty float ny\nproperty float nz\nproperty "
                           "float u\nproperty float v\n"
                           "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string rest = " .5 .5\n1 0 0 0 0 1 1 0\n0 1 0 0 0 1 0 1\n3 0 1 2\n";
  for (const char* bad : {"nan nan nan", "0 -nan 1", "inf 0 0", "1e300 0 0"}) {
    const std::filesystem::path path = temporary_folder() / "normals.ply";
    write_file(path, head + "0 0 0 " + bad + rest);
    const Scene scene = world_of("Shape \"plymesh\" \"string filename\" \"" + path.string() + "\"");
    Diagnostics diagnostics;
    validate(scene, diagnostics);
    EXPECT_FALSE(diagnostics.has_errors()) << bad;
    const auto& mesh = std::get<TriangleMeshShape>(scene.shapes.at(0).geometry);
    EXPECT_EQ(mesh.positions.size(), 3u) << bad;
    EXPECT_TRUE(mesh.normals.empty()) << bad;
    EXPECT_EQ(mesh.uvs.size(), 3u) << bad;
  }
  EXPECT_EQ(parse_ply("m.ply", head + "0 0 0 0 0 1" + rest).normals.size(), 3u);
  // Positions are another matter.
  EXPECT_EQ(complaint_of([&] { parse_ply("m.ply", head + "0 0 nan 0 0 1" + rest); }),
            "m.ply:15: a vertex position is not finite (\"z\")");
}

TEST(Ply, WarningOfNormalsNamesTheFile) {
  testing::internal::CaptureStderr();
  parse_ply("m.ply", "ply\nformat ascii 1.0\nelement vertex 3\n" + std::string(xyz) +
                         "property float nx\nproperty float ny\nproperty float nz\nelement face "
                         "1\nproperty list uchar int vertex_indices\n"
                         "end_header\n0 0 0 nan nan nan\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n");
  EXPECT_THAT(
      testing::internal::GetCapturedStderr(),
      testing::HasSubstr("m.ply: 1 of 3 normals are not finite: geometric normals are used"));
}

TEST(Ply, SharedMeshesLoad) {
  CAPLET_NEEDS_DATA();
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(data_folder()))
    if (entry.path().extension() == ".ply") {
      ++files;
      EXPECT_GT(read_ply(entry.path(), {}).triangles.size(), 0u) << entry.path();
    }
  EXPECT_GT(files, 0u);
}

TEST(Ply, IgnisMeshesHaveTheirCounts) {
  CAPLET_NEEDS_DATA();
  struct Row {
    const char* name;
    std::size_t vertices, polygons;
  };
  const fs::path folder = data_folder() / "reference" / "ignis" / "evaluation" / "meshes";
  for (const Row& row : {Row{"Back", 4, 2},
                         {"Bottom", 4, 2},
                         {"Cone", 65, 33},
                         {"Cube", 24, 6},
                         {"Cylinder", 130, 124},
                         {"GroundPlane", 4, 1},
                         {"IcosphereHQ", 1859, 960},
                         {"Plane.001", 4, 2},
                         {"Plane", 4, 1},
                         {"Suzanne", 3043, 1968}}) {
    const fs::path path = folder / (std::string(row.name) + ".ply");
    const TriangleMeshShape mesh = read_ply(path, {});
    EXPECT_EQ(mesh.positions.size(), row.vertices) << row.name;
    EXPECT_GE(mesh.triangles.size(), row.polygons) << row.name;
  }
  EXPECT_EQ(read_ply(folder / "Cube.ply", {}).triangles.size(), 12u);
  EXPECT_EQ(read_ply(folder / "Back.ply", {}).triangles.size(), 2u);
}

}  // namespace
}  // namespace caplet::test
