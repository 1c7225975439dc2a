// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What is written is read as the same scene: the same buffers of the device to the bit, and the
// same text when it is written again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <sstream>

#include "base/log.h"
#include "export/detail/text.h"
#include "export/export.h"
#include "flat_equal.h"
#include "import/detail/pbrt/pbrt.h"
#include "present/lights.h"
#include "present/present.h"
#include "random_scene.h"
#include "scene_files.h"

namespace caplet {
namespace {

using namespace test;
namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

std::string text_of(const Scene& scene, const fs::path& folder) {
  std::string out;
  write_pbrt(scene, folder, [&](std::string_view piece) { out += piece; });
  return out;
}

std::string contents(const fs::path& file) {
  std::ostringstream out;
  out << std::ifstream(file, std::ios::binary).rdbuf();
  return out.str();
}

Scene scene_of(const std::string& text) {
  const fs::path file = temporary_folder() / "scene.pbrt";
  std::ofstream(file, std::ios::binary) << text;
  return import_scene(file, NamedImages());
}

std::string refusal_of(const Scene& scene) {
  try {
    text_of(scene, "/tmp");
  } catch (const InputError& error) {
    return error.messages().front();
  }
  return {};
}

TEST(RoundTrip, EveryRowOfEveryList) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const fs::path folder = temporary_folder(), file = folder / "scene.pbrt";
    const Scene scene = random_scene(seed, folder);
    write_scene(scene, file);
    const std::string text = contents(file);
    for (const char* type : {
#define TEXTURE_MODEL(name, Type) #name,
#define OWN_TEXTURE_MODEL(name, Type)
#include "scene/textures.def"
#define MATERIAL_MODEL(name, Type) #name,
#include "scene/materials.def"
#define LIGHT_MODEL(name, Type) #name,
#include "scene/lights.def"
         })
      EXPECT_THAT(text, HasSubstr("\"" + std::string(type) + "\""));
    const Scene read = import_scene(file, NamedImages());
    EXPECT_EQ(different_buffers(scene, read), "");
    EXPECT_EQ(text_of(read, folder), text);
    EXPECT_EQ(read.automatic_camera, scene.automatic_camera);
    EXPECT_EQ(read.has_no_up, scene.has_no_up);
    EXPECT_EQ(read.framing.toward_viewer, scene.framing.toward_viewer);
    EXPECT_EQ(read.framing.up, scene.framing.up);
    EXPECT_EQ(read.unit, scene.unit);
    EXPECT_EQ(read.world_from_file, scene.world_from_file);
    ASSERT_EQ(read.legend.has_value(), scene.legend.has_value());
    if (scene.legend) {
      EXPECT_EQ(read.legend->title, scene.legend->title);
      EXPECT_EQ(read.legend->unit, scene.legend->unit);
      EXPECT_EQ(read.legend->low, scene.legend->low);
      EXPECT_EQ(read.legend->high, scene.legend->high);
      EXPECT_EQ(read.legend->colors, scene.legend->colors);
      EXPECT_EQ(read.legend->names, scene.legend->names);
      EXPECT_EQ(read.legend->of_directions, scene.legend->of_directions);
    }
    EXPECT_EQ(read.view.film.exposure, scene.view.film.exposure);
    EXPECT_EQ(read.view.film.least_width, scene.view.film.least_width);
    ASSERT_EQ(read.view.film.backdrop.has_value(), scene.view.film.backdrop.has_value());
    if (scene.view.film.backdrop) {
      EXPECT_EQ(read.view.film.backdrop->kind, scene.view.film.backdrop->kind);
      EXPECT_EQ(read.view.film.backdrop->color, scene.view.film.backdrop->color);
    }
    EXPECT_EQ(read.view.film.filename, scene.view.film.filename);
    EXPECT_EQ(read.view.film.exposure_time, scene.view.film.exposure_time);
    EXPECT_EQ(read.view.film.max_component_value, scene.view.film.max_component_value);
    EXPECT_EQ(read.view.film.white_balance, scene.view.film.white_balance);
    EXPECT_EQ(read.view.film.iso, scene.view.film.iso);
    EXPECT_EQ(read.view.film.f_number, scene.view.film.f_number);
    EXPECT_EQ(read.view.filter.kind, scene.view.filter.kind);
    EXPECT_EQ(read.view.filter.tau, scene.view.filter.tau);
    EXPECT_EQ(read.view.filter.radius_x, scene.view.filter.radius_x);
    EXPECT_EQ(read.view.filter.sigma, scene.view.filter.sigma);
    EXPECT_EQ(read.view.filter.c, scene.view.filter.c);
    EXPECT_EQ(read.view.sampler.samples_per_pixel, scene.view.sampler.samples_per_pixel);
    EXPECT_EQ(read.view.camera.world_from_camera, scene.view.camera.world_from_camera);
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
      if (!scene.materials[i].name.empty()) {
        EXPECT_EQ(read.materials[i].name, scene.materials[i].name);
      }
    for (std::size_t i = 0; i < scene.shapes.size(); ++i)
      EXPECT_EQ(read.shapes[i].name, scene.shapes[i].name);
  }
}

