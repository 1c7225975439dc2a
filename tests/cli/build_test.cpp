// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet build`, and tree files in place of scenes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "film/image.h"
#include "pictures.h"
#include "program.h"
#include "small_disk.h"
#include "support/data.h"

namespace caplet {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Named and nameless shapes and materials, an object placed twice, a medium, a lamp, and words of
/// the view: a medium of the camera's, a cut, a crop, a backdrop.
constexpr const char* rich_scene = R"(
Film "rgb" "integer xresolution" 40 "integer yresolution" 30 "integer pixelbounds" [2 38 1 29]
     "string background" "color" "float backgroundcolor" [.1 .2 .3] "string filename" "rich.exr"
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [.02 .02 .02] "rgb sigma_s" [.05 .05 .05]
MediumInterface "" "fog"
LookAt 0 1 6  0 0 0  0 1 0
Camera "perspective" "float fov" 45 "float clipplane" [0 0 1 .9] "string unit" "mm"
  "float fileaxes" [0 1 0 0 0 1 1 0 0]
Sampler "zsobol" "integer pixelsamples" 4 "integer seed" 7
PixelFilter "gaussian" "float xradius" 1.25
Integrator "volpath" "integer maxdepth" 7
WorldBegin
LightSource "infinite" "rgb L" [.5 .6 .7]
MakeNamedMaterial "brass" "string type" "conductor" "float roughness" .2
Texture "checks" "spectrum" "checkerboard"
Material "diffuse" "texture reflectance" "checks"
Shape "capsule" "point3 p0" [-1 0 0] "point3 p1" [1 0 0] "float radius" .4 "string name" "rod"
Shape "capsule" "point3 p0" [-1.4 -.9 0] "point3 p1" [0 -.9 0] "float radius" .3
Shape "capsule" "point3 p0" [0 -.9 0] "point3 p1" [1.4 -.9 0] "float radius" .3
NamedMaterial "brass"
Shape "sphere" "float radius" .5
ObjectBegin "pair"
  Shape "cylinder" "float radius" .2 "string name" "pin"
  Shape "sphere" "float radius" .3
ObjectEnd
AttributeBegin
  Translate -1.5 .8 0
  ObjectInstance "pair"
AttributeEnd
AttributeBegin
  Translate 1.5 .8 0
  ObjectInstance "pair"
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [4 3 2]
  Translate 0 2 0
  Shape "sphere" "float radius" .3
AttributeEnd
)";

std::filesystem::path folder_with_tree(const std::string& text) {
  const std::filesystem::path folder = test::folder_with_scene(text);
  const test::Result built = test::run_program({"build", "-q", "scene.pbrt", "a.tree"}, folder);
  EXPECT_EQ(built.code, 0) << built.err;
  EXPECT_EQ(built.err, "");
  return folder;
}

/// Expects the same pictures, and attributes but those of the run itself.
void expect_same_files(const std::filesystem::path& a, const std::filesystem::path& b) {
  test::expect_equal_pictures(a, b);
  const LayeredImage one = read_exr(a), other = read_exr(b);
  EXPECT_EQ(one.x, other.x);
  EXPECT_EQ(one.y, other.y);
  EXPECT_EQ(one.width, other.width);
  EXPECT_EQ(one.height, other.height);
  for (const auto& [key, value] : one.metadata) {
    if (key == "caplet.command" || key == "caplet.scene" || key == "caplet.render_seconds")
      continue;
    EXPECT_EQ(other.metadata.at(key), value) << key;
  }
}

TEST(Build, PicturesAreThoseOfTheScene) {
  const auto folder = folder_with_tree(rich_scene);
  std::vector<std::string> told;
  const std::string layers = "all,crypto_object,crypto_material,crypto_asset";
  for (const auto& [scene, picture] : {std::pair("scene.pbrt", "a"), std::pair("a.tree", "b")}) {
    const test::Result done = test::run_program(
        {"render", scene, "--layers", layers, "-o", std::string(picture) + ".exr", "--preview",
         std::string(picture) + ".png", "--scale-bar", "--axes", "--outline", "2"},
        folder);
    EXPECT_EQ(done.code, 0) << done.err;
    const std::string bar = done.err.substr(done.err.find("scale bar:"));
    told.push_back(bar.substr(0, bar.find('\n')));
    EXPECT_THAT(done.err, Not(HasSubstr("warning")));
  }
  EXPECT_THAT(told.at(0), HasSubstr("pixels"));
  EXPECT_EQ(told.at(1), told.at(0));
  const LayeredImage picture = read_exr(folder / "a.exr");
  EXPECT_EQ(picture.data_width, 36);
  EXPECT_THAT(picture.metadata, testing::Contains(testing::Pair(testing::EndsWith("manifest"),
                                                                HasSubstr("\"sphere 3\""))));
  expect_same_files(folder / "a.exr", folder / "b.exr");
  EXPECT_EQ(test::read_file(folder / "a.png"), test::read_file(folder / "b.png"));
}

