// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Names in any bytes: what scenes know of them, and what is written again.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "base/utf8.h"
#include "export/export.h"
#include "film/image.h"
#include "import/import.h"
#include "support/broken_utf8.h"
#include "support/data.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;

void put(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Names, OfAnyBytesBecomeUtf8) {
  const fs::path folder = test::temporary_folder(), file = folder / "a.pbrt",
                 obj = folder / "a.obj";
  for (const test::Broken& broken : test::broken_utf8) {
    put(file, fmt::format(R"(MakeNamedMedium "{0}" "string type" "homogeneous"
WorldBegin
Texture "{0}" "float" "fbm"
MakeNamedMaterial "{0}" "string type" "diffuse" "texture displacement" "{0}"
NamedMaterial "{0}"
MediumInterface "{0}" ""
Shape "sphere" "string name" "{0}"
ObjectBegin "{0}"
Shape "sphere" "string name" "{0}"
ObjectEnd
ObjectBegin "part"
Shape "box" "point3 p0" [ 0 0 0 ] "point3 p1" [ 1 1 1 ] "string name" "{0}"
ObjectEnd
Shape "csg" "string operation" "difference" "string operands" [ "part" "{0}" ]
ObjectInstance "{0}"
)",
                          broken.bytes));
    const Scene scene = import_scene(file, FileImageReader());
    EXPECT_EQ(scene.media.at(0).name, broken.valid) << broken.what;
    EXPECT_EQ(scene.textures.at(0).name, broken.valid) << broken.what;
    EXPECT_EQ(scene.materials.at(0).name, broken.valid) << broken.what;
    EXPECT_EQ(scene.shapes.at(0).name, broken.valid) << broken.what;
    EXPECT_EQ(scene.objects.at(0).name, broken.valid) << broken.what;
    EXPECT_EQ(scene.objects.at(0).shapes.at(0).name, broken.valid) << broken.what;
    for (const auto& operand : std::get<CsgShape>(scene.shapes.at(1).geometry).operands)
      EXPECT_EQ(operand->name, broken.valid) << broken.what;
    put(obj, fmt::format("o {0}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", broken.bytes));
    EXPECT_EQ(import_scene(obj, FileImageReader()).shapes.at(0).name, broken.valid) << broken.what;
    // With several files, the names of files come before.
    const fs::path other = folder / (std::string(broken.bytes) + ".obj");
    put(other, text_of(obj));
    const std::vector<fs::path> both{file, other};
    EXPECT_EQ(import_scenes(both, FileImageReader()).shapes.back().name, std::string(broken.valid))
        << broken.what;
    fs::remove(other);
  }
}

TEST(Names, AreWrittenAsUtf8AndToldApart) {
  const fs::path folder = test::temporary_folder(), file = folder / "a.pbrt",
                 written = folder / "b.pbrt";
  // One character of both names stays, and it is the same.
  put(file, R"(WorldBegin
MakeNamedMaterial "K)"
            "\xfc"
            R"(" "string type" "diffuse" "rgb reflectance" [ 1 0 0 ]
MakeNamedMaterial "K)"
            "\xf6"
            R"(" "string type" "diffuse" "rgb reflectance" [ 0 1 0 ]
NamedMaterial "K)"
            "\xfc"
            R"("
Shape "sphere" "string name" ")"
            "\xed\xa0\x80"
            R"("
NamedMaterial "K)"
            "\xf6"
            R"("
Shape "sphere"
)");
  write_scene(import_scene(file, FileImageReader()), written);
  const std::string text = text_of(written);
  EXPECT_EQ(valid_utf8(text), text);
  const Scene again = import_scene(written, FileImageReader());
  ASSERT_EQ(again.shapes.size(), 2u);
  const auto red = [&](std::size_t i) {
    return std::get<RgbSpectrum>(
               std::get<DiffuseMaterial>(again.materials.at(again.shapes[i].material).model)
                   .reflectance)
        .rgb.x;
  };
  EXPECT_EQ(red(0), 1);
  EXPECT_EQ(red(1), 0);
  EXPECT_EQ(again.shapes[0].name, "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");
}

/// Files are found by their bytes.
TEST(Names, OfFilesStayAsTheyAre) {
  const fs::path folder = test::temporary_folder(), file = folder / "a.pbrt",
                 image = folder / "K\xfcgel.exr";
  LayeredImage picture;
  picture.width = picture.height = picture.data_width = picture.data_height = 1;
  for (const char* name : {"B", "G", "R"}) picture.channels.push_back({name, {0.5f}, {}});
  write_exr(image, picture);
  put(file,
      "WorldBegin\nTexture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"K\xfcgel.exr\"\n"
      "Material \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"\n");
  const Scene scene = import_scene(file, FileImageReader());
  EXPECT_EQ(std::get<ImagemapTexture>(scene.textures.at(0).model).image->file, image.string());
  write_scene(scene, folder / "b.pbrt");
  EXPECT_EQ(import_scene(folder / "b.pbrt", FileImageReader()).textures.size(), 1u);
}

}  // namespace
}  // namespace caplet