void expect_same(const fs::path& folder) {
  each_written_again(folder, [](const Scene& scene, const Scene& read, const fs::path& file) {
    EXPECT_EQ(text_of(read, file.parent_path()), contents(file));
    EXPECT_EQ(read.view.camera.world_from_camera, scene.view.camera.world_from_camera);
    EXPECT_EQ(fov_of(read.view.camera), fov_of(scene.view.camera));
    EXPECT_EQ(count_primitives(read), count_primitives(scene));
    EXPECT_EQ(read.lights.size(), scene.lights.size());
  });
}

TEST(RoundTrip, ExampleScenesAreTheSameText) { expect_same(source_folder() / "scenes"); }

TEST(RoundTrip, SharedScenesAreTheSameText) {
  CAPLET_NEEDS_DATA();
  expect_same(data_folder());
}

TEST(RoundTrip, SeedsOfTheFuzzersAreTheSameText) {
  std::size_t count = 0;
  for (const auto& entry :
       fs::recursive_directory_iterator(source_folder() / "tests/fuzz/seeds/pbrt")) {
    if (!entry.is_regular_file()) continue;
    SCOPED_TRACE(entry.path());
    const fs::path beside = source_folder() / "tests/fuzz/beside";
    const auto read = [&](const std::string& from) {
      Scene scene = pbrt::import_text((beside / "seed.pbrt").string(), from, NamedImages());
      Diagnostics diagnostics;
      validate(scene, diagnostics);
      diagnostics.finish();
      return scene;
    };
    std::optional<Scene> scene;
    try {
      scene = read(contents(entry.path()));
    } catch (const InputError&) {
      continue;
    }
    const std::string text = text_of(*scene, beside);
    EXPECT_EQ(text_of(read(text), beside), text);
    ++count;
  }
  EXPECT_GT(count, 3u);
}

// --- What scenes say beyond their picture ---

const std::string world = "Camera \"perspective\"\nWorldBegin\n";

TEST(RoundTrip, NeuronsAreFramedAgainWhenTheirSizeChanges) {
  Scene scene = import_scene(source_folder() / "scenes/neuron.swc", FileImageReader());
  Scene read = scene_of(text_of(scene, "/tmp"));
  EXPECT_TRUE(read.automatic_camera);
  EXPECT_TRUE(read.has_no_up);
  for (Scene* one : {&scene, &read}) {
    one->view.film.width = 300;
    one->view.film.height = 700;
    frame_camera(*one);
  }
  EXPECT_EQ(different_buffers(scene, read), "");
}

TEST(RoundTrip, OperandsAreTheObjectsThatThereAre) {
  const std::string text = text_of(scene_of(world + R"(
MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [1 0 0]
NamedMaterial "red"
ObjectBegin "ball" Shape "sphere" "float radius" 1 ObjectEnd
ObjectBegin "die" Translate 1 0 0 Shape "box" "point3 p0" [0 0 0] "point3 p1" [1 1 1] ObjectEnd
ObjectBegin "cut" Shape "csg" "string operation" "difference" "string operands" ["ball" "die"] ObjectEnd
Shape "csg" "string operation" "union" "string operands" ["cut" "die"]
)"),
                                   "/tmp");
  EXPECT_THAT(text, HasSubstr("\"string operands\" [\"ball\" \"die\"]"));
  EXPECT_THAT(text, HasSubstr("\"string operands\" [\"cut\" \"die\"]"));
  EXPECT_THAT(text, Not(HasSubstr("operand 1")));
}

TEST(RoundTrip, OperandsOfNoObjectGetOne) {
  Scene scene = scene_of(world + R"(
ObjectBegin "ball" Shape "sphere" ObjectEnd
ObjectBegin "die" Shape "box" "point3 p0" [0 0 0] "point3 p1" [1 1 1] ObjectEnd
Shape "csg" "string operation" "difference" "string operands" ["ball" "die"]
)");
  scene.objects.clear();
  const std::string text = text_of(scene, "/tmp");
  EXPECT_THAT(text, HasSubstr("\"string operands\" [\"operand 1\" \"operand 2\"]"));
  const Scene read = scene_of(text);
  EXPECT_EQ(text_of(read, "/tmp"), text);
  EXPECT_EQ(std::get<CsgShape>(read.shapes[0].geometry).operands.size(), 2u);
}

