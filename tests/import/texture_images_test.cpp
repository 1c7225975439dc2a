// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Images of textures, their parameters, normal maps, displacement and alpha, as the importer of
// pbrt's text reads them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "import_text.h"

namespace caplet::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class TextureImages : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"a.png", "b.png", "grey.png", "broken.png"})
      write_file(folder_ / name, "an image");
  }
  Scene read(const std::string& world) {
    return pbrt::import_text((folder_ / "scene.pbrt").string(),
                             "Camera \"perspective\"\nWorldBegin\n" + world, images_);
  }
  std::vector<std::string> complaints_about(const std::string& world) {
    return complaints_when([&] { return read(world); });
  }
  std::filesystem::path folder_ = temporary_folder();
  StubImages images_;
};

const ImagemapTexture& imagemap(const Scene& scene, std::size_t i) {
  return std::get<ImagemapTexture>(scene.textures.at(i).model);
}

TEST_F(TextureImages, AreReadOnceForEachEncoding) {
  std::string text;
  for (int i = 0; i < 20; ++i)
    text += "Texture \"t" + std::to_string(i) +
            "\" \"spectrum\" \"imagemap\" \"string filename\" \"" + (i % 2 ? "./" : "") +
            "a.png\"\n";
  text +=
      "Texture \"l\" \"float\" \"imagemap\" \"string filename\" \"a.png\" \"string encoding\" "
      "\"linear\"\n"
      "Texture \"b\" \"float\" \"imagemap\" \"string filename\" \"b.png\"\n"
      "Material \"diffuse\" \"texture reflectance\" \"t3\"\nShape \"sphere\"";
  const Scene scene = read(text);
  EXPECT_EQ(images_.textures_read, 3);
  EXPECT_EQ(imagemap(scene, 0).image, imagemap(scene, 19).image);
  EXPECT_NE(imagemap(scene, 0).image, imagemap(scene, 20).image);
  EXPECT_EQ(images_of(scene.textures).size(), 3u);
}

TEST_F(TextureImages, HaveTheirParameters) {
  const Scene scene = read(
      "Translate 1 2 3\nTexture \"a\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\" "
      "\"string wrap\" "
      "\"octahedralsphere\"\n"
      "\"string filter\" \"EWA\" \"float maxanisotropy\" 4 \"float scale\" .5 \"bool invert\" true "
      "\"string encoding\" \"gamma "
      "2.5\"\n"
      "\"string mapping\" \"planar\" \"vector3 v1\" [0 1 2] \"vector3 v2\" [3 4 5] \"float "
      "udelta\" .25 \"float vdelta\" .75\n"
      "Texture \"b\" \"float\" \"imagemap\" \"string filename\" \"a.png\"\nShape \"sphere\"");
  const ImagemapTexture& a = imagemap(scene, 0);
  EXPECT_STREQ(texture_wrap_names[static_cast<std::size_t>(a.wrap)], "octahedralsphere");
  EXPECT_STREQ(texture_filter_names[static_cast<std::size_t>(a.filter)], "EWA");
  EXPECT_EQ(a.maxanisotropy, 4);
  EXPECT_EQ(a.scale, 0.5);
  EXPECT_EQ(a.invert, 1);
  EXPECT_FLOAT_EQ(a.image->floats[32], static_cast<float>(std::pow(0.5, 2.5)));
  EXPECT_EQ(a.mapping.kind, TextureMapping::Kind::planar);
  EXPECT_EQ(a.mapping.v1, glm::dvec3(0, 1, 2));
  EXPECT_EQ(a.mapping.v2, glm::dvec3(3, 4, 5));
  EXPECT_EQ(a.mapping.udelta, 0.25);
  EXPECT_EQ(a.mapping.vdelta, 0.75);
  EXPECT_EQ(a.mapping.texture_from_world, glm::translate(glm::dmat4(1), glm::dvec3(-1, -2, -3)));
  const ImagemapTexture& b = imagemap(scene, 1);
  EXPECT_EQ(b.wrap, 0);
  EXPECT_EQ(b.filter, 1);
  EXPECT_EQ(b.maxanisotropy, 8);
  EXPECT_EQ(b.mapping.kind, TextureMapping::Kind::uv);
  // IEC 61966-2-1 at 1/2.
  EXPECT_NEAR(b.image->floats[32], 0.2140411, 1e-6);
  EXPECT_TRUE(scene.textures[1].is_float);
}

