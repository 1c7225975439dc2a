// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Images that a program made are written beside the scene, and read again as the same values.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <set>

#include "export/export.h"
#include "film/image.h"
#include "flat_equal.h"
#include "import/import.h"
#include "scene/image_reader.h"
#include "support/data.h"
#include "support/import_files.h"

namespace caplet::test {
namespace {

namespace fs = std::filesystem;

/// Images of noise without a file, by their names: "grey", "rgb" and "rgba", as floats where
/// "float" is in it, in the wide colour space where "wide" is, with a table of their own where
/// "table" is. Lights' images are square where the name has "square".
class MadeImages : public ImageReader {
 public:
  EnvironmentImage read_rgb(const fs::path& path) const override {
    const bool square = has(path, "square");
    EnvironmentImage out;
    out.width = square ? 12 : 20;
    out.height = square ? 12 : 10;
    out.equal_area = square;
    out.rgb = numbers(3 * static_cast<std::size_t>(out.width * out.height), 7);
    if (has(path, "wide")) out.space = ColorSpace::rec2020;
    return out;
  }
  TextureImage read_texture(const fs::path& path, const ImageEncoding& encoding) const override {
    TextureImage out;
    out.width = 9;
    out.height = 6;
    out.channels = has(path, "rgba") ? 4 : has(path, "rgb") ? 3 : 1;
    out.encoding = encoding;
    if (has(path, "wide")) out.space = ColorSpace::rec2020;
    const std::vector<float> values = numbers(out.values(), has(path, "float") ? 1 : 2);
    for (std::size_t i = 0; i < 256; ++i)
      out.decoded.at(i) =
          has(path, "table")
              ? static_cast<float>(i) / 512.0f
              : static_cast<float>(decoded_value(encoding, static_cast<double>(i) / 255));
    if (has(path, "float"))
      out.floats = values;
    else
      for (const float one : values) out.bytes.push_back(static_cast<std::uint8_t>(255 * one));
    return out;
  }

 private:
  static bool has(const fs::path& path, const std::string& word) {
    return path.stem().string().find(word) != std::string::npos;
  }
  static std::vector<float> numbers(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<float> out(count);
    for (float& one : out) one = static_cast<float>(random() >> 8) * 0x1p-24f;
    return out;
  }
};

/// A scene of this text, for whose images there are files (which are not read).
Scene made(const std::string& text) {
  const fs::path folder = temporary_folder();
  for (const char* const name :
       {"grey.png", "rgb.png", "rgba.png", "float-grey.png", "float-rgb.png", "float-rgba.png",
        "wide-rgb.png", "wide-float-rgb.exr", "table-rgb.png", "table-rgba.png", "sky.exr",
        "square.exr", "wide-square.exr"})
    std::ofstream(folder / name) << "no image";
  return read_pbrt_text(folder / "made.pbrt", text, MadeImages());
}

std::set<std::string> files_of(const fs::path& folder) {
  std::set<std::string> out;
  for (const auto& one : fs::directory_iterator(folder)) out.insert(one.path().filename().string());
  return out;
}

/// A scene of textures of one, three and four channels, whose names begin so.
std::string of_channels(const std::string& prefix) {
  const auto texture = [&](const char* name, const char* type, const std::string& image) {
    return std::string("Texture \"") + name + "\" \"" + type +
           "\" \"imagemap\" \"string filename\" \"" + prefix + image;
  };
  return "WorldBegin\n" + texture("a", "float", "grey.png\" \"string encoding\" \"linear\"\n") +
         texture("b", "spectrum", "rgb.png\"\n") +
         texture("c", "spectrum", "rgba.png\" \"string encoding\" \"gamma 1.8\"\n") +
         R"(Material "coateddiffuse" "texture roughness" "a" "texture reflectance" "b"
Shape "sphere" "float radius" 1
Material "diffuse" "texture reflectance" "c"
Shape "sphere" "float radius" 2
)";
}

class WrittenImages : public testing::TestWithParam<std::string> {};

TEST_P(WrittenImages, AreReadAsTheSameValues) {
  const Scene scene = made(GetParam());
  const fs::path folder = temporary_folder(), file = folder / "a scene.pbrt";
  const FileImageWriter images;
  write_scene(scene, file, {}, &images);
  const Scene again = import_scene(file, FileImageReader());
  EXPECT_EQ(different_buffers(scene, again), "");
  if (const auto& backdrop = scene.view.film.backdrop) {
    EXPECT_EQ(again.view.film.backdrop->image->rgb, backdrop->image->rgb);
  }
  EXPECT_GT(files_of(folder).size(), 1U);
  // Written again there are the same files, and those that there are stay.
  const std::set<std::string> before = files_of(folder);
  fs::path image;
  for (const std::string& name : before)
    if (name != "a scene.pbrt") image = folder / name;
  const auto time = fs::last_write_time(image) - std::chrono::hours(1);
  fs::last_write_time(image, time);
  write_scene(scene, file, {}, &images);
  EXPECT_EQ(files_of(folder), before);
  EXPECT_EQ(fs::last_write_time(image), time);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, WrittenImages,
    testing::Values(of_channels(""), of_channels("float-"), R"(WorldBegin
Texture "a" "spectrum" "imagemap" "string filename" "wide-float-rgb.exr"
Material "diffuse" "texture reflectance" "a" "string normalmap" "rgb.png"
Shape "sphere" "float radius" 1
)",
                    R"(WorldBegin
LightSource "infinite" "string filename" "square.exr"
LightSource "infinite" "string filename" "sky.exr"
LightSource "goniometric" "string filename" "wide-square.exr"
AreaLightSource "diffuse" "string filename" "square.exr"
Shape "bilinearmesh" "point3 P" [-1 -1 0 1 -1 0 -1 1 0 1 1 0]
)",
                    R"(Film "rgb" "string background" "image" "string backgroundfile" "sky.exr"
WorldBegin
Shape "sphere" "float radius" 1
)"));

