// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Media of pbrt's text, and what is wrong with them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "import_text.h"
#include "scene/media/subsurface.h"
#include "support/log_of.h"

namespace caplet::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string fog = "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"";

std::vector<std::string> said(const std::string& text) { return complaints("WorldBegin\n" + text); }

template <class Type>
const Type& medium_of(const Scene& scene, std::size_t i = 0) {
  return std::get<Type>(scene.media.at(i).model);
}

TEST(Media, Homogeneous) {
  const Scene scene = scene_of(
      "MediumInterface \"\" \"air\"\nCamera \"perspective\"\nWorldBegin\n"
      "MakeNamedMedium \"unused\" \"string type\" \"homogeneous\"\n"
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 2 3] \"spectrum "
      "sigma_s\" [400 1 700 2] "
      "\"float scale\" 10 \"float g\" -0.5 "
      "\"rgb Le\" [1 0 0] \"float Lescale\" 4\n"
      "MakeNamedMedium \"air\" \"string type\" \"homogeneous\"\nMakeNamedMedium \"tea\" \"string "
      "type\" \"homogeneous\" \"string "
      "preset\" \"Lemon Tea Powder\"\n"
      "MediumInterface \"fog\" \"air\" Shape \"sphere\"\nMediumInterface \"tea\" Shape "
      "\"sphere\"\n");
  ASSERT_EQ(scene.media.size(), 3u);
  EXPECT_EQ(scene.media[*scene.view.camera.medium].name, "air");
  const auto& m = medium_of<HomogeneousMedium>(scene, *scene.shapes[0].media.inside);
  EXPECT_EQ(std::get<RgbSpectrum>(m.scattering.sigma_a).rgb, glm::dvec3(1, 2, 3));
  EXPECT_TRUE(std::holds_alternative<SampledSpectrum>(m.scattering.sigma_s));
  EXPECT_EQ(m.scattering.scale, 10);
  EXPECT_EQ(m.scattering.g, -0.5);
  EXPECT_EQ(m.radiance_scale, 4);
  EXPECT_TRUE(m.radiance.has_value());
  EXPECT_EQ(scene.media[*scene.shapes[0].media.outside].name, "air");
  // One name is on both sides.
  EXPECT_FALSE(scene.shapes[1].media.differ());
  const auto& tea = medium_of<HomogeneousMedium>(scene, *scene.shapes[1].media.inside);
  EXPECT_EQ(std::get<RgbSpectrum>(tea.scattering.sigma_a).rgb, glm::dvec3(2.4288, 4.5757, 7.2127));
  EXPECT_EQ(std::get<RgbSpectrum>(tea.scattering.sigma_s).rgb,
            glm::dvec3(0.040224, 0.045264, 0.051081));
  // pbrt-v4's own without parameters: milk.
  const auto& air = medium_of<HomogeneousMedium>(scene, *scene.view.camera.medium);
  EXPECT_EQ(std::get<RgbSpectrum>(air.scattering.sigma_s).rgb, glm::dvec3(2.55, 3.21, 3.77));
  EXPECT_FALSE(air.radiance.has_value());
}

TEST(Media, AttributesOfThemAreTheirs) {
  const Scene scene = world_of("Attribute \"medium\" \"float g\" 0.25\n" + fog +
                               "\nMediumInterface \"fog\" \"\" Shape \"sphere\"");
  EXPECT_EQ(medium_of<HomogeneousMedium>(scene).scattering.g, 0.25);
}

TEST(Media, SurfacesThatPartThemStay) {
  const Scene scene = world_of(
      fog +
      "\nAttributeBegin MediumInterface \"fog\" \"\" Material \"interface\" Shape \"sphere\" "
      "AttributeEnd\nMaterial \"\" Shape \"sphere\" "
      "Material \"none\" Shape \"sphere\" \"float radius\" 3");
  ASSERT_EQ(scene.shapes.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<InterfaceMaterial>(
      scene.materials.at(scene.shapes[0].material).model));
}

