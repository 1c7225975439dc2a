// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Embree's XML scenes: names, and elements within each other.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "import/import.h"
#include "support/import_files.h"

namespace caplet {
namespace {

using test::complaint;
using testing::HasSubstr;

Scene scene_of(const std::string& inside) {
  return import_scene(
      test::write_file("g.xml", "<?xml version=\"1.0\"?>\n<scene>\n" + inside + "</scene>\n"),
      test::NoImages());
}

std::string triangle(const std::string& attributes = "") {
  return "<TriangleMesh" + attributes +
         "><positions>0 0 0 1 0 0 0 1 0</positions><triangles>0 1 2</triangles></TriangleMesh>\n";
}

TEST(EmbreeGraph, MeshesHaveTheirOwnNames) {
  const Scene scene = scene_of(triangle(" name=\"wing\"") + triangle());
  ASSERT_EQ(scene.shapes.size(), 2U);
  EXPECT_EQ(scene.shapes[0].name, "wing");
  EXPECT_EQ(scene.shapes[1].name, "TriangleMesh");
}

TEST(EmbreeGraph, CamerasLookFromTo) {
  const Scene scene = scene_of(
      triangle() + "<PerspectiveCamera from=\"1 2 3\" to=\"5 2 3\" up=\"0 0 2\" fov=\"60\"/>");
  const glm::dmat4& camera = scene.view.camera.world_from_camera;
  EXPECT_EQ(glm::dvec3(camera[3]), glm::dvec3(1, 2, 3));
  EXPECT_LT(glm::length(glm::dvec3(camera[2]) - glm::dvec3(1, 0, 0)), 1e-12);
  EXPECT_LT(glm::length(glm::dvec3(camera[1]) - glm::dvec3(0, 0, 1)), 1e-12);
  // The studio light is around this camera: x toward the viewer, y to its right, z up.
  ASSERT_EQ(scene.lights.size(), 1U);
  const glm::dmat3& light = std::get<InfiniteLight>(scene.lights[0].model).world_from_light;
  EXPECT_LT(glm::length(light[0] - glm::dvec3(-1, 0, 0)), 1e-12);
  EXPECT_LT(glm::length(light[1] - glm::dvec3(camera[0])), 1e-12);
  EXPECT_LT(glm::length(light[2] - glm::dvec3(0, 0, 1)), 1e-12);
}

// XML's comments and white space stand anywhere between elements, and say nothing.
// A quarter turn about z takes y to -x.
TEST(EmbreeGraph, LightsAndCamerasLieWithinTransforms) {
  const Scene scene =
      scene_of(triangle() +
               "<Transform><AffineSpace translate=\"1 2 3\"/>"
               "<PointLight><AffineSpace translate=\"1 0 0\"/><I>4 4 4</I></PointLight>"
               "<Transform><AffineSpace rotate_z=\"90\"/><PerspectiveCamera from=\"0 5 -9\" "
               "to=\"0 5 0\" up=\"0 1 0\" fov=\"60\"/></Transform></Transform>");
  ASSERT_EQ(scene.lights.size(), 1U);
  EXPECT_EQ(std::get<PointLight>(scene.lights[0].model).position, glm::dvec3(2, 2, 3));
  const glm::dmat4& camera = scene.view.camera.world_from_camera;
  EXPECT_LT(glm::length(glm::dvec3(camera[3]) - glm::dvec3(-4, 2, -6)), 1e-12);
  EXPECT_LT(glm::length(glm::dvec3(camera[1]) - glm::dvec3(-1, 0, 0)), 1e-12);
  EXPECT_LT(glm::length(glm::dvec3(camera[2]) - glm::dvec3(0, 0, 1)), 1e-12);
}

/// Returns the times and translations of a motion.
std::vector<std::pair<double, glm::dvec3>> path_of(const TransformKeys& keys) {
  std::vector<std::pair<double, glm::dvec3>> out;
  for (const TransformKey& key : keys) out.emplace_back(key.time, glm::dvec3(key.matrix[3]));
  return out;
}
using Path = std::vector<std::pair<double, glm::dvec3>>;

TEST(EmbreeMotion, TransformsAtTimeStepsAreEvenlyInASecond) {
  const Scene scene = scene_of(
      "<TransformAnimation><AffineSpace translate=\"1 0 0\"/>"
      "<AffineSpace translate=\"1 2 0\"/><AffineSpace translate=\"1 2 3\"/>" +
      triangle() + "</TransformAnimation>" + triangle());
  EXPECT_EQ(scene.shapes.size(), 1U);  // that rests
  ASSERT_EQ(scene.instances.size(), 1U);
  EXPECT_EQ(path_of(scene.instances[0].motion),
            (Path{{0, {1, 0, 0}}, {0.5, {1, 2, 0}}, {1, {1, 2, 3}}}));
  EXPECT_EQ(glm::dvec3(scene.instances[0].world_from_object[3]), glm::dvec3(1, 0, 0));
  EXPECT_EQ(scene.objects[0].shapes.size(), 1U);
}

// Within what rests, a motion is placed; within what moves, it has the keys of both.
TEST(EmbreeMotion, MotionsLieWithinEachOther) {
  const std::string inner =
      "<Transform><AffineSpace translate=\"0 0 1\"/><AffineSpace translate=\"0 0 5\"/>" +
      triangle() + "</Transform>";
  const auto within = [&](const std::string& places) {
    const Scene scene = scene_of("<Transform>" + places + inner + "</Transform>");
    return path_of(scene.instances.at(0).motion);
  };
  EXPECT_EQ(within("<AffineSpace scale=\"2 2 2\"/>"), (Path{{0, {0, 0, 2}}, {1, {0, 0, 10}}}));
  EXPECT_EQ(within("<AffineSpace translate=\"1 0 0\"/><AffineSpace translate=\"3 0 0\"/>"
                   "<AffineSpace translate=\"9 0 0\"/>"),
            (Path{{0, {1, 0, 1}}, {0.5, {3, 0, 3}}, {1, {9, 0, 5}}}));
  const Scene scene = scene_of(
      "<Transform><AffineSpace translate=\"1 0 0\"/><AffineSpace translate=\"3 0 0\"/>"
      "<Transform><AffineSpace scale=\"4 4 4\"/>" +
      triangle() + "</Transform></Transform>");
  EXPECT_EQ(path_of(scene.instances.at(0).motion), (Path{{0, {1, 0, 0}}, {1, {3, 0, 0}}}));
  EXPECT_EQ(scene.instances[0].motion[1].matrix[1], glm::dvec4(0, 4, 0, 0));
}

TEST(EmbreeMotion, ManyPlacesMoveEachByItself) {
  const auto array = [](const std::string& spaces) {
    return "<AffineSpaceArray>" + spaces + "</AffineSpaceArray>\n";
  };
  const std::string here = "<AffineSpace translate=\"0 0 0\"/>";
  const std::string there = "<AffineSpace translate=\"0 7 0\"/>";
  const Scene scene = scene_of("<MultiTransform>" + array(here + there) + array(there + there) +
                               triangle() + "</MultiTransform>");
  ASSERT_EQ(scene.instances.size(), 2U);
  EXPECT_EQ(path_of(scene.instances[0].motion), (Path{{0, {0, 0, 0}}, {1, {0, 7, 0}}}));
  EXPECT_EQ(path_of(scene.instances[1].motion), (Path{{0, {0, 7, 0}}, {1, {0, 7, 0}}}));
  EXPECT_THAT(complaint([&] {
                scene_of("<MultiTransform>" + array(here + there) + array(here) + triangle() +
                         "</MultiTransform>");
              }),
              HasSubstr("g.xml:4:2: has 1 transforms, the first time step 2"));
}

// 2,001 time steps, which 2,000 empty groups would each have.
TEST(EmbreeMotion, KeysAreBounded) {
  std::string text = "<Group id=\"none\"/><TransformAnimation>";
  for (int step = 0; step < 2001; ++step) text += "<AffineSpace translate=\"0 0 0\"/>";
  for (int i = 0; i < 2000; ++i) text += "<ref id=\"none\"/>";
  EXPECT_THAT(complaint([&] { scene_of(text + triangle() + "</TransformAnimation>"); }),
              HasSubstr("g.xml:3:2: what moves has more than 4000000 keys"));
}

TEST(EmbreeMotion, CamerasMove) {
  const auto camera = [](int x) {
    return "<PerspectiveCamera from=\"" + std::to_string(x) +
           " 0 9\" to=\"0 0 0\" up=\"0 1 0\" fov=\"60\"/>";
  };
  const Scene own = scene_of(triangle() + "<AnimatedPerspectiveCamera>" + camera(1) + camera(2) +
                             camera(4) + "</AnimatedPerspectiveCamera>");
  EXPECT_EQ(path_of(own.view.camera.motion),
            (Path{{0, {1, 0, 9}}, {0.5, {2, 0, 9}}, {1, {4, 0, 9}}}));
  EXPECT_FALSE(own.automatic_camera);
  const glm::dvec3 forward(own.view.camera.motion[2].matrix[2]);
  EXPECT_LT(glm::length(forward - glm::normalize(glm::dvec3(-4, 0, -9))), 1e-12);
  const Scene carried = scene_of(triangle() +
                                 "<Transform><AffineSpace translate=\"0 1 0\"/>"
                                 "<AffineSpace translate=\"0 3 0\"/>" +
                                 camera(1) + "</Transform>");
  EXPECT_EQ(path_of(carried.view.camera.motion), (Path{{0, {1, 1, 9}}, {1, {1, 3, 9}}}));
  EXPECT_EQ(glm::dvec3(carried.view.camera.world_from_camera[3]), glm::dvec3(1, 1, 9));
}

TEST(EmbreeGraph, CommentsAreNoElements) {
  const std::string c = "<!-- a comment -->\n";
  const Scene scene = scene_of(
      c + "<Transform>" + c + "<AffineSpace translate=\"1 2 3\"/>" + c + "<Group>" + c +
      triangle() + c + "</Group>" + c + "</Transform>" + "<MultiTransform>" + c +
      "<AffineSpaceArray>" + c + "<AffineSpace translate=\"4 5 6\"/>" + c + "</AffineSpaceArray>" +
      c + triangle() + "</MultiTransform><assign type=\"material\" id=\"red\">" + c + "<material>" +
      c + "<code>\"Matte\"</code>" + c + "<parameters>" + c +
      "<float3 name=\"reflectance\">1 0 0</float3>" + c + "</parameters></material></assign>" +
      "<assign type=\"scene\" id=\"t\">" + c + triangle() + "</assign><Animation>" + c +
      "<ref id=\"t\"/>" + c + "</Animation>" +
      "<Curves type=\"round\" basis=\"linear\"><animated_positions>" + c +
      "<positions>0 0 0 1 0 4 0 1</positions>" + c +
      "</animated_positions><indices>0</indices><material id=\"red\"/></Curves>");
  ASSERT_EQ(scene.shapes.size(), 4U);
  EXPECT_EQ(glm::dvec3(scene.shapes[0].world_from_object[3]), glm::dvec3(1, 2, 3));
  EXPECT_EQ(glm::dvec3(scene.shapes[1].world_from_object[3]), glm::dvec3(4, 5, 6));
  EXPECT_EQ(test::capsules_of(scene).p1, (std::vector<glm::vec3>{{0, 4, 0}}));
  EXPECT_EQ(
      std::get<RgbSpectrum>(
          std::get<DiffuseMaterial>(scene.materials.at(scene.shapes[3].material).model).reflectance)
          .rgb,
      glm::dvec3(1, 0, 0));
}

// The limit of docs/formats/embree.md, whatever the elements are.
TEST(EmbreeGraph, ElementsOfAnyKindLieWithin500Others) {
  for (const auto& [begin, end] :
       {std::pair("<Group>", "</Group>"),
        std::pair("<assign type=\"scene\" id=\"a\">", "</assign>"),
        std::pair("<Transform><AffineSpace scale=\"1 1 1\"/>", "</Transform>"),
        std::pair("<Animation>", "</Animation>")}) {
    const auto nested = [&, b = begin, e = end](int depth) {
      std::string text;
      for (int i = 0; i < depth; ++i) text += b;
      text += triangle();
      for (int i = 0; i < depth; ++i) text += e;
      return complaint([&] { scene_of(text); });
    };
    EXPECT_THAT(nested(600), HasSubstr("lies within 500 others")) << begin;
    EXPECT_THAT(nested(200), testing::Not(HasSubstr("others"))) << begin;
  }
}

}  // namespace
}  // namespace caplet
