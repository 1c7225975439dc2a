// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Which medium a point is in (docs/media.md): ways through absorbing solids have known lengths.
#include <gtest/gtest.h>

#include <cmath>

#include "media_scenes.h"

namespace caplet::test {
namespace {

constexpr double near = 2e-4;

TEST(Nesting, InnerSolidsTakeThePlaceOfOuterOnesInAnyOrderOfTheFile) {
  const std::string outer = sphere(0, 2, "a"), inner = sphere(0.5, 1, "b", "a");
  EXPECT_NEAR(lost(-9, outer + inner), 2 * 0.3 + 2 * 0.5, near);
  EXPECT_NEAR(lost(-9, inner + outer), 2 * 0.3 + 2 * 0.5, near);
  // A solid without a medium of its own is no place of its own.
  EXPECT_NEAR(
      lost(-9,
           outer +
               "Material \"dielectric\" \"float eta\" 1 Shape \"sphere\" \"float radius\" 0.5\n"),
      4 * 0.3, near);
  // One of nothing is.
  EXPECT_NEAR(lost(-9, outer + sphere(0, 0.5, "", "a")), 3 * 0.3, near);
}

TEST(Nesting, TheCameraMayBeWithin) {
  const std::string both = sphere(0, 2, "a") + sphere(0.5, 1, "b", "a");
  EXPECT_NEAR(lost(0, both), 1.5 * 0.5 + 0.5 * 0.3, near);
  EXPECT_NEAR(lost(-1, both), 0.5 * 0.3 + 2 * 0.5 + 0.5 * 0.3, near);
  // Whatever it says of itself.
  EXPECT_NEAR(lost(0, both, "MediumInterface \"\" \"c\"\n"), 1.5 * 0.5 + 0.5 * 0.3, near);
  // Where nothing holds it that counts, until something does.
  EXPECT_NEAR(lost(-5, both, "MediumInterface \"\" \"c\"\n"), 3 * 0.9 + 2 * 0.3 + 2 * 0.5, near);
  // A lens has a place for each ray.
  EXPECT_NEAR(lost(0, both, "", "\"float lensradius\" 0.001 \"float focaldistance\" 10"),
              1.5 * 0.5 + 0.5 * 0.3, 1e-3);
}

TEST(Nesting, WhereSolidsOverlapTheSmallerOneCounts) {
  const std::string both = sphere(-0.5, 1, "a") + sphere(0.5, 0.8, "c");
  const double expected = 1.2 * 0.3 + 1.6 * 0.9;
  EXPECT_NEAR(lost(-9, both), expected, near);
  EXPECT_NEAR(lost(-9, sphere(0.5, 1, "a") + sphere(-0.5, 0.8, "c")), expected, near);
}

// More than a ray tells apart: the largest come again as they are left.
TEST(Nesting, OfSixSolidsTheLargestAreForgottenUntilTheyAreLeft) {
  const std::string all = sphere(0, 6, "a") + sphere(0, 5, "b") + sphere(0, 4, "c") +
                          sphere(0, 3, "a") + sphere(0, 2, "b") + sphere(0, 1, "c");
  EXPECT_NEAR(lost(-9, all), 2 * (0.3 + 0.5 + 0.9 + 0.3 + 0.5 + 0.9), near);
}

TEST(Nesting, CapsulesOfOneMediumAreOnePlace) {
  const std::string chain =
      "MediumInterface \"b\" \"\" Shape \"capsule\" \"point3 p0\" [0 0 -1] \"point3 p1\" [0 0 0] "
      "\"float radius\" 0.3\n"
      "Shape \"capsule\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 0 1.5] \"float radius\" 0.3\n"
      "Shape \"capsule\" \"point3 p0\" [0 0 0.2] \"point3 p1\" [0 0 0.3] \"float radius\" 0.5\n";
  EXPECT_NEAR(lost(-9, chain), 0.5 * 3.1, near);
  EXPECT_NEAR(lost(0, chain), 0.5 * 1.8, near);
}

// Mirrors of triangles whose vertices have the normal (2 0 -1): of a ray along +z they make (0.8 0
// 0.6), beneath the surface. Where the mesh is open, the ray goes there, and is in what the mesh
// holds, which lets no light through to infinity. A closed one turns it back, and it stays outside.
TEST(Nesting, MirroredRaysAreOnTheSideThatTheyGoTo) {
  const std::string mirror =
      "Material \"conductor\" \"spectrum eta\" [300 1 900 1] \"spectrum k\" [300 100 900 "
      "100]\nMediumInterface \"b\" \"\"\n";
  const std::string sheet =
      "Shape \"trianglemesh\" \"point3 P\" [-5 -5 0 -5 5 0 5 5 0 5 -5 0] \"normal N\" [2 0 -1 2 0 "
      "-1 2 0 -1 2 0 -1] \"integer "
      "indices\" [0 1 2 0 2 3]\n";
  EXPECT_GT(lost(-9, mirror + sheet), 20);
  EXPECT_NEAR(lost(-9, mirror.substr(0, mirror.find("MediumInterface")) + sheet), 0, 1e-3);
  std::string normals;
  for (int i = 0; i < 8; ++i) normals += " 2 0 -1";
  const std::string cube =
      "Shape \"trianglemesh\" \"point3 P\" [-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1 -1 -1 1 1 -1 1 1 1 1 "
      "-1 1 1] \"normal N\" [" +
      normals +
      "] \"integer indices\" [0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 1 2 6 1 6 5 2 3 7 2 7 6 3 0 4 3 "
      "4 7]\n";
  EXPECT_NEAR(lost(-9, white_walls() + "Translate 0.1 0.2 0\n" + mirror + cube), 0, 1e-3);
}

TEST(Nesting, MeshesHoldMediaByTheirNormals) {
  const std::string points =
      "\"point3 P\" [-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1 -1 -1 1 1 -1 1 1 1 1 -1 1 1]";
  const std::string mesh = "MediumInterface \"b\" \"\" Shape \"trianglemesh\" " + points +
                           " \"integer indices\" [0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 1 2 6 1 6 5 "
                           "2 3 7 2 7 6 3 0 4 3 4 7]\n";
  const std::string at = "Translate 0.1 0.2 0\n";
  EXPECT_NEAR(lost(-9, at + mesh), 2 * 0.5, near);
  EXPECT_NEAR(lost(0, at + mesh), 0.5, near);
  EXPECT_NEAR(lost(-9, at + "ReverseOrientation MediumInterface \"\" \"b\" " +
                           mesh.substr(mesh.find("Shape"))),
              2 * 0.5, near);
  // Several surfaces together.
  const std::string sides =
      "MediumInterface \"b\" \"\"\nShape \"trianglemesh\" " + points +
      " \"integer indices\" [0 2 1 0 3 2]\nShape \"trianglemesh\" " + points +
      " \"integer indices\" [4 5 6 4 6 7]\nShape \"trianglemesh\" " + points +
      " \"integer indices\" [0 1 5 0 5 4 1 2 6 1 6 5 2 3 7 2 7 6 3 0 4 3 4 7]\n";
  EXPECT_NEAR(lost(-9, at + sides), 2 * 0.5, near);
}

// The window of a room: what goes in is within until it comes out again, or is stopped by a wall.
TEST(Nesting, OneOpenSurfaceLetsIn) {
  const std::string window =
      "AttributeBegin ReverseOrientation Material \"interface\" MediumInterface \"b\" \"\" Shape "
      "\"disk\" \"float height\" -1 "
      "AttributeEnd\n";
  const std::string wall =
      "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0 0 0] AreaLightSource \"diffuse\" "
      "\"rgb L\" [1 1 1] \"bool "
      "twosided\" true Shape \"disk\" \"float height\" 2 AttributeEnd\n";
  EXPECT_NEAR(lost(-9, window + wall), 0.5 * 3, near);
  EXPECT_NEAR(lost(-9, window + sphere(0, 0.5, "c", "b") + wall), 0.5 * 2 + 0.9 * 1, near);
  EXPECT_NEAR(lost(0, window + wall), 0, near);
  EXPECT_NEAR(lost(-9, "Translate 3 0 0\n" + window + "Translate -3 0 0\n" + wall), 0,
              near);  // beside it
}

TEST(Nesting, EveryClosedSolidHoldsAMedium) {
  const std::string in = "MediumInterface \"b\" \"\" ";
  EXPECT_NEAR(lost(-9, in + "Shape \"cylinder\" \"point3 p0\" [0 0 -1] \"point3 p1\" [0 0 1] "
                            "\"float radius\" 1\n"),
              1, near);
  EXPECT_NEAR(lost(0, in + "Shape \"cone\" \"point3 p0\" [0 0 -1] \"point3 p1\" [0 0 1] \"float "
                           "radius\" [1 0.5]\n"),
              0.5, near);
  EXPECT_NEAR(lost(-9, "MediumInterface \"\" \"b\" ReverseOrientation Shape \"sphere\"\n"), 1,
              near);
  EXPECT_NEAR(
      lost(-9,
           "ObjectBegin \"o\" " + in +
               "Shape \"sphere\" ObjectEnd\nTranslate 0 0 1 Scale 1 2 1.5 ObjectInstance \"o\"\n"),
      1.5, near);
  const std::string csg =
      "ObjectBegin \"s\" Shape \"sphere\" ObjectEnd ObjectBegin \"t\" Translate 0 0 0.5 Shape "
      "\"sphere\" \"float radius\" 0.25 "
      "ObjectEnd\n";
  EXPECT_NEAR(lost(-9, csg + in +
                           "Shape \"csg\" \"string operands\" [\"s\" \"t\"] \"string operation\" "
                           "\"difference\"\n"),
              0.75, near);
}

}  // namespace
}  // namespace caplet::test