TEST(RoundTrip, HairIsOneSidedUnlessTheSceneSaysOtherwise) {
  const std::string fibre = R"(Material "hair"
Shape "capsule" "point3 p0" [0 0 0] "point3 p1" [1 0 0] "float radius" 1)";
  Scene scene = scene_of(world + fibre);
  EXPECT_TRUE(scene.shapes[0].one_sided);
  EXPECT_THAT(text_of(scene, "/tmp"), Not(HasSubstr("onesided")));
  EXPECT_FALSE(scene_of(world + fibre + " \"bool onesided\" false").shapes[0].one_sided);
  scene.shapes[0].one_sided = false;
  EXPECT_FALSE(scene_of(text_of(scene, "/tmp")).shapes[0].one_sided);
}

// A csg shape is one-sided if it shows hair anywhere: on an operand, on one of an operand, or by
// its own list of materials.
TEST(RoundTrip, CsgOfHairIsOneSidedUnlessTheSceneSaysOtherwise) {
  const std::string operands = R"(MakeNamedMaterial "fibre" "string type" "hair"
MakeNamedMaterial "stone" "string type" "diffuse"
NamedMaterial "stone"
ObjectBegin "ball" Shape "sphere" ObjectEnd
ObjectBegin "die" Shape "box" "point3 p0" [0 0 0] "point3 p1" [1 1 1] ObjectEnd
ObjectBegin "lock" NamedMaterial "fibre" Shape "capsule" "point3 p0" [0 0 0] "point3 p1" [2 0 0] "float radius" 0.5 ObjectEnd
ObjectBegin "cut" Shape "csg" "string operation" "union" "string operands" ["die" "lock"] ObjectEnd
)";
  const auto csg = [&](const std::string& of, const std::string& more = "") {
    return scene_of(world + operands +
                    "Shape \"csg\" \"string operation\" \"union\" \"string operands\" [" + of +
                    "] " + more + "\n");
  };
  struct Row {
    const char *operands, *materials;
    bool has_hair;
  };
  // A ball has one surface, a box six.
  for (const Row& row :
       {Row{R"("ball" "lock")", "", true},
        {R"("lock" "ball")", "", true},
        {R"("ball" "cut")", "", true},
        {R"("ball" "die")", "", false},
        {R"("ball" "die")",
         R"("string materials" ["stone" "stone" "stone" "fibre" "stone" "stone" "stone"])",
         true}}) {
    SCOPED_TRACE(std::string(row.operands) + row.materials);
    Scene scene = csg(row.operands, row.materials);
    ASSERT_EQ(scene.shapes.size(), 1u);
    EXPECT_EQ(scene.shapes[0].one_sided, row.has_hair);
    EXPECT_THAT(text_of(scene, "/tmp"), Not(HasSubstr("onesided")));
    EXPECT_EQ(csg(row.operands, std::string(row.materials) + R"( "bool onesided" false)")
                  .shapes[0]
                  .one_sided,
              false);
    EXPECT_EQ(csg(row.operands, std::string(row.materials) + R"( "bool onesided" true)")
                  .shapes[0]
                  .one_sided,
              true);
    for (const bool one_sided : {false, true}) {
      scene.shapes[0].one_sided = one_sided;
      EXPECT_EQ(scene_of(text_of(scene, "/tmp")).shapes[0].one_sided, one_sided);
    }
  }
}

// Operands that no object holds get objects, whose shapes are as they are: of hair, one-sided or
// not.
TEST(RoundTrip, OperandsOfHairKeepTheirSides) {
  const Scene original = scene_of(world + R"(Material "hair"
ObjectBegin "one" Shape "capsule" "point3 p0" [0 0 0] "point3 p1" [2 0 0] "float radius" 0.5 ObjectEnd
ObjectBegin "two" Shape "sphere" ObjectEnd
Shape "csg" "string operation" "union" "string operands" ["one" "two"]
)");
  for (const bool one_sided : {false, true}) {
    Scene scene = original;
    scene.objects.clear();
    for (auto& operand : std::get<CsgShape>(scene.shapes.at(0).geometry).operands) {
      Shape changed = *operand;
      changed.one_sided = one_sided;
      operand = std::make_shared<const Shape>(changed);
    }
    const Scene read = scene_of(text_of(scene, "/tmp"));
    ASSERT_EQ(read.objects.size(), 2u);
    for (const Object& object : read.objects) EXPECT_EQ(object.shapes.at(0).one_sided, one_sided);
  }
}