TEST(Media, WhatIsWrongHasItsPlace) {
  const auto medium = [](const std::string& rest) {
    return said("MakeNamedMedium \"m\" " + rest + "\nMediumInterface \"m\" \"\"\nShape \"sphere\"");
  };
  EXPECT_THAT(
      said("MediumInterface \"fgo\" \"\"\n" + fog + "\nShape \"sphere\""),
      ElementsAre(
          "scene.pbrt:2:17: the medium \"fgo\" is not defined; the nearest known name is \"fog\""));
  EXPECT_THAT(
      said(fog + "\n" + fog + "\nShape \"sphere\""),
      ElementsAre(HasSubstr(
          "scene.pbrt:3:1: the medium \"fog\" is defined twice (first at scene.pbrt:2:1)")));
  EXPECT_THAT(
      medium(""),
      ElementsAre(HasSubstr("scene.pbrt:2:1: MakeNamedMedium \"m\": \"string type\" is missing")));
  EXPECT_THAT(medium("\"string type\" \"homogenous\""),
              ElementsAre(HasSubstr("scene.pbrt:2:21: unknown MakeNamedMedium \"homogenous\"; the "
                                    "nearest known name is \"homogeneous\"")));
  const std::string kind = "\"string type\" \"homogeneous\" ";
  EXPECT_THAT(medium(kind + "\"float g\" 1"),
              ElementsAre(HasSubstr("scene.pbrt:2:49: MakeNamedMedium \"m\": \"g\" must lie "
                                    "between -1 and 1, and be neither")));
  EXPECT_THAT(medium(kind + "\"float g\" -1"), ElementsAre(HasSubstr("2:49")));
  EXPECT_THAT(medium(kind + "\"rgb sigma_a\" [1 -1 1]"), ElementsAre(HasSubstr("scene.pbrt:2:49")));
  EXPECT_THAT(medium(kind + "\"rgb sigma_s\" [-1 1 1]"), ElementsAre(HasSubstr("scene.pbrt:2:49")));
  EXPECT_THAT(medium(kind + "\"float scale\" -1"), ElementsAre(HasSubstr("scene.pbrt:2:49")));
  EXPECT_THAT(medium(kind + "\"float Lescale\" -1"), ElementsAre(HasSubstr("scene.pbrt:2:49")));
  EXPECT_THAT(medium(kind + "\"string preset\" \"Skin3\""),
              ElementsAre(HasSubstr("scene.pbrt:2:49: MakeNamedMedium \"m\": \"preset\" is "
                                    "\"Skin3\"; the nearest known name is \"Skin1\"")));
  EXPECT_THAT(medium(kind + "\"float sigma\" 1"),
              ElementsAre(HasSubstr("unknown parameter \"sigma\"")));
}

