// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Lights that name files: images over areas, directions and skies, and photometric files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "import/detail/ies.h"
#include "import_text.h"

namespace caplet::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using std::numbers::pi;

class LightFiles : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"square.exr", "wide.exr", "odd.exr"}) write_file(folder_ / name, "");
  }
  std::string text(const std::string& world) const {
    std::string out = "WorldBegin\n" + world + "\nShape \"sphere\"";
    for (std::size_t at; (at = out.find('@')) != std::string::npos;)
      out.replace(at, 1, folder_.string() + "/");
    return out;
  }
  Scene read(const std::string& world) const { return scene_of(text(world)); }
  std::vector<std::string> complain(const std::string& world) const {
    return complaints(text(world));
  }

  std::filesystem::path folder_ = temporary_folder();
};

TEST_F(LightFiles, GoniometricStandsWhereItsTransformPutsIt) {
  const Scene scene = read(
      "Translate 1 2 3 Rotate 90 0 0 1 Scale 2 2 2\n"
      "LightSource \"goniometric\" \"string filename\" \"@square.exr\" \"float scale\" 4 \"float "
      "power\" 60 \"rgb I\" [1 2 3]");
  const Light& light = scene.lights.at(0);
  const auto& model = std::get<GoniometricLight>(light.model);
  EXPECT_EQ(model.image->width, 4);
  EXPECT_EQ(light.scale, 4);
  EXPECT_EQ(light.power, 60);
  EXPECT_EQ(model.position, glm::dvec3(1, 2, 3));
  EXPECT_NEAR(glm::length(model.world_from_light[0] - glm::dvec3(0, 1, 0)), 0, 1e-12);
  EXPECT_EQ(std::get<RgbSpectrum>(model.intensity).rgb, glm::dvec3(1, 2, 3));
}

TEST_F(LightFiles, ProjectionHasItsFieldOfView) {
  const Scene scene = read(
      "LightSource \"projection\" \"string filename\" \"@wide.exr\" \"float fov\" 40\nLightSource "
      "\"projection\" \"string "
      "filename\" \"@wide.exr\"");
  const auto &first = std::get<ProjectionLight>(scene.lights.at(0).model),
             &second = std::get<ProjectionLight>(scene.lights.at(1).model);
  EXPECT_EQ(first.fov, 40);
  EXPECT_EQ(second.fov, 90);
  EXPECT_EQ(first.image, second.image);  // read once
  // The field of view is that of the shorter side.
  EXPECT_NEAR(second.half_height(), 1, 1e-12);
  EXPECT_NEAR(second.half_width(), 2, 1e-12);
  // The picture fills as much as the four triangles between its corners.
  EXPECT_NEAR(second.reach().solid_angle, 4 * std::asin(2 / std::sqrt(10.0)), 1e-12);
}

TEST_F(LightFiles, AreasAndSkiesShareAnImage) {
  const Scene scene = read(
      "AreaLightSource \"diffuse\" \"string filename\" \"@square.exr\" \"float power\" 3 \"bool "
      "twosided\" true\n"
      "LightSource \"infinite\" \"string filename\" \"@square.exr\" \"point3 portal\" [0 0 2  0 1 "
      "2  1 1 2  1 0 2] \"float "
      "illuminance\" 5\n"
      "LightSource \"infinite\" \"string filename\" \"@wide.exr\"");
  const AreaEmission& emission = *scene.shapes.at(0).emission;
  const auto& sky = std::get<InfiniteLight>(scene.lights.at(0).model);
  ASSERT_TRUE(emission.image);
  EXPECT_EQ(emission.image, sky.image);
  EXPECT_EQ(emission.power, 3);
  EXPECT_TRUE(emission.two_sided);
  ASSERT_TRUE(sky.portal);
  EXPECT_EQ((*sky.portal)[2], glm::dvec3(1, 1, 2));
  EXPECT_EQ(scene.lights.at(0).illuminance, 5);
  EXPECT_FALSE(std::get<InfiniteLight>(scene.lights.at(1).model).portal);
}