TEST(RoundTrip, FilesAreNamedFromTheFolder) {
  const fs::path folder = temporary_folder();
  fs::create_directories(folder / "images");
  fs::create_directories(folder / "out");
  std::ofstream(folder / "images/sky.exr") << "x";
  std::ofstream(folder / "a.pbrt")
      << world +
             "LightSource \"infinite\" \"string filename\" \"images/sky.exr\"\nShape \"sphere\"\n";
  const Scene scene = import_scene(folder / "a.pbrt", NamedImages());
  EXPECT_THAT(text_of(scene, folder), HasSubstr("\"string filename\" \"images/sky.exr\""));
  EXPECT_THAT(text_of(scene, folder / "out"),
              HasSubstr("\"string filename\" \"../images/sky.exr\""));
  EXPECT_THAT(text_of(scene, "/nowhere/else"),
              HasSubstr("\"string filename\" \"" + fs::canonical(folder).string()));
}

TEST(RoundTrip, SpectraWithNamesKeepThem) {
  const std::string text = text_of(
      scene_of(world +
               R"(Material "conductor" "spectrum eta" "metal-Ag-eta" "spectrum k" "metal-Ag-k"
Shape "sphere")"),
      "/tmp");
  EXPECT_THAT(text, HasSubstr("\"spectrum eta\" \"metal-Ag-eta\""));
  EXPECT_THAT(text, HasSubstr("\"spectrum k\" \"metal-Ag-k\""));
}

// Small whole numbers are no defaults: lights and emissions of each scale, power and illuminance
// are read as they were.
TEST(RoundTrip, ScalesAndPowersOfLights) {
  for (const std::string scale : {"0.5", "1", "2", "3"})
    for (const std::string power : {"", "0.5", "1", "2"}) {
      SCOPED_TRACE(scale + " " + power);
      const std::string by =
          "\"float scale\" " + scale + (power.empty() ? "" : " \"float power\" " + power);
      const std::string illuminance =
          "\"float scale\" " + scale + (power.empty() ? "" : " \"float illuminance\" " + power);
      const Scene scene = scene_of(world + "LightSource \"point\" \"rgb I\" [1 1 1] " + by +
                                   "\nLightSource \"distant\" \"rgb L\" [1 1 1] " + illuminance +
                                   "\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1] " + by +
                                   "\nShape \"sphere\"\n");
      const Scene read = scene_of(text_of(scene, "/tmp"));
      const double scaled = std::stod(scale);
      const std::optional<double> given =
          power.empty() ? std::nullopt : std::optional(std::stod(power));
      ASSERT_EQ(read.lights.size(), 2u);
      for (const Light& light : read.lights) EXPECT_EQ(light.scale, scaled);
      EXPECT_EQ(read.lights[0].power, given);
      EXPECT_EQ(read.lights[1].illuminance, given);
      ASSERT_TRUE(read.shapes.at(0).emission);
      EXPECT_EQ(read.shapes[0].emission->scale, scaled);
      EXPECT_EQ(read.shapes[0].emission->power, given);
    }
}

// --- Refusals ---

TEST(WriteScene, WhatNoTextSaysIsRefusedAtItsPlace) {
  const Scene good = scene_of(
      world +
      "LightSource \"infinite\" \"rgb L\" [1 1 1]\nShape \"sphere\" \"string name\" \"a\"\n");
  EXPECT_EQ(refusal_of(good), "");
  Scene scene = good;
  auto image = std::make_shared<EnvironmentImage>();
  image->width = image->height = 1;
  image->rgb = {1, 1, 1};
  std::get<InfiniteLight>(scene.lights[0].model).image = image;
  EXPECT_THAT(refusal_of(scene),
              HasSubstr("scene.pbrt:3:1: the light's image was read from no file"));
  scene = good;
  scene.shapes[0].name = "a\x02";
  EXPECT_THAT(refusal_of(scene), HasSubstr("scene.pbrt:4:1: the name holds a control character"));
  scene = good;
  scene.shapes[0].material = 7;
  EXPECT_THAT(refusal_of(scene), HasSubstr("material that does not exist"));
  scene = good;
  scene.lights.emplace_back();
  scene.lights.back().model = DistantLight{ConstantSpectrum{1}, {0, 0, 2}};
  EXPECT_THAT(refusal_of(scene), HasSubstr("not of unit length"));
  scene = good;
  scene.shapes[0].world_from_object = glm::scale(glm::dmat4(1), {1e-7, 1e-7, 1});
  scene.shapes[0].world_from_object[0][1] = 1e-7;
  scene.shapes[0].world_from_object[1][0] = 1e-7 * (1 - 1e-13);
  EXPECT_NE(refusal_of(scene), "");
  scene = good;
  scene.materials.push_back({InterfaceMaterial{}, "gone", {}});
  scene.shapes[0].material = static_cast<std::uint32_t>(scene.materials.size() - 1);
  EXPECT_THAT(refusal_of(scene), HasSubstr("seen by nothing"));
}

