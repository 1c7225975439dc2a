// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Motions as text: ActiveTransform, TransformTimes and the shutter.
#include <gmock/gmock.h>

#include <string>

#include "export/export.h"
#include "import/detail/pbrt/pbrt.h"
#include "random_scene.h"
#include "support/data.h"

namespace caplet::test {
namespace {

using ::testing::HasSubstr;

const std::string balls = "Shape \"sphere\"\n";
const std::string to_the_right = "ActiveTransform EndTime\nTranslate 3 0 0\nActiveTransform All\n";

Scene scene_of(const std::string& text) {
  return pbrt::import_text("scene.pbrt", text, NamedImages());
}

std::string written(const Scene& scene) {
  std::string out;
  write_pbrt(scene, temporary_folder(), [&](std::string_view piece) { out += piece; });
  return out;
}

// What is written is read as the same motions, and written as the same text.
TEST(MotionText, IsWrittenAndReadAgain) {
  for (const std::string& coordinates :
       {std::string(), std::string("Option \"string rendercoordsys\" \"world\"\n")}) {
    const Scene scene = scene_of(
        coordinates +
        "TransformTimes 0.5 2\nRotate 30 0 1 0\nActiveTransform EndTime\nTranslate 0 1 0\n"
        "ActiveTransform All\nTranslate 0 0 5\nCamera \"perspective\" \"float shutteropen\" 0.1 "
        "\"float shutterclose\" 0.8\nWorldBegin\nObjectBegin \"a\"\n" +
        balls + balls + "ObjectEnd\nTranslate 1 1 1\nRotate 20 1 1 0\n" + to_the_right + balls +
        "AreaLightSource \"diffuse\"\nShape \"cylinder\"\nObjectInstance \"a\"\nScale 2 1 1\n"
        "ObjectInstance \"a\"\n");
    const std::string text = written(scene);
    const Scene again = scene_of(text);
    EXPECT_EQ(written(again), text);
    ASSERT_EQ(again.instances.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
      const Instance &a = scene.instances[i], &b = again.instances[i];
      EXPECT_EQ(a.pivot, b.pivot);
      ASSERT_EQ(b.motion.size(), 2u);
      for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_EQ(a.motion[k].time, b.motion[k].time);
        EXPECT_EQ(a.motion[k].matrix, b.motion[k].matrix);
      }
    }
    ASSERT_EQ(again.view.camera.motion.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_EQ(again.view.camera.motion[k].matrix, scene.view.camera.motion[k].matrix);
    EXPECT_EQ(again.view.film.shutter_open, scene.view.film.shutter_open);
    EXPECT_EQ(again.view.film.exposure_time, scene.view.film.exposure_time);
  }
}

TEST(MotionText, OfOperandsIsWrittenAndReadAgain) {
  const Scene scene = scene_of(
      "TransformTimes 0.5 2\nCamera \"perspective\"\nWorldBegin\nObjectBegin \"still\"\n"
      "Scale 1 2 1\nShape \"sphere\"\nObjectEnd\nObjectBegin \"moving\"\nRotate 20 1 1 0\n" +
      to_the_right + "Shape \"sphere\"\nObjectEnd\nObjectBegin \"both\"\nRotate 10 0 0 1\n" +
      to_the_right +
      "Shape \"csg\" \"string operation\" \"union\" \"string operands\" [\"still\" \"moving\"]\n"
      "ObjectEnd\nShape \"csg\" \"string operation\" \"difference\" \"string operands\" "
      "[\"both\" \"still\"]\n");
  const std::string text = written(scene);
  const Scene again = scene_of(text);
  EXPECT_EQ(written(again), text);
  const auto motions_of = [](const Geometry& geometry) {
    std::vector<std::pair<double, glm::dmat4>> out;
    for (const TransformKeys& keys : std::get<CsgShape>(geometry).motions) {
      out.emplace_back(-1, glm::dmat4(static_cast<double>(keys.size())));
      for (const TransformKey& key : keys) out.emplace_back(key.time, key.matrix);
    }
    return out;
  };
  const auto outer = std::get<CsgShape>(scene.shapes.back().geometry),
             outer_again = std::get<CsgShape>(again.shapes.back().geometry);
  // Objects of shapes that move, which no instance places, are gone.
  EXPECT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(motions_of(outer).size(), 4u);
  EXPECT_EQ(motions_of(outer), motions_of(outer_again));
  EXPECT_EQ(motions_of(outer.operands[0]->geometry), motions_of(outer_again.operands[0]->geometry));
  // The one that rests is the second in one csg and the first in the other.
  EXPECT_EQ(outer.motions[0].front().matrix, outer.operands[0]->world_from_object);
  EXPECT_TRUE(outer.motions[1].empty());
  EXPECT_TRUE(std::get<CsgShape>(outer.operands[0]->geometry).motions[0].empty());

  Scene other = scene;
  std::get<CsgShape>(other.shapes.back().geometry).motions[0][1].time = 3;
  EXPECT_THROW(written(other), InputError);
}

// The numbers of the objects change when those of operands go.
TEST(MotionText, InstancesKeepTheirObjects) {
  const Scene scene =
      scene_of("Camera \"perspective\"\nWorldBegin\nObjectBegin \"cut\"\n" + to_the_right +
               "Shape \"sphere\"\nObjectEnd\nObjectBegin \"seen\"\n" + to_the_right +
               "Shape \"cylinder\"\nObjectEnd\nObjectBegin \"block\"\nShape \"box\" \"point3 p0\" "
               "[0 0 0] \"point3 p1\" [1 1 1]\nObjectEnd\nObjectInstance \"seen\"\nObjectInstance "
               "\"block\"\nShape \"csg\" \"string operation\" \"difference\" \"string operands\" "
               "[\"block\" \"cut\"]\n");
  std::vector<std::string> kinds;
  for (const Instance& instance : scene.instances)
    for (const Shape& shape : scene.objects.at(instance.object).shapes)
      kinds.emplace_back(geometry_name(shape));
  EXPECT_THAT(kinds, testing::UnorderedElementsAre("cylinder", "box"));
  EXPECT_EQ(scene.objects.size(), 4u);
  try {
    scene_of("Camera \"perspective\"\nWorldBegin\nObjectBegin \"two\"\nShape \"sphere\"\n" +
             to_the_right +
             "Shape \"sphere\"\nObjectEnd\nShape \"csg\" \"string operation\" "
             "\"union\" \"string operands\" [\"two\" \"two\"]\n");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("which holds 2 shapes; an operand is one closed shape"));
  }
}

TEST(MotionText, ThatCannotSayAMotionIsRefused) {
  Scene scene =
      scene_of("Camera \"perspective\"\nWorldBegin\n" +
               std::string("ObjectBegin \"a\"\n" + balls + balls + "ObjectEnd\n" + to_the_right +
                           "ObjectInstance \"a\"\nObjectInstance \"a\"\n"));
  const auto refusal = [&] {
    try {
      written(scene);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal(), "");
  const Scene before = scene;
  scene.instances[1].pivot = {1, 0, 0};
  EXPECT_THAT(refusal(), HasSubstr("turns about a point of its own"));
  scene = before;
  scene.instances[1].motion[1].time = 3;
  EXPECT_THAT(refusal(), HasSubstr("times"));
  scene = before;
  scene.instances[1].motion.push_back({7, glm::dmat4(1)});
  EXPECT_THAT(refusal(), HasSubstr("times"));
}

}  // namespace
}  // namespace caplet::test
