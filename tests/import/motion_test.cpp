// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// ActiveTransform and TransformTimes: what moves, and when.
#include <gmock/gmock.h>

#include <string>

#include "import_text.h"
#include "scene/motion.h"
#include "support/log_of.h"

namespace caplet::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const std::string balls = "Shape \"sphere\"\n";
const std::string to_the_right = "ActiveTransform EndTime\nTranslate 3 0 0\nActiveTransform All\n";

glm::dvec3 place_of(const glm::dmat4& matrix) { return {matrix[3]}; }

TEST(Motion, OfAShapeIsThatOfAnInstance) {
  const Scene scene = scene_of("TransformTimes 2 4\nWorldBegin\nTranslate 0 1 0\n" + to_the_right +
                               "ReverseOrientation\n" + balls);
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_THAT(scene.shapes, IsEmpty());
  const Instance& one = scene.instances[0];
  ASSERT_EQ(one.motion.size(), 2u);
  EXPECT_EQ(one.motion[0].time, 2);
  EXPECT_EQ(one.motion[1].time, 4);
  EXPECT_EQ(place_of(one.motion[0].matrix), glm::dvec3(0, 1, 0));
  EXPECT_EQ(place_of(one.motion[1].matrix), glm::dvec3(3, 1, 0));
  EXPECT_EQ(one.world_from_object, one.motion[0].matrix);
  EXPECT_EQ(one.pivot, glm::dvec3(0));
  const Object& object = scene.objects.at(one.object);
  ASSERT_EQ(object.shapes.size(), 1u);
  EXPECT_TRUE(object.shapes[0].reverse_orientation);
  EXPECT_EQ(object.shapes[0].world_from_object, glm::dmat4(1));
}

TEST(Motion, EndsWhereTheTransformsAreTheSame) {
  const Scene scene =
      world_of("AttributeBegin\n" + to_the_right + "AttributeEnd\n" + balls + "ActiveTransform " +
               "StartTime\nTranslate 0 0 2\nActiveTransform EndTime\nTranslate 0 0 2\n" + balls);
  EXPECT_THAT(scene.instances, IsEmpty());
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_EQ(place_of(scene.shapes[1].world_from_object), glm::dvec3(0, 0, 2));
}

TEST(Motion, OfTransformsOfAllKinds) {
  const auto end_of = [](const std::string& directives) {
    const Scene scene = world_of(
        "Translate 1 2 3\nCoordinateSystem \"here\"\nIdentity\n"
        "ActiveTransform EndTime\n" +
        directives + balls);
    EXPECT_EQ(scene.instances.at(0).motion.at(0).matrix, glm::dmat4(1));
    return scene.instances.at(0).motion.at(1).matrix;
  };
  EXPECT_EQ(place_of(end_of("Transform [1 0 0 0 0 1 0 0 0 0 1 0 4 5 6 1]\n")), glm::dvec3(4, 5, 6));
  EXPECT_EQ(place_of(end_of("ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 4 5 6 1]\n")),
            glm::dvec3(4, 5, 6));
  EXPECT_EQ(end_of("Scale 2 2 2\n")[1][1], 2);
  EXPECT_NEAR(end_of("Rotate 90 0 0 1\n")[0][1], 1, 1e-15);
  EXPECT_NEAR(place_of(end_of("LookAt 0 0 -5 0 0 0 0 1 0\n")).z, 5, 1e-15);
  // As in pbrt-v4 a named system is that of both times.
  const Scene both = world_of(to_the_right + "CoordinateSystem \"moving\"\nIdentity\n" + balls +
                              "ActiveTransform StartTime\nCoordSysTransform \"moving\"\n" + balls);
  EXPECT_EQ(both.shapes.size(), 1u);
  EXPECT_EQ(place_of(both.instances.at(0).motion.at(1).matrix), glm::dvec3(3, 0, 0));
}