using TextureModel = decltype(Texture::model);

TEST(WriteScene, TexturesThatNoTextSaysAreRefused) {
  const auto refusal_with = [&](TextureModel model) {
    Scene scene = scene_of(world + "Shape \"sphere\"\n");
    scene.textures.push_back({CheckerboardTexture{}, false, "board", {}});
    scene.textures.push_back({std::move(model), false, "t", {"scene.pbrt", 9, 1}});
    scene.materials.at(0).textures.push_back({"reflectance", 1});
    return refusal_of(scene);
  };
  EXPECT_EQ(refusal_with(CheckerboardTexture{}), "");
  EXPECT_THAT(refusal_with(ScaleTexture{}),
              HasSubstr("scene.pbrt:9:1: the texture is made of constants alone"));
  DirectionmixTexture mix;
  mix.tex2.texture = 0;
  EXPECT_EQ(refusal_with(mix), "");
  mix.dir = {0, 2, 0};
  EXPECT_THAT(refusal_with(mix), HasSubstr("dir is no direction of unit length"));
}

TEST(WriteScene, LightsThatNoTextSaysAreRefused) {
  const auto refusal_with = [&](auto model) {
    Scene scene = scene_of(world + "Shape \"sphere\"\n");
    scene.lights.emplace_back();
    scene.lights.back().model = std::move(model);
    return refusal_of(scene);
  };
  auto image = std::make_shared<EnvironmentImage>();
  image->width = image->height = 1;
  image->rgb = {1, 1, 1};
  image->file = "lamp.exr";
  GoniometricLight turned;
  turned.image = image;
  EXPECT_EQ(refusal_with(turned), "");
  turned.world_from_light = 2.0 * glm::dmat3(1);
  EXPECT_THAT(refusal_with(turned), HasSubstr("the light's rotation is not of unit length"));
  SpotLight spot;
  spot.direction = {0, 0, 0.5};
  EXPECT_THAT(refusal_with(spot), HasSubstr("the light's direction is not of unit length"));
}

// The camera's medium, the background, and colours of a capsule are written and read again.
TEST(WriteScene, KeepsWhatTheCameraIsIn) {
  const Scene scene = scene_of(
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"float g\" 0.25\n"
      "MediumInterface \"\" \"fog\"\nCamera \"perspective\"\nMediumInterface \"\" \"\"\n"
      "WorldBegin\nShape \"sphere\"\n");
  ASSERT_TRUE(scene.view.camera.medium);
  const Scene read = scene_of(text_of(scene, "/tmp"));
  ASSERT_TRUE(read.view.camera.medium);
  const Medium& medium = read.media.at(*read.view.camera.medium);
  EXPECT_EQ(medium.name, "fog");
  EXPECT_EQ(std::get<HomogeneousMedium>(medium.model).scattering.g, 0.25);
  EXPECT_FALSE(read.shapes.at(0).media.outside);
}

// A mix is written after the materials that it mixes, in any order of the scene.
TEST(WriteScene, MixesComeAfterTheirParts) {
  Scene scene = scene_of(world +
                         "Material \"diffuse\" \"rgb reflectance\" [0.1 0.2 0.3]\n"
                         "Shape \"sphere\"\n");
  const auto first = static_cast<std::uint32_t>(scene.materials.size());
  for (int i = 0; i < 3; ++i)
    scene.materials.push_back(scene.materials.at(scene.shapes[0].material));
  scene.materials[first].name = "top";
  scene.materials[first].model = MixMaterial{{first + 1, first + 2}, 0.25};
  scene.materials[first + 1].name = "lower";
  scene.materials[first + 1].model = MixMaterial{{first + 2, first + 2}, 0.5};
  scene.materials[first + 2].name = "base";
  scene.shapes[0].material = first;
  const std::string text = text_of(scene, "/tmp");
  const auto place = [&](const char* name) {
    return text.find("MakeNamedMaterial \"" + std::string(name) + "\"");
  };
  EXPECT_LT(place("base"), place("lower"));
  EXPECT_LT(place("lower"), place("top"));
  EXPECT_LT(place("top"), std::string::npos);
  const Scene read = scene_of(text);
  const Material& top = read.materials.at(read.shapes.at(0).material);
  ASSERT_TRUE(std::holds_alternative<MixMaterial>(top.model));
  EXPECT_EQ(read.materials.at(std::get<MixMaterial>(top.model).materials[0]).name, "lower");
  EXPECT_EQ(read.materials.at(std::get<MixMaterial>(top.model).materials[1]).name, "base");
}