TEST_F(LightFiles, WhatIsWrongHasItsPlace) {
  const std::string at = folder_.string() + "/";
  const auto only = [&](const std::string& world) { return complain(world).front(); };
  EXPECT_EQ(only("LightSource \"goniometric\""),
            "scene.pbrt:2:1: LightSource \"goniometric\": \"string filename\" is missing");
  EXPECT_EQ(only("LightSource \"projection\" \"string filename\" \"@none.exr\""),
            "scene.pbrt:2:26: LightSource \"projection\": \"filename\" no such file \"" + at +
                "none.exr\"");
  EXPECT_EQ(only("LightSource \"goniometric\" \"string filename\" \"@wide.exr\""),
            "scene.pbrt:2:27: LightSource \"goniometric\": \"filename\" " + at +
                "wide.exr is 4 x 2 pixels, and not square (equal-area)");
  EXPECT_EQ(
      only("LightSource \"projection\" \"string filename\" \"@wide.exr\" \"float fov\" 180"),
      "scene.pbrt:2:" +
          std::to_string(
              std::string("LightSource \"projection\" \"string filename\" \"wide.exr\" ").size() +
              at.size() + 1) +
          ": LightSource \"projection\": \"fov\" must lie between 0.001 and 179.999");
  EXPECT_THAT(
      only("LightSource \"projection\" \"string filename\" \"@wide.exr\" \"float scale\" -1"),
      HasSubstr("\"scale\" must not be negative"));
  EXPECT_THAT(only("Scale 1 2 1 LightSource \"goniometric\" \"string filename\" \"@square.exr\""),
              HasSubstr("the light cannot be sheared or scaled unevenly"));
  EXPECT_THAT(
      only("AreaLightSource \"diffuse\" \"string filename\" \"@square.exr\" \"rgb L\" [1 1 1]"),
      HasSubstr("\"filename\" cannot be combined with \"L\""));
  EXPECT_EQ(only("LightSource \"infinite\" \"point3 portal\" [0 0 2  0 1 2  1 1 2]"),
            "scene.pbrt:2:24: LightSource \"infinite\": \"portal\" must be four points");
  EXPECT_EQ(only("LightSource \"infinite\" \"point3 portal\" [0 0 2  0 1 2  1 1 2  1 0 3]"),
            "scene.pbrt:2:1: the portal's corners are not those of a rectangle, in order");
  EXPECT_EQ(only("LightSource \"infinite\" \"point3 portal\" [0 0 2  1 1 2  1 0 2  0 1 2]"),
            "scene.pbrt:2:1: the portal's corners are not those of a rectangle, in order");
  EXPECT_EQ(only("LightSource \"infinite\" \"point3 portal\" [0 0 2  0 0 2  1 1 2  1 0 2]"),
            "scene.pbrt:2:1: the portal has two corners in one place");
  EXPECT_EQ(only("LightSource \"ies\" \"string filename\" \"@square.exr\""),
            "scene.pbrt:2:19: LightSource \"ies\": \"filename\" " + at +
                "square.exr: no line begins with TILT=: this is no photometric file of LM-63");
}

// --- Photometric files ---

std::string ies(const std::string& polar, const std::string& azimuths, const std::string& values,
                const std::string& factors = "2 1", const std::string& first = "IESNA:LM-63-2002") {
  const auto count = [](const std::string& list) {
    return std::to_string(std::count(list.begin(), list.end(), ' ') + 1);
  };
  const std::size_t blank = factors.find(' ');
  return first + "\n[TEST] none\n[MANUFAC] nobody\nTILT=NONE\n1 1000 " + factors.substr(0, blank) +
         " " + count(polar) + " " + count(azimuths) + " 1 2 0 0 0\n" + factors.substr(blank + 1) +
         " 3 50\n" + polar + "\n" + azimuths + "\n" + values + "\n";
}

TEST(Ies, NumbersAreTimesTheirFactors) {
  const IesProfile found = parse_ies("a.ies", ies("0 45 90", "0", "10 20,\t5", "2 0.5"));
  EXPECT_THAT(found.polar, ElementsAre(0, pi / 4, pi / 2));
  EXPECT_THAT(found.azimuths, ElementsAre(0));
  EXPECT_THAT(found.candela, ElementsAre(10, 20, 5));
  // The old forms have a third factor where later ones have another number.
  for (const char* old : {"IESNA:LM-63-1986", "IESNA91", "LAMP OF 1986"})
    EXPECT_THAT(parse_ies("a.ies", ies("0 45 90", "0", "10 20 5", "2 0.5", old)).candela,
                ElementsAre(30, 60, 15))
        << old;
}