TEST(Build, OneTreeHasManyPictures) {
  const auto folder = folder_with_tree(rich_scene);
  for (const auto& [scene, picture] :
       {std::pair("scene.pbrt", "a.exr"), std::pair("a.tree", "b.exr")})
    EXPECT_EQ(test::run_program(
                  {"render", scene, "-q", "--size", "20x20", "--spp", "3", "--seed", "9",
                   "--max-depth", "2", "--encoding", "single", "--stereo", "0.3", "-o", picture},
                  folder)
                  .code,
              0);
  expect_same_files(folder / "a.exr", folder / "b.exr");
  for (const auto& [scene, picture] :
       {std::pair("scene.pbrt", "a.png"), std::pair("a.tree", "b.png")})
    EXPECT_EQ(test::run_program({"render", scene, "-q", "--size", "400x300", "--crop",
                                 "0,0,400,300", "--spp", "1", "--axes", "-o", picture},
                                folder)
                  .code,
              0);
  EXPECT_EQ(test::read_file(folder / "a.png"), test::read_file(folder / "b.png"));
  // Without a name it is that of the scene's film.
  EXPECT_EQ(test::run_program({"render", "a.tree", "-q", "--spp", "1"}, folder).code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "rich.exr"));
}

TEST(Build, FilmsGoOnInTheTree) {
  const auto folder = folder_with_tree(rich_scene);
  EXPECT_EQ(test::run_program({"render", "scene.pbrt", "-q", "--samples", "0:2", "--film",
                               "f.caplet", "-o", "none"},
                              folder)
                .code,
            0);
  const test::Result done = test::run_program(
      {"render", "a.tree", "-q", "--film", "f.caplet", "--resume", "-o", "b.exr"}, folder);
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(test::run_program({"render", "scene.pbrt", "-q", "-o", "a.exr"}, folder).code, 0);
  const LayeredImage a = read_exr(folder / "a.exr"), b = read_exr(folder / "b.exr");
  for (const char* name : {"R", "G", "B"}) EXPECT_EQ(a.find(name)->floats, b.find(name)->floats);
}

TEST(Build, CrossingsAndInfoAreThoseOfTheScene) {
  const auto folder = folder_with_tree(rich_scene);
  const auto out_of = [&](std::vector<std::string> arguments) {
    const test::Result done = test::run_program(arguments, folder);
    EXPECT_EQ(done.code, 0) << done.err;
    return done.out;
  };
  for (const char* ray : {"0,0,5,0,0,-1", "-1.5,.8,5,0,0,-1", "1.5,.8,5,0,0,-1", "0,2,5,0,0,-1"}) {
    const std::string told = out_of({"pick", "scene.pbrt", "-q", "--ray", ray, "--all"});
    EXPECT_THAT(told, HasSubstr("crossing"));
    EXPECT_EQ(out_of({"pick", "a.tree", "-q", "--ray", ray, "--all"}), told);
  }
  const std::string pixel = out_of({"pick", "scene.pbrt", "-q", "--pixel", "20,15", "--json"});
  EXPECT_THAT(pixel, HasSubstr("\"brass\""));
  EXPECT_EQ(out_of({"pick", "a.tree", "-q", "--pixel", "20,15", "--json"}), pixel);
  EXPECT_EQ(out_of({"info", "a.tree", "--json"}), out_of({"info", "scene.pbrt", "--json"}));
  EXPECT_EQ(out_of({"info", "a.tree"}), out_of({"info", "scene.pbrt"}));
}

TEST(Build, NeuronsAreFramedWhenTheyAreBuilt) {
  const auto folder = test::folder_with_scene();
  const std::string neuron = (test::source_folder() / "scenes/neuron.swc").string();
  const test::Result built =
      test::run_program({"build", neuron, "n.tree", "--size", "40x60", "--color", "type"}, folder);
  EXPECT_EQ(built.code, 0) << built.err;
  EXPECT_THAT(built.err, HasSubstr("wrote n.tree"));
  EXPECT_EQ(test::run_program({"render", neuron, "-q", "--size", "40x60", "--color", "type",
                               "--spp", "2", "--preview", "a.png", "--color-bar", "-o", "a.exr"},
                              folder)
                .code,
            0);
  EXPECT_EQ(test::run_program({"render", "n.tree", "-q", "--spp", "2", "--preview", "b.png",
                               "--color-bar", "-o", "b.exr"},
                              folder)
                .code,
            0);
  expect_same_files(folder / "a.exr", folder / "b.exr");
  EXPECT_EQ(test::read_file(folder / "a.png"), test::read_file(folder / "b.png"));
}