TEST(WriteScene, AFileIsReplacedAsAWholeOrNotAtAll) {
  const fs::path folder = temporary_folder(), file = folder / "scene.pbrt";
  std::ofstream(file) << "old";
  Scene scene = scene_of(world + "Shape \"sphere\"\n");
  EXPECT_THROW(write_scene(scene, folder / "scene.exr"), InputError);
  EXPECT_THROW(write_scene(scene, file, [] { return true; }), RunError);
  scene.shapes[0].name = "a\x02";
  EXPECT_THROW(write_scene(scene, file), InputError);
  EXPECT_EQ(contents(file), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
  scene.shapes[0].name = "a";
  write_scene(scene, file);
  EXPECT_THAT(contents(file),
              HasSubstr("Shape \"sphere\" \"float radius\" 1 \"string name\" \"a\"\n"));
}

// --- What importers read for the writer's sake ---

TEST(OurStatements, MeshesThatMove) {
  const Scene scene = scene_of(
      world +
      "Shape \"trianglemesh\" \"float times\" [0.25 2] \"point3 P\" [0 0 0 1 0 0 0 1 0  0 0 1 1 0 "
      "1 "
      "0 1 4] \"normal N\" [0 0 1 0 0 2 0 1 0] \"point2 uv\" [0 0 1 0 0 1]\n"
      "Shape \"trianglemesh\" \"float times\" [0 1 2] \"point3 P\" [0 0 0 1 0 0 0 1 0  0 0 1 1 0 1 "
      "0 1 4  0 0 0 1 0 0 0 1 0] \"normal N\" [0 0 1 0 0 1 0 0 1 0 1 0 0 1 0 0 1 0 1 0 0 1 0 0 1 0 "
      "0]"
      "\n");
  const auto& once = std::get<TriangleMeshShape>(scene.shapes.at(0).geometry);
  EXPECT_EQ(once.times, (std::vector<double>{0.25, 2}));
  EXPECT_EQ(vertex_count(once), 3u);
  EXPECT_EQ(once.positions.size(), 6u);
  EXPECT_EQ(once.positions[5], glm::vec3(0, 1, 4));
  EXPECT_EQ(once.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}}));
  // Normals that are given once are those of all times.
  EXPECT_EQ(once.normals, (std::vector<glm::vec3>{
                              {0, 0, 1}, {0, 0, 2}, {0, 1, 0}, {0, 0, 1}, {0, 0, 2}, {0, 1, 0}}));
  const auto& each = std::get<TriangleMeshShape>(scene.shapes.at(1).geometry);
  EXPECT_EQ(each.normals.size(), 9u);
  EXPECT_EQ(each.normals[8], glm::vec3(1, 0, 0));
}