// Bytes that no PNG means are written as the values that they stand for.
TEST(WrittenImages, OfOtherTablesAndSpacesAreFloats) {
  for (const std::string name : {"table-rgb.png", "wide-rgb.png", "table-rgba.png"}) {
    const Scene scene = made(
        "WorldBegin\nTexture \"a\" \"spectrum\" \"imagemap\" \"string filename\" \"" + name + R"("
Material "diffuse" "texture reflectance" "a"
Shape "sphere" "float radius" 1
)");
    const fs::path file = temporary_folder() / "b.pbrt";
    const FileImageWriter images;
    write_scene(scene, file, {}, &images);
    const Scene again = import_scene(file, FileImageReader());
    const auto image_of = [](const Scene& of) {
      return std::get<ImagemapTexture>(of.textures.at(0).model).image;
    };
    const TextureImage &was = *image_of(scene), &is = *image_of(again);
    EXPECT_EQ(fs::path(is.file).extension(), ".exr") << name;
    EXPECT_EQ(is.space, was.space) << name;
    ASSERT_EQ(is.floats.size(), was.bytes.size()) << name;
    for (std::size_t i = 0; i < is.floats.size(); ++i)
      EXPECT_EQ(is.floats[i], was.channels == 4 && i % 4 == 3
                                  ? static_cast<float>(was.bytes[i]) / 255.0f
                                  : was.decoded.at(was.bytes[i]))
          << name << " " << i;
  }
}

TEST(WrittenImages, TakeThePlaceOfFilesThatAreGone) {
  const fs::path from = temporary_folder(), to = temporary_folder();
  const FileImageWriter images;
  write_scene(made("WorldBegin\nLightSource \"infinite\" \"string filename\" \"square.exr\"\n"),
              from / "d.pbrt", {}, &images);
  const Scene scene = import_scene(from / "d.pbrt", FileImageReader());
  write_scene(scene, to / "near.pbrt", {}, &images);
  EXPECT_EQ(files_of(to), std::set<std::string>{"near.pbrt"}) << "the file is named";
  for (const auto& one : fs::directory_iterator(from))
    if (one.path().extension() == ".exr") fs::remove(one.path());
  write_scene(scene, to / "far.pbrt", {}, &images);
  EXPECT_EQ(files_of(to).size(), 3U);
  EXPECT_EQ(different_buffers(scene, import_scene(to / "far.pbrt", FileImageReader())), "");
}

TEST(WrittenImages, AreRemovedWhereTheSceneFails) {
  Scene scene = made(R"(WorldBegin
Texture "a" "spectrum" "imagemap" "string filename" "rgb.png"
Material "diffuse" "texture reflectance" "a"
Shape "sphere" "float radius" 1
)");
  scene.materials.at(0).name = "two\x01lines";
  const fs::path folder = temporary_folder();
  const FileImageWriter images;
  EXPECT_THROW(write_scene(scene, folder / "c.pbrt", {}, &images), InputError);
  EXPECT_EQ(files_of(folder), std::set<std::string>{});
  scene.materials.at(0).name = "fine";
  EXPECT_THAT(complaint([&] { write_scene(scene, folder / "c.pbrt"); }),
              testing::HasSubstr("the texture's image was read from no file"));
  write_scene(scene, folder / "c.pbrt", {}, &images);
  const std::set<std::string> before = files_of(folder);
  EXPECT_EQ(before.size(), 2U);
  scene.materials.at(0).name = "two\x01lines";
  EXPECT_THROW(write_scene(scene, folder / "c.pbrt", {}, &images), InputError);
  EXPECT_EQ(files_of(folder), before) << "those of an older scene stay";
}

}  // namespace
}  // namespace caplet::test