TEST(Motion, OfTheCameraAndItsShutter) {
  const Scene scene = scene_of(
      "TransformTimes 1 2\nActiveTransform EndTime\nTranslate -1 0 0\nActiveTransform All\n"
      "Translate 0 0 5\nCamera \"perspective\" \"float shutteropen\" 1.25 \"float shutterclose\" "
      "1.5\nWorldBegin\n" +
      balls);
  const Camera& camera = scene.view.camera;
  ASSERT_EQ(camera.motion.size(), 2u);
  EXPECT_EQ(camera.motion[0].time, 1);
  EXPECT_EQ(place_of(camera.motion[0].matrix), glm::dvec3(0, 0, -5));
  EXPECT_EQ(place_of(camera.motion[1].matrix), glm::dvec3(1, 0, -5));
  EXPECT_EQ(camera.world_from_camera, camera.motion[0].matrix);
  EXPECT_EQ(scene.view.film.shutter_open, 1.25);
  EXPECT_EQ(scene.view.film.exposure_time, 0.25);
  EXPECT_THAT(scene.instances, IsEmpty());  // WorldBegin begins anew
  EXPECT_EQ(scene.shapes.size(), 1u);
}

// pbrt-v4 interpolates an instance's transforms in the space that it renders in.
TEST(Motion, OfInstancesTurnsAboutTheCamera) {
  const std::string object =
      "ObjectBegin \"a\"\n" + balls + "ObjectEnd\n" + to_the_right + "ObjectInstance \"a\"\n";
  EXPECT_EQ(scene_of("Translate 0 0 5\nCamera \"perspective\"\nWorldBegin\n" + object)
                .instances.at(0)
                .pivot,
            glm::dvec3(0, 0, -5));
  // Halfway through the motion of the camera.
  EXPECT_EQ(scene_of("Translate 0 0 5\nActiveTransform EndTime\nTranslate 0 0 2\nActiveTransform "
                     "All\nCamera \"perspective\"\nWorldBegin\n" +
                     object)
                .instances.at(0)
                .pivot,
            glm::dvec3(0, 0, -6));
  EXPECT_EQ(scene_of("Option \"string rendercoordsys\" \"world\"\nTranslate 0 0 5\nCamera "
                     "\"perspective\"\nWorldBegin\n" +
                     object)
                .instances.at(0)
                .pivot,
            glm::dvec3(0));
}

TEST(Motion, WithinAnObjectIsInEachInstance) {
  const Scene scene = world_of("ObjectBegin \"a\"\n" + balls + to_the_right +
                               "Shape \"disk\"\nObjectEnd\n"
                               "Identity\nObjectInstance \"a\"\nTranslate 0 5 0\nScale 2 2 2\n"
                               "ObjectInstance \"a\"\n");
  ASSERT_EQ(scene.instances.size(), 4u);
  EXPECT_THAT(scene.instances[0].motion, IsEmpty());
  ASSERT_EQ(scene.instances[1].motion.size(), 2u);
  ASSERT_EQ(scene.instances[3].motion.size(), 2u);
  EXPECT_EQ(place_of(scene.instances[3].motion[0].matrix), glm::dvec3(0, 5, 0));
  EXPECT_EQ(place_of(scene.instances[3].motion[1].matrix), glm::dvec3(6, 5, 0));
  EXPECT_EQ(scene.instances[3].world_from_object, scene.instances[3].motion[0].matrix);
}

TEST(Motion, OfWhatPbrtLeavesWhereItIs) {
  const std::string light = "LightSource \"point\"\n";
  LogOf log;
  world_of(light + to_the_right + balls);
  EXPECT_THAT(log.text(), Not(HasSubstr("move")));
  const Scene scene = world_of(to_the_right + light + light + balls);
  EXPECT_EQ(scene.lights.size(), 2u);
  EXPECT_THAT(log.text(), HasSubstr("a light without a shape does not move"));
}

}  // namespace
}  // namespace caplet::test
