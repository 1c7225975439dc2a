// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// MJCF: height fields and textures that are images, and what lights are meant for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "import/import.h"
#include "support/data.h"
#include "support/import_files.h"

namespace caplet::mjcf_images_test {
namespace {

using test::complaint;
using testing::HasSubstr;

/// Images by their names, rows from the top.
class Images : public test::NoImages {
 public:
  TextureImage read_texture(const std::filesystem::path& path,
                            const ImageEncoding&) const override {
    return images.at(path.stem().string());
  }
  std::map<std::string, TextureImage> images;
};

TextureImage image(int width, int height, int channels, std::vector<std::uint8_t> bytes) {
  TextureImage out;
  out.width = width;
  out.height = height;
  out.channels = channels;
  out.bytes = std::move(bytes);
  return out;
}

Scene scene_of(const std::string& text, const Images& images) {
  for (const auto& [name, unused] : images.images) test::write_file(name + ".png", "");
  const std::filesystem::path path = test::temporary_folder() / "images.xml";
  for (const auto& [name, unused] : images.images)
    std::ofstream(path.parent_path() / (name + ".png")) << "";
  std::ofstream(path) << "<mujoco>" << text << "</mujoco>";
  return import_scene(path, images, {{{"up", "y"}}});
}

// The image's last row is the least y, and heights go from 0 to 1 of the size (mjCHField::LoadPNG
// turns rows around, then stretches): the numbers of Mjcf.HeightFieldsAreSolid, given as grey, as
// three channels of that mean, and with an alpha.
TEST(MjcfImages, HeightsAreMeansOfTheColours) {
  Images images;
  std::vector<std::uint8_t> rgb, rgba;
  for (const int grey : {0, 50, 100, 150, 200, 250}) {
    for (const int other : {grey, grey + 5, grey - 5}) {
      rgb.push_back(static_cast<std::uint8_t>(std::clamp(other, 0, 255)));
      rgba.push_back(rgb.back());
    }
    rgba.push_back(static_cast<std::uint8_t>(255 - grey));
  }
  rgb[1] = rgba[1] = 0;  // below 0 there is nothing: the first stays black
  images.images["grey"] = image(3, 2, 1, {0, 50, 100, 150, 200, 250});
  images.images["rgb"] = image(3, 2, 3, rgb);
  images.images["rgba"] = image(3, 2, 4, rgba);
  images.images["floats"] = image(3, 2, 1, {});
  images.images["floats"].floats = {0, 0.2F, 0.4F, 0.6F, 0.8F, 1};
  for (const char* name : {"grey", "rgb", "rgba", "floats"}) {
    const Scene scene = scene_of("<asset><hfield name='h' file='" + std::string(name) +
                                     ".png' size='1 2 3 .1'/></asset>" +
                                     "<worldbody><geom type='hfield' hfield='h'/></worldbody>",
                                 images);
    const auto& mesh = std::get<TriangleMeshShape>(scene.shapes[0].geometry);
    ASSERT_EQ(mesh.positions.size(), 12U) << name;
    const double heights[] = {0.6, 0.8, 1, 0, 0.2, 0.4};
    for (std::size_t i = 0; i < 6; ++i) {
      const glm::dvec3 expected(static_cast<double>(i % 3) - 1, i < 3 ? -2 : 2, 3 * heights[i]);
      EXPECT_LT(glm::length(glm::dvec3(mesh.positions[i]) - expected), 1e-6) << name << i;
    }
  }
}

TEST(MjcfImages, HeightFieldsHaveTwoToManyRows) {
  const auto said = [](const std::string& rows, const std::string& columns) {
    return complaint([&] {
      scene_of("<asset><hfield name='h' nrow='" + rows + "' ncol='" + columns +
                   "' size='1 1 1 1'/></asset><worldbody>" +
                   "<geom type='hfield' hfield='h'/></worldbody>",
               {});
    });
  };
  EXPECT_EQ(said("2", "2"), "");
  EXPECT_EQ(said("8192", "2"), "");
  EXPECT_EQ(said("2", "8192"), "");
  // A field of 8192 x 513 has more than 2^22 values.
  for (const auto& [rows, columns] :
       {std::pair("1", "2"), std::pair("2", "1"), std::pair("8193", "2"), std::pair("2", "8193"),
        std::pair("8192", "513"), std::pair("2.5", "2"), std::pair("2", "2.5")})
    EXPECT_THAT(said(rows, columns), HasSubstr("2 to 8192 rows and columns"))
        << rows << ' ' << columns;
}

// Bytes as they are, of grey all three alike; floats, which are linear, by sRGB's curve: 0.5 is
// 188, 0.002 is 12.92 times that.
TEST(MjcfImages, TexturesOfAnyChannels) {
  Images images;
  images.images["rgb"] = image(2, 2, 3, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
  images.images["rgba"] = image(2, 2, 4, {1, 2, 3, 99, 4, 5, 6, 99, 7, 8, 9, 99, 10, 11, 12, 99});
  images.images["grey"] = image(2, 2, 1, {1, 2, 3, 4});
  images.images["floats"] = image(2, 2, 1, {});
  images.images["floats"].floats = {0.5F, 0.002F, -1, 2};
  const auto bytes_of = [&](const std::string& name, const std::string& more) {
    const Scene scene = scene_of(
        "<asset><texture name='t' type='2d' file='" + name + ".png' " + more +
            "/><material name='m' texture='t' rgba='1 1 1 1'/></asset><worldbody><geom size='1' " +
            "material='m'/></worldbody>",
        images);
    return std::get<ImagemapTexture>(scene.textures.at(0).model).image->bytes;
  };
  using Bytes = std::vector<std::uint8_t>;
  // Turned around, so that each is read by what is tried here.
  EXPECT_EQ(bytes_of("rgb", "hflip='true'"), (Bytes{4, 5, 6, 1, 2, 3, 10, 11, 12, 7, 8, 9}));
  EXPECT_EQ(bytes_of("rgba", "hflip='true'"), (Bytes{4, 5, 6, 1, 2, 3, 10, 11, 12, 7, 8, 9}));
  EXPECT_EQ(bytes_of("rgb", "vflip='true'"), (Bytes{7, 8, 9, 10, 11, 12, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(bytes_of("grey", "hflip='true' vflip='true'"),
            (Bytes{4, 4, 4, 3, 3, 3, 2, 2, 2, 1, 1, 1}));
  EXPECT_EQ(bytes_of("floats", "hflip='true'"),
            (Bytes{7, 7, 7, 188, 188, 188, 255, 255, 255, 0, 0, 0}));
}

// MuJoCo's reference: fileright and its like are OpenGL's faces +x -x +y -y +z -z; and the letters
// of a grid, row by row.
TEST(MjcfImages, CubesOfSixFiles) {
  Images images;
  const char* names[] = {"right", "left", "up", "down", "front", "back"};
  std::string files;
  for (std::size_t i = 0; i < 6; ++i) {
    std::vector<std::uint8_t> bytes(std::size_t{3} * 16);
    for (std::size_t k = 0; k < bytes.size(); k += 3) {
      bytes[k] = static_cast<std::uint8_t>(10 * (i + 1));
      bytes[k + 1] = static_cast<std::uint8_t>(k / 3);
    }
    images.images[names[i]] = image(4, 4, 3, bytes);
    files += " file" + std::string(names[i]) + "='" + names[i] + ".png'";
  }
  // Two rows of four parts of 4 x 4: back, down, front and nothing above right, left, up and
  // nothing.
  constexpr std::array<std::uint8_t, 8> parts{60, 40, 50, 99, 10, 20, 30, 99};
  std::vector<std::uint8_t> grid;
  for (std::size_t row = 0; row < 8; ++row)
    for (std::size_t column = 0; column < 16; ++column)
      for (const std::uint8_t value :
           {parts.at(row / 4 * 4 + column / 4), std::uint8_t{0}, std::uint8_t{0}})
        grid.push_back(value);
  images.images["grid"] = image(16, 8, 3, grid);
  for (const std::string& what :
       {files, std::string(" file='grid.png' gridsize='2 4' gridlayout='BDF.RLU.'")}) {
    const Scene scene = scene_of("<asset><texture name='c' type='cube'" + what +
                                     "/><material name='c' texture='c'/></asset>" +
                                     "<worldbody><geom size='1' material='c'/></worldbody>",
                                 images);
    const auto image = std::get<ImagemapTexture>(scene.textures.at(0).model).image;
    ASSERT_EQ(image->width, 8);
    ASSERT_EQ(image->height, 16);
    // Columns by the angle from z, rows from above by turns from x, backwards
    // (MjcfLooks.FacesOfCubesAreMujocos).
    const auto red = [&](int row, int column) {
      return image->bytes[static_cast<std::size_t>(3 * (8 * row + column))];
    };
    EXPECT_EQ(red(15, 4), 10) << what;  // x
    EXPECT_EQ(red(7, 4), 20) << what;   // -x
    EXPECT_EQ(red(11, 4), 30) << what;  // y
    EXPECT_EQ(red(3, 4), 40) << what;   // -y
    EXPECT_EQ(red(5, 0), 50) << what;   // z
    EXPECT_EQ(red(5, 7), 60) << what;   // -z
    if (what != files) continue;
    // Within the face of x, columns by -z / x and rows by -y / x in quarters of -1 to 1 (OpenGL's
    // table of cube maps): at angles of 11.25 degrees from x the tangent is 0.2, and at 33.75
    // degrees 0.67.
    const auto green = [&](int row, int column) {
      return image->bytes[static_cast<std::size_t>(3 * (8 * row + column) + 1)];
    };
    EXPECT_EQ(green(15, 3), 4 * 1 + 1);
    EXPECT_EQ(green(14, 3), 4 * 0 + 1);
    EXPECT_EQ(green(0, 2), 4 * 2 + 0);
    EXPECT_EQ(green(1, 5), 4 * 3 + 3);
  }
}

// A floor is no part of what is seen: a light of diffuse 1 that is 3 from the middle of the ball
// has pi times 9.
TEST(MjcfImages, LightsAreAsStrongAsMeantWithoutTheFloor) {
  const Scene scene = scene_of(
      "<worldbody><geom type='plane' size='9 9 1' pos='0 0 -7'/><geom size='1' pos='1 0 0'/>"
      "<light pos='1 0 3' cutoff='180' diffuse='1 1 1'/></worldbody>",
      {});
  const auto& light = std::get<PointLight>(scene.lights.at(0).model);
  EXPECT_NEAR(std::get<RgbSpectrum>(light.intensity).rgb.r, 9 * std::acos(-1.0), 1e-9);
}

}  // namespace
}  // namespace caplet::mjcf_images_test