TEST(Media, Grids) {
  const Scene scene = world_of(
      "Translate 1 2 3 MakeNamedMedium \"u\" \"string type\" \"uniformgrid\" \"integer nx\" 2 "
      "\"float density\" [1 2] \"float "
      "Lescale\" [3 4] \"point3 p0\" [1 1 1] "
      "\"point3 p1\" [0 0 0] \"rgb Le\" [1 1 1] \"float scale\" 5\n"
      "MakeNamedMedium \"r\" \"string type\" \"rgbgrid\" \"integer ny\" 2 \"rgb sigma_a\" [1 2 3 4 "
      "5 6] \"float g\" .5 \"float "
      "Lescale\" 2\n"
      "MakeNamedMedium \"c\" \"string type\" \"cloud\" \"float density\" 2 \"float wispiness\" 3 "
      "\"float frequency\" 4\n"
      "MediumInterface \"u\" \"r\" Shape \"sphere\" MediumInterface \"c\" \"\" Shape \"sphere\"");
  const auto& u = medium_of<UniformGridMedium>(scene, 0);
  EXPECT_EQ(*u.density, (std::vector<float>{1, 2}));
  EXPECT_EQ(*u.radiance_scale, (std::vector<float>{3, 4}));
  EXPECT_EQ(u.bounds.p0, glm::dvec3(0));
  EXPECT_EQ(u.bounds.p1, glm::dvec3(1));
  EXPECT_EQ(u.bounds.world_from_medium[3], glm::dvec4(1, 2, 3, 1));
  EXPECT_EQ(u.scattering.scale, 5);
  EXPECT_EQ(std::get<ConstantSpectrum>(u.scattering.sigma_a).value, 1);
  const auto& r = medium_of<RgbGridMedium>(scene, 1);
  EXPECT_EQ(*r.sigma_a.rgb, (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(r.radiance_scale, 2);
  EXPECT_EQ(r.g, 0.5);
  const auto& c = medium_of<CloudMedium>(scene, 2);
  EXPECT_EQ(c.density, 2);
  EXPECT_EQ(c.wispiness, 3);
  EXPECT_EQ(c.frequency, 4);
}

TEST(Media, GridsOfTheWrongCountHaveTheirPlace) {
  const auto grid = [](const std::string& rest) {
    return said("MakeNamedMedium \"m\" \"string type\" " + rest +
                "\nMediumInterface \"m\" \"\"\nShape \"sphere\"");
  };
  EXPECT_THAT(grid("\"uniformgrid\" \"integer nx\" 2 \"float density\" [1 2 3]"),
              ElementsAre("scene.pbrt:2:64: MakeNamedMedium \"m\": \"density\" has 3 values, but a "
                          "grid of 2 x 1 x 1 cells takes 2"));
  EXPECT_THAT(grid("\"uniformgrid\" \"integer nx\" 2"),
              ElementsAre(HasSubstr(
                  "scene.pbrt:2:1: MakeNamedMedium \"m\": \"float density\" is missing")));
  EXPECT_THAT(grid("\"uniformgrid\" \"integer nx\" 0 \"float density\" 1"),
              ElementsAre(HasSubstr("\"nx\" must be at least 1")));
  EXPECT_THAT(grid("\"uniformgrid\" \"float density\" -1"),
              ElementsAre(HasSubstr("negative or not finite")));
  EXPECT_THAT(
      grid("\"uniformgrid\" \"float density\" 1 \"rgb Le\" [1 1 1] \"float temperature\" 300"),
      ElementsAre(HasSubstr("\"temperature\" cannot be combined with \"Le\"")));
  EXPECT_THAT(grid("\"uniformgrid\" \"float density\" 1 \"point3 p1\" [1 0 1]"),
              ElementsAre(HasSubstr("makes the medium's box flat")));
  EXPECT_THAT(grid("\"uniformgrid\" \"float density\" 1 \"float temperature\" [1 2]"),
              ElementsAre(HasSubstr("\"temperature\" has 2 values")));
  EXPECT_THAT(
      grid("\"rgbgrid\" \"rgb sigma_a\" [1 2 3 4 5 6]"),
      ElementsAre(HasSubstr("\"sigma_a\" has 2 values, but a grid of 1 x 1 x 1 cells takes 1")));
  EXPECT_THAT(grid("\"rgbgrid\" \"float g\" 0"),
              ElementsAre(HasSubstr("needs an \"rgb sigma_a\" or an \"rgb sigma_s\"")));
  EXPECT_THAT(
      grid("\"rgbgrid\" \"rgb sigma_s\" [1 1 1] \"rgb Le\" [1 1 1]"),
      ElementsAre(AllOf(HasSubstr(": \"Le\" needs a \"sigma_a\""), HasSubstr("scene.pbrt:"))));
  EXPECT_THAT(grid("\"cloud\" \"float density\" -1"),
              ElementsAre(HasSubstr("\"density\" must be")));
  EXPECT_THAT(grid("\"nanovdb\""), ElementsAre(HasSubstr("\"string filename\" is missing")));
}

TEST(Media, AreHeldBySomethingClosed) {
  const std::string in = fog + "\nMediumInterface \"fog\" \"\"\n";
  const auto warned = [&](const std::string& shape) {
    LogOf log;
    EXPECT_THAT(said(in + shape), IsEmpty());
    return log.text();
  };
  EXPECT_THAT(warned("Shape \"disk\""),
              HasSubstr("scene.pbrt:4:1: the medium fog is on an open surface: a disk does not "
                        "enclose it; what goes through it"));
  EXPECT_THAT(warned("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] \"integer "
                     "indices\" [0 1 2 2 1 3]"),
              HasSubstr("on an open surface"));
  EXPECT_THAT(warned("Shape \"cylinder\""), HasSubstr("on an open surface"));
  EXPECT_THAT(said("Material \"subsurface\" Shape \"disk\""),
              ElementsAre(HasSubstr("is on an open surface: a disk does not enclose it")));
  EXPECT_THAT(said(in + "Shape \"sphere\" \"bool onesided\" true"),
              ElementsAre(HasSubstr(
                  "scene.pbrt:4:1: a shape that is not seen from inside holds no medium")));
  EXPECT_THAT(said(in + "Shape \"cylinder\" Shape \"disk\" \"float height\" 1 Shape \"disk\" "
                        "\"float height\" -1"),
              IsEmpty());
  EXPECT_THAT(said(in + "Shape \"sphere\""), IsEmpty());
  // Around all is no place that a surface encloses.
  EXPECT_THAT(said(fog + "\nMediumInterface \"\" \"fog\" Shape \"disk\""), IsEmpty());
}

// A csg is one solid: of the medium at its statement, or of that of its operands.
TEST(Media, OfACsg) {
  const auto ball = [](const std::string& name, const std::string& media) {
    return "AttributeBegin " + media + " ObjectBegin \"" + name +
           "\" Shape \"sphere\" ObjectEnd AttributeEnd\n";
  };
  const std::string two = fog + "\n" + std::string(fog).replace(fog.find("fog"), 3, "tea") + "\n";
  const std::string of_fog = "MediumInterface \"fog\" \"\"",
                    of_tea = "MediumInterface \"tea\" \"\"";
  const auto csg = [](const std::string& operation) {
    return "Shape \"csg\" \"string operation\" \"" + operation +
           "\" \"string operands\" [ \"a\" \"b\" ]\n";
  };
  const auto inside = [&](const std::string& text) {
    const Scene scene = world_of(two + text);
    const Shape& shape = scene.shapes.at(0);
    for (const auto& operand : std::get<CsgShape>(shape.geometry).operands)
      EXPECT_EQ(operand->media, MediumSides{});
    return shape.media.inside ? scene.media.at(*shape.media.inside).name : "";
  };
  EXPECT_EQ(inside(ball("a", "") + ball("b", "") + csg("union")), "");
  EXPECT_EQ(inside(ball("a", "") + ball("b", "") + of_fog + " " + csg("union")), "fog");
  EXPECT_EQ(inside(ball("a", of_fog) + ball("b", of_fog) + csg("union")), "fog");
  EXPECT_EQ(inside(ball("a", of_fog) + ball("b", of_fog) + csg("intersection")), "fog");
  EXPECT_EQ(inside(ball("a", of_fog) + ball("b", "") + of_fog + " " + csg("union")), "fog");
  // What is taken away leaves nothing of its own.
  EXPECT_EQ(inside(ball("a", of_fog) + ball("b", of_tea) + csg("difference")), "fog");
  EXPECT_EQ(inside(ball("a", "") + ball("b", of_tea) + csg("difference")), "");
  // Nested.
  EXPECT_EQ(inside("AttributeBegin " + of_fog + " " + ball("c", of_fog) + ball("d", of_fog) +
                   " ObjectBegin \"a\" Shape \"csg\" \"string operation\" \"union\" \"string "
                   "operands\" [ \"c\" \"d\" ] "
                   "ObjectEnd AttributeEnd\n" +
                   ball("b", of_fog) + csg("union")),
            "fog");
  EXPECT_THAT(said(two + ball("a", of_fog) + ball("b", of_tea) + csg("union")),
              ElementsAre(HasSubstr("scene.pbrt:5:57: the operand of a csg has another "
                                    "MediumInterface than the first operand: a csg is "
                                    "of one medium (scene.pbrt:6:1)")));
  EXPECT_THAT(said(two + ball("a", of_fog) + ball("b", "") + csg("union")),
              ElementsAre(HasSubstr("has another MediumInterface than the first operand")));
  EXPECT_THAT(said(two + ball("a", of_fog) + ball("b", of_fog) + of_tea + " " + csg("union")),
              ElementsAre(HasSubstr("has another MediumInterface than the csg itself")));
  EXPECT_THAT(
      said(two + ball("a", "MediumInterface \"mist\" \"\"") + ball("b", "") + csg("difference")),
      ElementsAre(HasSubstr("the medium \"mist\" is not defined")));
}

TEST(Subsurface, IsAMediumBehindABoundary) {
  const Scene scene = world_of(
      "Material \"subsurface\" \"string name\" \"Skin1\" \"float scale\" 3 \"float roughness\" .25 "
      "\"bool remaproughness\" false "
      "Shape \"sphere\" Shape \"sphere\"\n"
      "Material \"subsurface\" \"rgb sigma_a\" [1 2 3] \"rgb sigma_s\" [4 5 6] \"float g\" .5 "
      "\"float eta\" 1.4 Shape "
      "\"sphere\"\n"
      "Material \"subsurface\" \"rgb reflectance\" [.5 .5 .5] \"rgb mfp\" [2 2 2] \"float scale\" "
      ".5 Shape \"sphere\" Material "
      "\"subsurface\" Shape \"sphere\"");
  ASSERT_EQ(scene.media.size(), 4u);
  for (const Medium& medium : scene.media) EXPECT_TRUE(medium.subsurface);
  const auto at = [&](std::size_t shape) -> const ScatteringProperties& {
    return std::get<HomogeneousMedium>(scene.media.at(*scene.shapes.at(shape).media.inside).model)
        .scattering;
  };
  EXPECT_EQ(scene.shapes[0].media.inside, scene.shapes[1].media.inside);
  EXPECT_EQ(std::get<RgbSpectrum>(at(0).sigma_s).rgb, glm::dvec3(0.74, 0.88, 1.01));
  EXPECT_EQ(at(0).scale, 3);
  const auto& boundary =
      std::get<DielectricMaterial>(scene.materials.at(scene.shapes[0].material).model);
  EXPECT_EQ(std::get<ConstantSpectrum>(boundary.eta).value, 1.33);
  EXPECT_EQ(boundary.alpha_u, 0.25);
  EXPECT_EQ(std::get<RgbSpectrum>(at(2).sigma_a).rgb, glm::dvec3(1, 2, 3));
  EXPECT_EQ(at(2).g, 0.5);
  // Absorption and scattering make up a mean free path of 2, halved by the scale.
  const auto sum =
      std::get<RgbSpectrum>(at(3).sigma_a).rgb + std::get<RgbSpectrum>(at(3).sigma_s).rgb;
  EXPECT_NEAR(at(3).scale * sum.x, 1, 1e-12);
  EXPECT_EQ(std::get<RgbSpectrum>(at(4).sigma_s).rgb, glm::dvec3(2.55, 3.21, 3.77));
}

TEST(Subsurface, WhatIsWrongHasItsPlace) {
  const auto wrong = [](const std::string& rest) {
    return said("Material \"subsurface\" " + rest + "\nShape \"sphere\"");
  };
  EXPECT_THAT(wrong("\"rgb sigma_a\" [1 1 1]"),
              ElementsAre(HasSubstr(
                  "scene.pbrt:2:23: Material \"subsurface\": \"sigma_a\" needs a \"sigma_s\"")));
  EXPECT_THAT(wrong("\"string name\" \"Skin\""),
              ElementsAre(HasSubstr("the nearest known name is \"Skin1\"")));
  EXPECT_THAT(wrong("\"float g\" 1"), ElementsAre(HasSubstr("\"g\" must lie between -1 and 1")));
  EXPECT_THAT(wrong("\"float scale\" -1"), ElementsAre(HasSubstr("must not be negative")));
  EXPECT_THAT(wrong("\"rgb mfp\" [1 1 1]"),
              ElementsAre(HasSubstr("\"mfp\" needs a \"reflectance\"")));
  EXPECT_THAT(wrong("\"rgb reflectance\" [.5 .5 .5] \"string name\" \"Skin1\""),
              ElementsAre(HasSubstr("takes one of")));
  EXPECT_THAT(
      said("Material \"subsurface\"\nShape \"disk\""),
      ElementsAre(HasSubstr("scene.pbrt:3:1: the medium subsurface is on an open surface")));
}

TEST(Subsurface, OfAMix) {
  const std::string parts =
      "MakeNamedMaterial \"wax\" \"string type\" \"subsurface\" \"string name\" \"Skin1\"\n"
      "MakeNamedMaterial \"tallow\" \"string type\" \"subsurface\"\n"
      "MakeNamedMaterial \"paint\" \"string type\" \"diffuse\"\n"
      "MakeNamedMaterial \"gone\" \"string type\" \"interface\"\n";
  const auto mix = [](const std::string& a, const std::string& b) {
    return "Material \"mix\" \"string materials\" [ \"" + a + "\" \"" + b +
           "\" ] \"float amount\" 0.25\n";
  };
  const Scene scene = world_of(parts + mix("paint", "wax") + "Shape \"sphere\"");
  ASSERT_EQ(scene.media.size(), 1u);
  EXPECT_EQ(scene.shapes[0].media.inside, 0u);
  EXPECT_TRUE(
      std::holds_alternative<MixMaterial>(scene.materials.at(scene.shapes[0].material).model));
  EXPECT_THAT(said(parts + mix("tallow", "wax") + "Shape \"sphere\""),
              ElementsAre(HasSubstr(
                  "names the material \"wax\", a second subsurface: one alone can be within")));
  EXPECT_THAT(said(parts + mix("wax", "wax") + "Shape \"sphere\""), IsEmpty());
  EXPECT_THAT(
      said(parts + mix("wax", "gone") + "Shape \"sphere\""),
      ElementsAre(HasSubstr(
          "scene.pbrt:7:1: the shape parts media, and its material is a mix with an interface")));
}

// What is there with a chance is stopped by an alpha.
TEST(Interface, OfAMixIsAnAlpha) {
  const std::string parts =
      "Texture \"t\" \"float\" \"checkerboard\"\n"
      "MakeNamedMaterial \"paint\" \"string type\" \"diffuse\" \"rgb reflectance\" [ .1 .2 .3 ]\n"
      "MakeNamedMaterial \"gone\" \"string type\" \"interface\"\n";
  const auto mix = [](const std::string& a, const std::string& b,
                      const std::string& amount = "\"float amount\" 0.25") {
    return "Material \"mix\" \"string materials\" [ \"" + a + "\" \"" + b + "\" ] " + amount + "\n";
  };
  const auto alpha = [&](const std::string& text) {
    const Scene scene = world_of(parts + text);
    const Shape& shape = scene.shapes.at(0);
    EXPECT_TRUE(std::holds_alternative<DiffuseMaterial>(scene.materials.at(shape.material).model));
    return shape.alpha && !shape.alpha->texture
               ? std::get<ConstantSpectrum>(shape.alpha->value).value
               : -1;
  };
  EXPECT_EQ(alpha(mix("paint", "gone") + "Shape \"sphere\""), 0.75);
  EXPECT_EQ(alpha(mix("gone", "paint") + "Shape \"sphere\""), 0.25);
  const Scene textured = world_of(parts + mix("paint", "gone", "\"texture amount\" \"t\"") +
                                  "Shape \"disk\" \"float alpha\" 0.5");
  const auto& both =
      std::get<ScaleTexture>(textured.textures.at(*textured.shapes[0].alpha->texture).model);
  EXPECT_EQ(std::get<ConstantSpectrum>(both.tex.value).value, 0.5);
  const auto& rest = std::get<MixTexture>(textured.textures.at(*both.scale.texture).model);
  EXPECT_EQ(std::get<ConstantSpectrum>(rest.tex1.value).value, 1);
  EXPECT_EQ(std::get<ConstantSpectrum>(rest.tex2.value).value, 0);
  EXPECT_TRUE(std::holds_alternative<CheckerboardTexture>(
      textured.textures.at(*rest.amount.texture).model));
  // A mix of nothing but interfaces gives nothing.
  EXPECT_EQ(
      world_of(parts + mix("gone", "gone") + "Shape \"sphere\" Material \"diffuse\" Shape \"disk\"")
          .shapes.size(),
      1u);
  EXPECT_THAT(said(parts + mix("paint", "gone") + "AreaLightSource \"diffuse\" Shape \"sphere\""),
              ElementsAre(HasSubstr(
                  "the shape is an area light, whose material is no mix with an interface")));
  EXPECT_THAT(
      said(parts + fog + "\n" + mix("paint", "gone") +
           "MediumInterface \"fog\" \"\" Shape \"sphere\""),
      ElementsAre(HasSubstr("the shape parts media, and its material is a mix with an interface")));
  EXPECT_THAT(
      said(parts +
           "MakeNamedMaterial \"lace\" \"string type\" \"mix\" \"string materials\" [ \"paint\" "
           "\"gone\" ]\n" +
           mix("lace", "paint") + "Shape \"sphere\""),
      ElementsAre(HasSubstr(
          "names the material \"lace\", a mix with an interface, of which no other mix is made")));
}

// Parts of even light that go out again, by walks (tests/media/walks.py; 2e5 of them).
TEST(Subsurface, AlbedosAreThoseOfTransport) {
  struct Walk {
    double eta, g, albedo, reflectance, within;
  };
  for (const Walk& walk : {Walk{1.33, 0, 0.5, 0.0653, 0.001},
                           {1.33, 0, 0.8, 0.1845, 0.001},
                           {1.33, 0, 0.93, 0.3556, 0.001},
                           {1.33, 0, 0.98, 0.5611, 0.001},
                           {1.33, 0, 0.995, 0.7419, 0.001},
                           {1.5, 0, 0.5, 0.0490, 0.001},
                           {1.5, 0, 0.93, 0.2924, 0.001},
                           {1.5, 0, 0.995, 0.6869, 0.0015},
                           {1.33, 0.7, 0.5, 0.0129, 0.02},
                           {1.33, 0.7, 0.8, 0.0595, 0.02},
                           {1.33, 0.7, 0.93, 0.1704, 0.02},
                           {1.33, 0.7, 0.98, 0.3653, 0.02},
                           {1.33, 0.7, 0.995, 0.5893, 0.02}}) {
    // It rises with the albedo: that of a little more is above.
    EXPECT_LT(albedo_within(walk.reflectance - walk.within, walk.eta, walk.g), walk.albedo)
        << walk.eta << " " << walk.g;
    EXPECT_GT(albedo_within(walk.reflectance + walk.within, walk.eta, walk.g), walk.albedo)
        << walk.eta << " " << walk.g;
  }
  EXPECT_EQ(albedo_within(0, 1.33, 0), 0);
  EXPECT_EQ(albedo_within(1, 1.33, 0.5), 1);
}

}  // namespace
}  // namespace caplet::test
