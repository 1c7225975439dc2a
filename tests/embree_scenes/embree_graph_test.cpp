// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Embree's XML scenes: names, and elements within each other.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

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