// Files that the view names are found from the tree's folder.
TEST(Build, TreesMayLieElsewhere) {
  const auto folder = test::folder_with_scene();
  std::ofstream(folder / "lens.dat") << "35 .7 1.6 20\n0 .1 0 20\n-35 20 1 20\n";
  std::ofstream(folder / "scene.pbrt")
      << "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"realistic\" \"string lensfile\" \"lens.dat\" "
         "\"float aperturediameter\" 10\n"
         "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 8\nWorldBegin\n"
         "LightSource \"infinite\"\nShape \"sphere\"\n";
  std::filesystem::create_directory(folder / "trees");
  const test::Result built =
      test::run_program({"build", "-q", "scene.pbrt", "trees/a.tree"}, folder);
  ASSERT_EQ(built.code, 0) << built.err;
  for (const auto& [scene, picture] :
       {std::pair("scene.pbrt", "a.exr"), std::pair("trees/a.tree", "b.exr")}) {
    const test::Result done =
        test::run_program({"render", scene, "-q", "--spp", "2", "-o", picture}, folder);
    EXPECT_EQ(done.code, 0) << done.err;
  }
  expect_same_files(folder / "a.exr", folder / "b.exr");
}

TEST(Build, WhatIsWrongIsSaidAndNothingIsWritten) {
  const auto folder = folder_with_tree(
      "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\"\nWorldBegin\nLightSource "
      "\"infinite\"\nActiveTransform EndTime\n"
      "Translate 0 .1 0\nActiveTransform All\nShape \"sphere\" \"float radius\" .5\n");
  const auto before = test::names_in(folder);
  const auto error_of = [&](const std::vector<std::string>& arguments) {
    const test::Result result = test::run_program(arguments, folder);
    EXPECT_EQ(result.code, 2) << result.err;
    return result.err;
  };
  EXPECT_THAT(error_of({"build", "scene.pbrt"}), HasSubstr("OUT.tree"));
  EXPECT_THAT(error_of({"build", "scene.pbrt", "a.exr"}), HasSubstr("a file .tree"));
  EXPECT_THAT(error_of({"build", "scene.pbrt", "no/b.tree"}), HasSubstr("OUT.tree: "));
  EXPECT_THAT(error_of({"build", "none.pbrt", "b.tree"}), HasSubstr("no such file"));
  EXPECT_THAT(error_of({"build", "a.tree", "b.tree"}), HasSubstr("the scene that it was built of"));
  for (const char* command : {"verify", "view"})
    EXPECT_THAT(error_of({command, "a.tree"}), HasSubstr("the scene that it was built of"));
  EXPECT_THAT(error_of({"convert", "a.tree", "b.pbrt"}), HasSubstr("has no shapes"));
  EXPECT_THAT(error_of({"render", "a.tree", "scene.pbrt"}), HasSubstr("no other joins it"));
  EXPECT_THAT(error_of({"render", "a.tree", "--turntable", "3", "-o", "b.##.png"}),
              HasSubstr("which frames need"));
  EXPECT_THAT(error_of({"render", "a.tree", "--background", "white"}),
              StartsWith("caplet: error: --background: is for `caplet build`"));
  EXPECT_THAT(error_of({"pick", "a.tree", "--pixel", "1,1"}), HasSubstr("moves"));
  EXPECT_THAT(error_of({"pick", "a.tree", "--pixel", "1,1", "--reference"}),
              StartsWith("caplet: error: --reference"));
  EXPECT_EQ(test::names_in(folder), before);
}

TEST(Build, DamagedTreesAreRefused) {
  const auto folder = folder_with_tree(rich_scene);
  std::string content = test::read_file(folder / "a.tree");
  content[content.find("\"pin\"") + 1] = 'q';
  std::ofstream(folder / "b.tree", std::ios::binary) << content;
  for (const char* command : {"render", "info"}) {
    const test::Result done = test::run_program({command, "b.tree"}, folder);
    EXPECT_EQ(done.code, 2);
    EXPECT_THAT(done.err, HasSubstr("b.tree: the tree file is damaged: its checksum is wrong"));
  }
}

TEST(Build, FullDisksLeaveNothing) {
  const auto folder = test::folder_with_scene();
  std::filesystem::create_directory(folder / "disk");
  const test::SmallDisk disk(folder / "disk");
  if (!disk.mounted()) GTEST_SKIP() << "no file system can be mounted here";
  disk.leave(8);
  const test::Result done = test::run_program({"build", "scene.pbrt", "disk/a.tree"}, folder);
  EXPECT_EQ(done.code, 1) << done.err;
  EXPECT_THAT(done.err, HasSubstr("disk/a.tree: cannot be written"));
  EXPECT_THAT(test::names_in(folder / "disk"), testing::ElementsAre("filler"));
}

}  // namespace
}  // namespace caplet