TEST(OurStatements, CapsulesThatMove) {
  const std::string statement =
      "Shape \"capsules\" \"float times\" [0.25 2] \"point3 p0\" [0 0 0 1 0 0  2 0 0 3 0 0] "
      "\"point3 p1\" [0 1 0 1 1 0  0 2 0 1 2 0] \"float radius\" [0.1 0.2]";
  const Scene scene =
      scene_of(world + statement + "\n" + statement + " \"float radius1\" [1 2 3 4]\n");
  const auto& read = std::get<CapsulesShape>(scene.shapes[0].geometry);
  EXPECT_EQ(read.times, (std::vector<double>{0.25, 2}));
  EXPECT_EQ(count_of(read), 2u);
  EXPECT_EQ(read.p0, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}));
  EXPECT_EQ(read.radius0, (std::vector<float>{0.1f, 0.2f, 0.1f, 0.2f}));
  EXPECT_TRUE(read.radius1.empty());
  const auto& tapered = std::get<CapsulesShape>(scene.shapes[1].geometry);
  EXPECT_EQ(tapered.radius1, (std::vector<float>{1, 2, 3, 4}));
  const auto said = [&](const std::string& text) {
    try {
      scene_of(world + text);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(said("AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"float power\" 5\n" + statement),
              HasSubstr("a shape whose points move cannot be a light of a given \"power\""));
  EXPECT_THAT(said("ObjectBegin \"a\"\n" + statement +
                   "\nObjectEnd\nObjectBegin \"b\" Shape \"sphere\" ObjectEnd\nShape \"csg\" "
                   "\"string operation\" \"union\" \"string operands\" [\"a\" \"b\"]\n"),
              HasSubstr("holds 2 capsules in one shape"));
  EXPECT_THAT(said("Shape \"capsule\" \"float times\" [0 1] \"point3 p0\" [0 0 0] \"point3 p1\" [1 "
                   "0 0] \"float radius\" 1\n"),
              HasSubstr("times"));
}

TEST(OurStatements, CapsulesInLists) {
  const std::string materials =
      "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\nMakeNamedMaterial \"b\" \"string "
      "type\" \"diffuse\"\n";
  const Scene scene = scene_of(world + materials + R"(NamedMaterial "a"
Shape "capsules" "point3 p0" [0 0 0 1 0 0] "point3 p1" [0 1 0
1 1 0] "float radius" [0.1 0.2] "float radius1" [0.1 0.3] "string capsulematerials" ["" "b"] "integer materialindices" [1 0] "float u" [0 0.5
0.5 -2])");
  const auto& read = std::get<CapsulesShape>(scene.shapes[0].geometry);
  EXPECT_EQ(read.p0, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}}));
  EXPECT_EQ(read.p1, (std::vector<glm::vec3>{{0, 1, 0}, {1, 1, 0}}));
  EXPECT_EQ(read.radius0, (std::vector<float>{0.1f, 0.2f}));
  EXPECT_EQ(read.radius1, (std::vector<float>{0.1f, 0.3f}));
  EXPECT_EQ(read.materials, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(read.u, (std::vector<glm::vec2>{{0, 0.5f}, {0.5f, -2}}));
  const auto said = [&](const std::string& parameters) {
    try {
      scene_of(world + materials + "Shape \"capsules\" \"point3 p0\" [0 0 0 1 0 0] " + parameters);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string ends = "\"point3 p1\" [0 1 0 1 1 0] ";
  EXPECT_THAT(said(ends + "\"float radius\" [1 1] \"float times\" [1]"),
              HasSubstr("\"times\" takes two times or more"));
  EXPECT_THAT(said(ends + "\"float radius\" [1 1] \"float times\" [1 1]"),
              HasSubstr("\"times\" must rise"));
  EXPECT_THAT(said(ends + "\"float radius\" [1 1] \"float times\" [0 1 2]"),
              HasSubstr("\"p0\" has 2 points, which are not as many at each of 3 times"));
  EXPECT_THAT(said(ends + "\"float radius\" [1 1 1] \"float times\" [0 1]"),
              HasSubstr("has 3 values for 1 capsules at 2 times"));
  EXPECT_THAT(said("\"float radius\" [1 1]"), HasSubstr("\"p1\" is missing"));
  EXPECT_THAT(said("\"point3 p1\" [0 1 0] \"float radius\" [1 1]"),
              HasSubstr("has 1 points for 2"));
  EXPECT_THAT(said(ends + "\"float radius\" [1]"), HasSubstr("has 1 values for 2 capsules"));
  EXPECT_THAT(said(ends + "\"float radius\" [1 -1]"), HasSubstr("must not be negative"));
  EXPECT_THAT(said(ends + "\"float radius\" [1 1] \"float u\" [0 1 2]"),
              HasSubstr("\"u\" takes two values a capsule, 4, not 3"));
  EXPECT_THAT(said(ends + "\"float radius\" [1 1] \"float u\" [0 1 2 1e20]"),
              HasSubstr("\"u\" is too large a number"));
  EXPECT_THAT(said(ends + "\"float radius\" [1 1] \"float u\" [-1e20 1 2 1]"),
              HasSubstr("\"u\" is too large a number"));
  EXPECT_THAT(said(ends + "\"float radius\" [1 1] \"string capsulematerials\" \"a\""),
              HasSubstr("needs \"integer materialindices\""));
  EXPECT_THAT(said(ends + "\"float radius\" [1 1] \"string capsulematerials\" \"a\" \"integer "
                          "materialindices\" [0 1]"),
              HasSubstr("must be below"));
  EXPECT_THAT(said(ends + "\"float radius\" [1 1] \"string capsulematerials\" \"c\" \"integer "
                          "materialindices\" [0 0]"),
              HasSubstr("\"c\" is not defined"));
}

TEST(OurStatements, OneCapsuleOfAChain) {
  const Scene scene = scene_of(world +
                               "Shape \"capsule\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 1 0] "
                               "\"float radius\" 0.1 \"float u\" [0.1 0.7]");
  EXPECT_EQ(std::get<CapsulesShape>(scene.shapes[0].geometry).u,
            (std::vector<glm::vec2>{{0.1f, 0.7f}}));
  EXPECT_THAT(text_of(scene, "/tmp"), HasSubstr("\"float u\" [0.1 0.7]"));
}

// A curve, whose chain may be one capsule or many, as a shape, in an object, and as an operand.
TEST(RoundTrip, CurvesKeepTheirU) {
  const Scene scene = scene_of(world + R"(
Shape "curve" "point3 P" [0 0 0 1 2 0 2 2 0 3 0 0 4 1 2 5 0 1 6 0 0] "float width0" 0.3 "float width1" 0.1
Shape "curve" "point3 P" [0 0 1 1 0 1 2 0 1 3 0 1] "float width" 0.3
ObjectBegin "straight" Shape "curve" "point3 P" [0 0 2 1 0 2 2 0 2 3 0 2] "float width" 0.3 ObjectEnd
ObjectBegin "ball" Shape "sphere" ObjectEnd
Shape "csg" "string operation" "union" "string operands" ["straight" "ball"]
ObjectInstance "straight"
)");
  const auto& curve = std::get<CapsulesShape>(scene.shapes[0].geometry);
  ASSERT_GT(curve.u.size(), 4u);
  const Scene read = scene_of(text_of(scene, "/tmp"));
  EXPECT_EQ(std::get<CapsulesShape>(read.shapes[0].geometry).u, curve.u);
  EXPECT_EQ(std::get<CapsulesShape>(read.shapes[1].geometry).u, (std::vector<glm::vec2>{{0, 1}}));
  EXPECT_EQ(different_buffers(scene, read), "");
}

TEST(OurStatements, InverseTransformIsNotComputed) {
  const std::string matrix = "[0.6 0.8 0 0 -0.8 0.6 0 0 0 0 1 0 1 2 3 1]";
  const Scene scene = scene_of("InverseTransform " + matrix +
                               "\nCamera \"perspective\"\nWorldBegin\nShape \"sphere\"\n");
  EXPECT_EQ(scene.view.camera.world_from_camera,
            glm::dmat4(0.6, 0.8, 0, 0, -0.8, 0.6, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1));
  EXPECT_THROW(scene_of("InverseTransform [1 0 0 0 0 0 0 0 0 0 1 0 0 0 0 1] Camera \"perspective\" "
                        "WorldBegin Shape \"sphere\""),
               InputError);
  // A later statement of a transform takes its place.
  const Scene moved = scene_of("InverseTransform " + matrix +
                               " Identity Camera \"perspective\" WorldBegin Shape \"sphere\"");
  EXPECT_EQ(moved.view.camera.world_from_camera, glm::dmat4(1));
}

TEST(OurStatements, ANumberIsASpectrum) {
  const Scene scene = scene_of(world +
                               "LightSource \"point\" \"float I\" 3\nMaterial \"diffuse\" \"float "
                               "reflectance\" 0.25\nShape \"sphere\"\n");
  EXPECT_EQ(std::get<ConstantSpectrum>(std::get<PointLight>(scene.lights[0].model).intensity).value,
            3);
  EXPECT_EQ(
      std::get<ConstantSpectrum>(std::get<DiffuseMaterial>(scene.materials[0].model).reflectance)
          .value,
      0.25);
  EXPECT_THROW(
      scene_of(world + "Material \"diffuse\" \"float reflectance\" 1.25\nShape \"sphere\"\n"),
      InputError);
  EXPECT_THROW(scene_of(world + "LightSource \"point\" \"float I\" -1\nShape \"sphere\"\n"),
               InputError);
}

TEST(OurStatements, TheStudioHasAName) {
  const Scene scene =
      scene_of(world + "LightSource \"infinite\" \"string preset\" \"studio\"\nShape \"sphere\"\n");
  EXPECT_EQ(std::get<InfiniteLight>(scene.lights[0].model).image, studio_image());
  EXPECT_THROW(
      scene_of(world +
               "LightSource \"infinite\" \"string preset\" \"studium\"\nShape \"sphere\"\n"),
      InputError);
}

}  // namespace
}  // namespace caplet
