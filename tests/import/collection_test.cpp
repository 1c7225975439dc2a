// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What the texts of pbrt-v4's own scene collection say in ways that pbrt-v4 takes and a stricter
// reader would not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/mat3x3.hpp>
#include <sstream>

#include "import_text.h"
#include "scene/lights/infinite.h"
#include "scene/media/uniformgrid.h"
#include "support/log_of.h"

namespace caplet::test {
namespace {

using testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;

double radius_of(const Scene& scene, std::size_t shape = 0) {
  return std::get<SphereShape>(scene.shapes.at(shape).geometry).radius;
}

/// How many lines say this.
int lines_with(const std::string& log, const std::string& words) {
  std::istringstream lines(log);
  int count = 0;
  for (std::string line; std::getline(lines, line);) count += line.find(words) != std::string::npos;
  return count;
}

// --- Materials (watercolor) ---

TEST(UndefinedMaterials, OfNoShapeAreOneWarning) {
  LogOf log;
  const Scene scene = world_of(
      "NamedMaterial \"BG\"\nNamedMaterial \"sky\"\nMaterial \"diffuse\"\nShape \"sphere\"\n");
  EXPECT_EQ(scene.shapes.size(), 1u);
  EXPECT_EQ(lines_with(log.text(), "is not defined"), 1);
  EXPECT_THAT(log.text(), HasSubstr("scene.pbrt:3:15: the material \"BG\" is not defined (no shape "
                                    "has it) (and 1 more of this kind)"));
}

TEST(UndefinedMaterials, OfShapesAreErrors) {
  EXPECT_THAT(complaints("WorldBegin\nNamedMaterial \"BG\"\nShape \"sphere\"\n"),
              ElementsAre("scene.pbrt:2:15: the material \"BG\" is not defined"));
  EXPECT_THAT(complaints("WorldBegin\nObjectBegin \"o\" NamedMaterial \"BG\" Shape \"sphere\" "
                         "ObjectEnd Shape \"sphere\"\n"),
              ElementsAre("scene.pbrt:2:31: the material \"BG\" is not defined"));
  EXPECT_THAT(complaints("WorldBegin\nShape \"box\" \"point3 p0\" [0 0 0] \"point3 p1\" [1 1 1] "
                         "\"string materials\" [\"a\" \"a\" \"a\" \"a\" \"a\" "
                         "\"BG\"]\nMakeNamedMaterial \"a\" \"string type\" \"diffuse\""),
              ElementsAre(HasSubstr("the material \"BG\" is not defined")));
}

// --- Parameters ---

TEST(GivenTwice, TheLastCounts) {
  LogOf log;
  const Scene scene = world_of(
      "Shape \"sphere\" \"float radius\" 1 \"float radius\" 2 \"float radius\" [3]\nShape "
      "\"sphere\" \"float radius\" 1 "
      "\"float radius\" 5\n");
  EXPECT_EQ(radius_of(scene), 3);
  EXPECT_EQ(radius_of(scene, 1), 5);
  EXPECT_EQ(lines_with(log.text(), "given twice"), 1);
  EXPECT_THAT(log.text(),
              HasSubstr("the parameter \"radius\" is given twice (first at scene.pbrt:3:"));
  EXPECT_THAT(log.text(), HasSubstr("): this one counts (and 1 more of this kind)"));
}

TEST(GivenTwice, AmongManyAndInAttributes) {
  std::string many = "Shape \"sphere\" \"float radius\" 1";
  for (int i = 0; i < 100; ++i) many += " \"float radius\" " + std::to_string(i + 2);
  LogOf log;
  EXPECT_EQ(radius_of(world_of(many)), 101);
  EXPECT_EQ(radius_of(world_of(
                "Attribute \"shape\" \"float radius\" 1 \"float radius\" 7\nShape \"sphere\"")),
            7);
}

TEST(GivenTwice, OfTwoTypesIsAnError) {
  EXPECT_THAT(complaints("WorldBegin\nShape \"sphere\" \"float radius\" 1 \"integer radius\" 2"),
              ElementsAre("scene.pbrt:2:33: the parameter \"radius\" is given twice (first at "
                          "scene.pbrt:2:16), as float and as integer"));
}

// bunny-fur: " float beta_n".
TEST(Declarations, MayHaveBlanksAround) {
  EXPECT_EQ(radius_of(world_of("Shape \"sphere\" \" float\t  radius \" 4")), 4);
}

// --- Statements that an included file begins (smoke-plume) ---

constexpr const char* grid_begun =
    "MakeNamedMedium \"smoke\" \"string type\" \"uniformgrid\" \"integer nx\" 2 \"integer ny\" 1 "
    "\"integer nz\" 1\n"
    "  \"float density\" [ 0.25 0.5 ] # and no more\n";
constexpr const char* grid_goes_on =
    "  \"spectrum sigma_a\" [300 20 830 20]\n  \"spectrum sigma_s\" [300 160 830 160]\n"
    "MediumInterface \"smoke\" \"\"\nMaterial \"interface\"\nShape \"sphere\" \"float radius\" 3\n";

double first_value(const Spectrum& spectrum) {
  return std::get<SampledSpectrum>(spectrum).values.at(0);
}

TEST(Include, StatementsGoOnBehindIt) {
  const auto folder = temporary_folder();
  std::filesystem::create_directories(folder / "geometry");
  write_file(folder / "geometry" / "outer.pbrt", "Include \"geometry/density.pbrt\"");
  write_file(folder / "geometry" / "density.pbrt", grid_begun);
  for (const char* name : {"density", "outer"}) {
    write_file(folder / "main.pbrt",
               "WorldBegin\nInclude \"geometry/" + std::string(name) + ".pbrt\"\n" + grid_goes_on);
    const Scene scene = import_scene(folder / "main.pbrt", StubImages());
    ASSERT_EQ(scene.media.size(), 1u);
    const auto& grid = std::get<UniformGridMedium>(scene.media[0].model);
    EXPECT_THAT(*grid.density, ElementsAre(0.25f, 0.5f));
    EXPECT_EQ(first_value(grid.scattering.sigma_a), 20);
    EXPECT_EQ(first_value(grid.scattering.sigma_s), 160);
    EXPECT_EQ(radius_of(scene), 3);
  }
}

TEST(Include, WhatGoesOnHasItsOwnPlace) {
  const auto folder = temporary_folder();
  write_file(folder / "begun.pbrt", "Shape \"sphere\" \"float radius\" 2");
  const auto said_of = [&](const std::string& behind, const char* directive = "Include") {
    write_file(folder / "main.pbrt",
               "WorldBegin\n" + std::string(directive) + " \"begun.pbrt\"\n" + behind);
    return complaint_of([&] { import_scene(folder / "main.pbrt", StubImages()); });
  };
  EXPECT_THAT(said_of("\"float radios\" 2"),
              HasSubstr("main.pbrt:3:1: Shape \"sphere\": unknown parameter \"radios\""));
  EXPECT_THAT(said_of("\"float zmin\" [ -1 \n"),
              HasSubstr("main.pbrt:3:14: this bracket is never closed"));
  EXPECT_THAT(said_of("\"float zmin\n"),
              HasSubstr("main.pbrt:3:1: this string is not closed on its line"));
  EXPECT_EQ(said_of("\"float zmin\" -1\nShape \"sphere\"\n"), "");
  // An Import is a file by itself.
  EXPECT_THAT(said_of("\"float zmin\" -1\n", "Import"),
              HasSubstr("main.pbrt:3:1: expected a directive, found the string"));
}

// --- Transforms of lights (sssdragon) ---

constexpr const char* skewed =
    "ConcatTransform [ -0.224951 0 -0.97437 0  -0.97437 0 0.224951 0  0 1 0 8.87  0 0 0 1 ]\n";  // 8.87 is in the last row

TEST(NotAffine, LightsWithoutAPlaceAreTurned) {
  const auto folder = temporary_folder();
  write_file(folder / "square.exr", "");
  const Scene scene =
      world_of(std::string("AttributeBegin\n") + skewed +
               "ConcatTransform [ 0 0 -1 0 1 0 0 0 0 1 0 0 0 0 0 1 ]\nLightSource \"infinite\" "
               "\"string filename\" \"" +
               (folder / "square.exr").string() + "\"\nAttributeEnd\nShape \"sphere\"\n");
  const glm::dmat3& turned = std::get<InfiniteLight>(scene.lights.at(0).model).world_from_light;
  // The second takes x to -z, y to x, z to y; the first these to its columns.
  const glm::dmat3 expected(0, -1, 0, -0.224951, 0, -0.97437, -0.97437, 0, 0.224951);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(turned[i][j], expected[i][j], 1e-14) << i << " " << j;  // two inverses, rounded
}

TEST(NotAffine, NothingElseStandsThere) {
  const std::string place =
      "scene.pbrt:2:1: ConcatTransform is not affine (its last row must be 0 0 0 1)";
  for (const char* what :
       {"Shape \"sphere\"", "LightSource \"point\"", "LightSource \"distant\"",
        "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"square.png\"",
        "MakeNamedMedium \"m\" \"string type\" \"homogeneous\"", "CoordinateSystem \"c\""})
    EXPECT_THAT(
        complaints(std::string("WorldBegin\n") + skewed + what + "\nIdentity Shape \"sphere\"\n"),
        ElementsAre(place))
        << what;
  EXPECT_THAT(complaints(std::string("WorldBegin\nAttributeBegin ") + skewed +
                         "AttributeEnd\nShape \"sphere\"\n"),
              IsEmpty());
  EXPECT_THAT(complaints(std::string("WorldBegin\n") + skewed +
                         "CoordSysTransform \"world\" Shape \"sphere\"\n"),
              IsEmpty());
}

}  // namespace
}  // namespace caplet::test