TEST(Ies, SymmetryIsFilledIn) {
  const auto of = [](const std::string& azimuths, const std::string& values) {
    return parse_ies("a.ies", ies("0 90", azimuths, values, "1 1"));
  };
  const IesProfile quarter = of("0 30 90", "1 1 2 2 3 3");
  EXPECT_EQ(quarter.azimuths.size(), 9u);  // 0 30 90 150 180 210 270 330 360
  EXPECT_NEAR(quarter.azimuths[5], 210 * pi / 180, 1e-12);
  EXPECT_THAT(quarter.candela, ElementsAre(1, 1, 2, 2, 3, 3, 2, 2, 1, 1, 2, 2, 3, 3, 2, 2, 1, 1));
  const IesProfile half = of("0 60 180", "1 1 2 2 3 3");
  EXPECT_THAT(half.candela, ElementsAre(1, 1, 2, 2, 3, 3, 2, 2, 1, 1));
  const IesProfile whole = of("0 100 360", "1 1 2 2 1 1");
  EXPECT_THAT(whole.candela, ElementsAre(1, 1, 2, 2, 1, 1));
  const IesProfile turned = of("90 180 200 270", "1 1 2 2 3 3 4 4");
  // 0 (as 180), 90, 180, 200, 270, 340 (as 200), 360
  EXPECT_NEAR(turned.azimuths[5], 340 * pi / 180, 1e-12);
  EXPECT_THAT(turned.candela, ElementsAre(2, 2, 1, 1, 2, 2, 3, 3, 4, 4, 3, 3, 2, 2));
  // Between 300 (as 240) and 60 (as 120).
  const IesProfile seam = of("90 120 240 270", "1 1 5 5 3 3 4 4");
  EXPECT_THAT(std::vector<double>(seam.candela.begin(), seam.candela.begin() + 2),
              ElementsAre(testing::DoubleNear(4, 1e-12), testing::DoubleNear(4, 1e-12)));
}

TEST(Ies, WhatIsWrongHasItsPlace) {
  const auto complaint = [](const std::string& text) {
    return complaint_of([&] { parse_ies("a.ies", text); });
  };
  const std::string good = ies("0 45 90", "0", "10 20 5");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return complaint(text.replace(at, from.size(), to));
  };
  EXPECT_EQ(complaint(good), "");
  EXPECT_EQ(complaint(""),
            "a.ies: no line begins with TILT=: this is no photometric file of LM-63");
  EXPECT_EQ(with("TILT=NONE", "TILT=INCLUDE"), "a.ies:4:1: TILT=INCLUDE: only TILT=NONE is read");
  EXPECT_EQ(with("1 1000 2", "1 1000 x"), "a.ies:5:8: the candela multiplier: 'x' is not a number");
  EXPECT_EQ(with("1 1000 2", "1 1000 0"), "a.ies:5:8: the candela multiplier must be above 0");
  EXPECT_EQ(with("2 3 1 1", "2 1 1 1"),
            "a.ies:5:10: the number of vertical angles must be a whole number from 2 up");
  EXPECT_EQ(with("2 3 1 1", "2 3 1 2"), "a.ies:5:14: only photometry of type C (1) is read");
  EXPECT_EQ(with("2 3 1 1", "2 3 1e6 1"),
            "a.ies:9:7: a horizontal angle must be above the one before");
  EXPECT_EQ(with("0 45 90", "0 95 90"), "a.ies:7:6: a vertical angle must be above the one before");
  EXPECT_EQ(with("0 45 90", "0 45 190"), "a.ies:7:6: a vertical angle must lie between 0 and 180");
  EXPECT_EQ(
      with("90\n0\n", "90\n5\n"),
      "a.ies:8:1: the horizontal angles must go from 0 to 0, 90, 180 or 360, or from 90 to 270");
  EXPECT_EQ(with("10 20 5", "10 -20 5"), "a.ies:9:4: an intensity must not be negative");
  EXPECT_EQ(with("10 20 5", "10 20 nan"), "a.ies:9:7: an intensity: 'nan' is not finite");
  EXPECT_EQ(with("10 20 5", "10 20 5 6"), "a.ies:9:9: '6' after the last intensity");
  EXPECT_EQ(with("10 20 5", "10 20"), "a.ies:9:4: the file ends where an intensity should be");
}

}  // namespace
}  // namespace caplet::test