TEST_F(TextureImages, ThatAreWrongHaveTheirPlace) {
  const std::string use = "\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"";
  const auto of = [&](const std::string& parameters) {
    return complaints_about("Texture \"t\" \"spectrum\" \"imagemap\" " + parameters + use).front();
  };
  EXPECT_THAT(of(""), HasSubstr("scene.pbrt:3:1: Texture \"t\": \"string filename\" is missing"));
  EXPECT_THAT(
      of("\"string filename\" \"none.png\""),
      AllOf(
          HasSubstr(
              "scene.pbrt:4:20: Material \"diffuse\": \"reflectance\" uses Texture \"imagemap\" ("),
          HasSubstr("scene.pbrt:3:1), whose image cannot be had: no such file"),
          HasSubstr("none.png\"")));
  EXPECT_THAT(of("\"string filename\" \"broken.png\""), HasSubstr("whose image cannot be had: "));
  EXPECT_THAT(of("\"string filename\" \"a.png\" \"string encoding\" \"gamma 0\""),
              HasSubstr("scene.pbrt:3:61: Texture \"t\": \"encoding\" is \"gamma 0\", not"));
  EXPECT_THAT(of("\"string filename\" \"a.png\" \"string wrap\" \"clam\""),
              HasSubstr("scene.pbrt:3:61: Texture \"t\": \"wrap\" is \"clam\"; the nearest known "
                        "name is \"clamp\""));
  EXPECT_THAT(of("\"string filename\" \"a.png\" \"float uscael\" 1"),
              HasSubstr("unknown parameter \"uscael\""));
  // Where nothing uses it, it does not block a scene.
  EXPECT_THAT(complaints_about("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" "
                               "\"none.png\"\nShape \"sphere\""),
              ElementsAre());
}

TEST_F(TextureImages, OfNormalsAreLinearAndInColor) {
  const Scene scene =
      read("Material \"conductor\" \"string normalmap\" \"a.png\"\nShape \"sphere\"");
  ASSERT_TRUE(scene.materials[0].normalmap);
  EXPECT_EQ(std::get<NormalmapTexture>(scene.textures[*scene.materials[0].normalmap].model)
                .image->floats[32],
            0.5f);
  EXPECT_THAT(
      complaints_about("Material \"diffuse\" \"string normalmap\" \"grey.png\"\nShape \"sphere\"")
          .front(),
      HasSubstr("scene.pbrt:3:20: Material \"diffuse\": \"normalmap\" is an image in grey, which "
                "has no normals"));
  EXPECT_THAT(complaints_about("Material \"diffuse\" \"string normalmap\" \"a.png\" \"float "
                               "displacement\" 1\nShape \"sphere\"")
                  .front(),
              HasSubstr("\"normalmap\" cannot be combined with \"displacement\""));
}

TEST(Displacement, IsATextureOrBendsNothing) {
  const Scene scene = world_of(
      "Texture \"f\" \"float\" \"fbm\"\nTexture \"c\" \"spectrum\" \"checkerboard\"\n"
      "Material \"diffuse\" \"texture displacement\" \"f\"\nShape \"sphere\"\nMaterial \"diffuse\" "
      "\"float displacement\" "
      "3\nShape \"sphere\"");
  EXPECT_EQ(scene.materials[0].displacement, 0u);
  EXPECT_FALSE(scene.materials[1].displacement);
  EXPECT_THAT(complaints("WorldBegin\nTexture \"c\" \"spectrum\" \"checkerboard\"\nMaterial "
                         "\"diffuse\" \"texture displacement\" \"c\"\n"
                         "Shape \"sphere\"")
                  .front(),
              HasSubstr("\"displacement\" needs a float texture"));
}

TEST(Alpha, IsANumberOrATexture) {
  const Scene scene = world_of(
      "Texture \"f\" \"float\" \"checkerboard\"\nShape \"sphere\" \"float alpha\" .5\nShape "
      "\"sphere\" \"texture alpha\" \"f\"\n"
      "Shape \"sphere\" \"float alpha\" 1\nShape \"sphere\" \"float alpha\" 0");
  EXPECT_EQ(std::get<ConstantSpectrum>(scene.shapes[0].alpha->value).value, 0.5);
  EXPECT_EQ(scene.shapes[1].alpha->texture, 0u);
  EXPECT_FALSE(scene.shapes[2].alpha);
  EXPECT_TRUE(scene.shapes[3].alpha);
  EXPECT_THAT(
      complaints("WorldBegin\nAreaLightSource \"diffuse\"\nShape \"sphere\" \"float alpha\" .5"),
      ElementsAre());
  EXPECT_THAT(
      complaints("WorldBegin\nObjectBegin \"o\" Shape \"sphere\" \"float alpha\" .5 "
                 "ObjectEnd\nObjectBegin \"p\" Shape "
                 "\"sphere\" ObjectEnd\n"
                 "Shape \"csg\" \"string operation\" \"union\" \"string operands\" [\"o\" \"p\"]"),
      ElementsAre(
          "scene.pbrt:2:17: an operand of a csg has no \"alpha\" of its own: give it to the csg"));
}

}  // namespace
}  // namespace caplet::test
