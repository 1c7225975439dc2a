// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Wrong scenes: one clear line each, with the exact place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "import_text.h"

namespace caplet::test {
namespace {

namespace fs = std::filesystem;

struct Bad {
  const char* name;
  const char* text;
  const char* complaint;
};

void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }

class BadScene : public testing::TestWithParam<Bad> {};

TEST_P(BadScene, IsRefusedWithItsPlace) {
  EXPECT_THAT(complaints(GetParam().text), testing::ElementsAre(GetParam().complaint));
}

const Bad bad_scenes[] = {
    {"UnknownDirective", "WorldBegin\n  Shap \"sphere\"\nShape \"sphere\"",
     "scene.pbrt:2:3: unknown directive \"Shap\"; the nearest known name is \"Shape\""},
    {"UnknownParameter", "WorldBegin\nShape \"sphere\" \"float radios\" 2",
     "scene.pbrt:2:16: Shape \"sphere\": unknown parameter \"radios\"; the nearest known name is "
     "\"radius\""},
    {"UnknownMaterial", "WorldBegin\nMaterial \"difuse\"\nShape \"sphere\"",
     "scene.pbrt:2:1: unknown Material \"difuse\"; the nearest known name is \"diffuse\""},
    {"UnknownLight", "WorldBegin\nLightSource \"distante\"\nShape \"sphere\"",
     "scene.pbrt:2:1: unknown LightSource \"distante\"; the nearest known name is \"distant\""},
    {"UnknownShape", "WorldBegin\nShape \"spere\"",
     "scene.pbrt:2:1: unknown Shape \"spere\"; the nearest known name is \"sphere\""},
    {"UnknownType", "WorldBegin\nShape \"sphere\" \"flot radius\" [ 1 ]",
     "scene.pbrt:2:16: unknown parameter type \"flot\"; the nearest known type is \"float\""},
    {"UnknownColorSpace", "Film \"rgb\"\nColorSpace \"rec709\"\nWorldBegin\nShape \"sphere\"",
     "scene.pbrt:2:12: unknown ColorSpace \"rec709\"; the nearest known name is \"rec2020\""},
    {"UnknownCoordinateSystem", "WorldBegin\nCoordSysTransform \"wrld\"\nShape \"sphere\"",
     "scene.pbrt:2:19: unknown coordinate system \"wrld\"; the nearest known name is \"world\""},
    {"UnknownTarget", "WorldBegin\nAttribute \"shapes\" \"float radius\" 1\nShape \"sphere\"",
     "scene.pbrt:2:11: unknown Attribute target \"shapes\"; the nearest known name is \"shape\""},
    {"UnusedAttribute", "WorldBegin\nAttribute \"shape\" \"float radios\" 1\nShape \"sphere\"",
     "scene.pbrt:2:19: no statement after this Attribute knows the parameter \"radios\""},
    {"WrongType", "WorldBegin\nShape \"sphere\" \"integer radius\" 2",
     "scene.pbrt:2:16: Shape \"sphere\": \"radius\" must be of type float, not integer"},
    {"StringForNumber", "WorldBegin\nShape \"sphere\" \"float radius\" \"2\"",
     "scene.pbrt:2:31: \"float radius\": expected a number, found the string \"2\""},
    {"WrongCount", "WorldBegin\nShape \"sphere\" \"float radius\" [1 2]",
     "scene.pbrt:2:16: Shape \"sphere\": \"radius\" takes 1 value, not 2"},
    {"WrongRgbCount",
     "WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [.1 .2]\nShape \"sphere\"",
     "scene.pbrt:2:20: \"rgb reflectance\" takes a multiple of 3 values, not 2"},
    {"WrongPointCount", "WorldBegin\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1]",
     "scene.pbrt:2:22: \"point3 P\" takes a multiple of 3 values, not 4"},
    {"Nan", "WorldBegin\nShape \"sphere\" \"float radius\" [nan]",
     "scene.pbrt:2:32: \"float radius\": the number \"nan\" is not finite"},
    {"Infinite", "WorldBegin\nTranslate 1 -inf 2\nShape \"sphere\"",
     "scene.pbrt:2:13: the number \"-inf\" is not finite"},
    {"Overflow", "WorldBegin\nScale 1 1 1e999\nShape \"sphere\"",
     "scene.pbrt:2:11: the number \"1e999\" is not finite"},
    {"NotANumber", "WorldBegin\nTranslate 1 2x 3\nShape \"sphere\"",
     "scene.pbrt:2:13: expected a number, found \"2x\""},
    {"FractionForInteger",
     "Sampler \"sobol\" \"integer pixelsamples\" 1.5\nWorldBegin\nShape \"sphere\"",
     "scene.pbrt:1:40: \"integer pixelsamples\": expected an integer, found \"1.5\""},
    {"HugeInteger",
     "Sampler \"sobol\" \"integer pixelsamples\" 5000000000\nWorldBegin\nShape \"sphere\"",
     "scene.pbrt:1:40: \"integer pixelsamples\": the integer \"5000000000\" is out of range (32 "
     "bits)"},
    {"NoValue", "WorldBegin\nShape \"sphere\" \"float radius\" []",
     "scene.pbrt:2:16: the parameter \"float radius\" has no value"},
    {"NoTexture", "WorldBegin\nMaterial \"conductor\" \"texture roughness\" [ ]\nShape \"sphere\"",
     "scene.pbrt:2:22: the parameter \"texture roughness\" has no value"},
    {"UnclosedBlock", "WorldBegin\n  AttributeBegin\nShape \"sphere\"",
     "scene.pbrt:2:3: AttributeBegin is never closed"},
    {"UnopenedBlock", "WorldBegin\nShape \"sphere\"\nAttributeEnd",
     "scene.pbrt:3:1: AttributeEnd without AttributeBegin"},
    {"CrossedBlocks", "WorldBegin\nObjectBegin \"a\"\nAttributeEnd\nObjectEnd\nShape \"sphere\"",
     "scene.pbrt:3:1: AttributeEnd while the ObjectBegin of scene.pbrt:2:1 is open"},
    {"UnclosedString", "WorldBegin\nShape \"sphere\nShape \"sphere\"",
     "scene.pbrt:2:7: this string is not closed on its line"},
    {"UnclosedBracket", "WorldBegin\nShape \"sphere\"\nShape \"sphere\" \"float radius\" [ 1",
     "scene.pbrt:3:31: this bracket is never closed"},
    {"UnknownEscape", "WorldBegin\nShape \"sphere\"\nInclude \"a\\qb\"",
     "scene.pbrt:3:11: unknown escape in a string"},
    {"StringForDirective", "WorldBegin\n\"sphere\"\nShape \"sphere\"",
     "scene.pbrt:2:1: expected a directive, found the string \"sphere\""},
    {"OptionInWorld", "WorldBegin\nCamera \"perspective\"\nShape \"sphere\"",
     "scene.pbrt:2:1: Camera is only allowed before WorldBegin"},
    {"ShapeBeforeWorld", "Shape \"sphere\"\nWorldBegin\nShape \"sphere\"",
     "scene.pbrt:1:1: Shape is only allowed after WorldBegin"},
    {"NoWorld", "Camera \"perspective\"", "scene.pbrt: the scene is empty: there is no WorldBegin"},
    {"EmptyScene", "WorldBegin\n# nothing",
     "scene.pbrt: the scene is empty: it has no shapes, no light and no camera"},
    {"MissingInclude", "WorldBegin\nInclude \"no-such.pbrt\"\nShape \"sphere\"",
     "scene.pbrt:2:9: no-such.pbrt: no such file"},
    {"MissingMesh", "WorldBegin\nShape \"plymesh\" \"string filename\" \"no-such.ply\"",
     "scene.pbrt:2:17: no-such.ply: no such file"},
    {"MissingTexture",
     "WorldBegin\nTexture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"no-such.png\"\n"
     "Material \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"",
     "scene.pbrt:3:20: Material \"diffuse\": \"reflectance\" uses Texture \"imagemap\" "
     "(scene.pbrt:2:1), whose image cannot be "
     "had: no such file \"no-such.png\""},
    {"MissingEnvironment",
     "WorldBegin\nLightSource \"infinite\" \"string filename\" \"no-such.exr\"\nShape \"sphere\"",
     "scene.pbrt:2:24: LightSource \"infinite\": \"filename\" no such file \"no-such.exr\""},
    {"UndefinedMaterial",
     "WorldBegin\nMakeNamedMaterial \"red\" \"string type\" \"diffuse\"\nNamedMaterial "
     "\"rde\"\nShape \"sphere\"",
     "scene.pbrt:3:15: the material \"rde\" is not defined; the nearest known name is \"red\""},
    {"UndefinedObject", "WorldBegin\nShape \"sphere\"\nObjectInstance \"tree\"",
     "scene.pbrt:3:1: the object \"tree\" is not defined"},
    {"UndefinedTexture",
     "WorldBegin\nMaterial \"diffuse\" \"texture reflectance\" \"wood\"\nShape \"sphere\"",
     "scene.pbrt:2:20: Material \"diffuse\": \"reflectance\" names an unknown texture, \"wood\""},
    {"NestedObject",
     "WorldBegin\nObjectBegin \"a\"\nObjectBegin \"b\"\nObjectEnd\nShape \"sphere\"",
     "scene.pbrt:3:1: ObjectBegin within the ObjectBegin of scene.pbrt:2:1"},
    {"InstanceInObject",
     "WorldBegin\nObjectBegin \"a\"\nObjectInstance \"a\"\nObjectEnd\nShape \"sphere\"",
     "scene.pbrt:3:1: ObjectInstance within the ObjectBegin of scene.pbrt:2:1"},
    {"IndexOutOfRange",
     "WorldBegin\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n  \"integer indices\" "
     "[0 1 3]",
     "scene.pbrt:3:3: Shape \"trianglemesh\": \"indices\" has the index 3 (entry 2), but there are "
     "3 vertices"},
    {"IndicesWithoutVertices", "WorldBegin\nShape \"trianglemesh\" \"integer indices\" [0 1 -1]",
     "scene.pbrt:2:1: Shape \"trianglemesh\": \"point3 P\" is missing"},
    {"NegativeRadius", "WorldBegin\nShape \"sphere\" \"float radius\" -1",
     "scene.pbrt:2:16: Shape \"sphere\": \"radius\" must be positive"},
    {"ZeroCapsule",
     "WorldBegin\nShape \"capsule\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 0 1] \"float radius\" "
     "[0 0]",
     "scene.pbrt:2:57: Shape \"capsule\": \"radius\" must be positive (of two radii one may be 0)"},
    {"VanishingCapsule",
     "WorldBegin\nShape \"capsule\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 0 1] \"float radius\" "
     "[0 1e-60]",
     "scene.pbrt:2:57: Shape \"capsule\": \"radius\" is too small a number"},
    {"FlatScale", "WorldBegin\nScale 1 0 1\nShape \"sphere\"",
     "scene.pbrt:2:1: Scale has no inverse"},
    {"BlindLookAt", "LookAt 0 0 0 0 0 1 0 0 1\nWorldBegin\nShape \"sphere\"",
     "scene.pbrt:1:1: LookAt has no direction (the points coincide, or up lies along the view)"},
    {"BrightReflectance",
     "WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [1 2 1]\nShape \"sphere\"",
     "scene.pbrt:2:20: Material \"diffuse\": \"reflectance\" is a reflectance and has a component "
     "above 1"},
    {"DescendingWavelengths",
     "WorldBegin\nMaterial \"diffuse\" \"spectrum reflectance\" [500 .1 400 .2]\nShape \"sphere\"",
     "scene.pbrt:2:20: \"spectrum reflectance\": wavelengths must ascend"},
    {"HugeImage",
     "Film \"rgb\" \"integer xresolution\" 100000 \"integer yresolution\" "
     "100000\nWorldBegin\nShape \"sphere\"",
     "scene.pbrt: the image of 100000 x 100000 pixels is larger than 2^28 pixels"},
    {"BadCrop", "Film \"rgb\" \"float cropwindow\" [0 1 .5 .5]\nWorldBegin\nShape \"sphere\"",
     "scene.pbrt:1:12: Film \"rgb\": \"cropwindow\" must be x min, x max, y min, y max within 0 "
     "and 1"},
    {"RefusedMaterial", "WorldBegin\nMaterial \"measured\" \"float roughness\" 0\nShape \"sphere\"",
     "scene.pbrt:2:1: Material \"measured\" is not rendered yet"},
    {"WrongRgbs",
     "WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [.1 .2 .3 .4 .5 .6]\nShape \"sphere\"",
     "scene.pbrt:2:20: Material \"diffuse\": \"reflectance\" takes 3 values, not 6"},
    {"UnknownMedium",
     "Film \"rgb\"\nMakeNamedMedium \"fog\" \"string type\" \"homogenous\"\nWorldBegin\nShape "
     "\"sphere\"",
     "scene.pbrt:2:23: unknown MakeNamedMedium \"homogenous\"; the nearest known name is "
     "\"homogeneous\""},
    {"MotionIntoTheMirror", "WorldBegin\nActiveTransform EndTime\nScale 1 1 -1\nShape \"sphere\"",
     "scene.pbrt:4:1: the motion turns a thing into its mirror image"},
    {"MotionBackInTime",
     "TransformTimes 2 1\nWorldBegin\nActiveTransform EndTime\nTranslate 1 0 0\nShape \"sphere\"",
     "scene.pbrt:5:1: the times of the motion do not rise (TransformTimes, if it is stated)"},
    {"MotionToNothing", "WorldBegin\nActiveTransform EndTime\nScale 0 1 1\nShape \"sphere\"",
     "scene.pbrt:3:1: Scale has no inverse"},
    {"MotionWithinAMotion",
     "WorldBegin\nObjectBegin \"a\"\nActiveTransform EndTime\nTranslate 1 0 0\nShape "
     "\"sphere\"\nObjectEnd\nActiveTransform StartTime\nTranslate 1 0 0\nActiveTransform "
     "All\nObjectInstance \"a\"",
     "scene.pbrt:10:1: a shape moves within the object \"a\", which moves itself: one of them must "
     "rest"},
    {"UnknownSensor", "Film \"rgb\" \"string sensor\" \"nikon_d85\"\nWorldBegin\nShape \"sphere\"",
     "scene.pbrt:1:12: Film \"rgb\": \"sensor\" is \"nikon_d85\"; the nearest known name is "
     "\"nikon_d850\""},
    {"RefusedOption", "Option \"disablepixeljitter\" true\nWorldBegin\nShape \"sphere\"",
     "scene.pbrt:1:29: Option \"disablepixeljitter\" is not rendered yet"},
};

INSTANTIATE_TEST_SUITE_P(Import, BadScene, testing::ValuesIn(bad_scenes),
                         [](const auto& row) { return row.param.name; });

TEST(BadInput, ErrorsAreCollectedUpToTheLimit) {
  EXPECT_EQ(complaints("WorldBegin\nBad1\nShape \"sphere\" \"float radius\" -1\nMaterial "
                       "\"measured\"\nShape \"sphere\"")
                .size(),
            3u);
  std::string many = "WorldBegin\n";
  for (int i = 0; i < 50; ++i) many += "Shape \"sphere\" \"float radius\" -1\n";
  EXPECT_EQ(complaints(many).size(), 21u);
  EXPECT_EQ(complaints(many).back(), "and 30 more errors");
}

TEST(BadInput, ReferenceToARefusedTextureNamesIt) {
  const auto found = complaints(
      "WorldBegin\nTexture \"t\" \"spectrum\" \"ptex\"\nMaterial \"diffuse\" \"texture "
      "reflectance\" \"t\"\nShape "
      "\"sphere\"");
  EXPECT_THAT(found,
              testing::ElementsAre(
                  "scene.pbrt:3:20: Material \"diffuse\": \"reflectance\" uses Texture \"ptex\" "
                  "(scene.pbrt:2:1), which is not rendered yet"));
}

TEST(BadInput, TexturesOfTexturesSayWhere) {
  const std::string head =
      "WorldBegin\nTexture \"c\" \"spectrum\" \"checkerboard\"\nTexture \"f\" \"float\" "
      "\"checkerboard\"\n";
  const auto of = [&](const std::string& texture) {
    return complaints(head + texture + "\nShape \"sphere\"");
  };
  using testing::ElementsAre;
  EXPECT_THAT(
      of("Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"d\""),
      ElementsAre("scene.pbrt:4:32: Texture \"t\": \"tex\" names an unknown texture, \"d\""));
  EXPECT_THAT(
      of("Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"t\""),
      ElementsAre("scene.pbrt:4:32: Texture \"t\": \"tex\" names an unknown texture, \"t\""));
  EXPECT_THAT(of("Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"f\""),
              ElementsAre("scene.pbrt:4:32: Texture \"t\": \"tex\" needs a spectrum texture, not "
                          "the float texture \"f\""));
  EXPECT_THAT(of("Texture \"t\" \"spectrum\" \"mix\" \"texture amount\" \"c\""),
              ElementsAre("scene.pbrt:4:30: Texture \"t\": \"amount\" needs a float texture, not "
                          "the spectrum texture \"c\""));
  EXPECT_THAT(of("Texture \"t\" \"spectrum\" \"checkerboard\" \"string mapping\" \"plane\""),
              ElementsAre("scene.pbrt:4:39: Texture \"t\": \"mapping\" is \"plane\"; the nearest "
                          "known name is \"planar\""));
  EXPECT_THAT(of("Texture \"t\" \"spectrum\" \"checkerboard\" \"integer dimension\" 4"),
              ElementsAre("scene.pbrt:4:39: Texture \"t\": \"dimension\" must be 2 or 3"));
  EXPECT_THAT(of("Texture \"t\" \"spectrum\" \"fbm\""),
              ElementsAre("scene.pbrt:4:1: Texture \"t\": is a texture of floats alone"));
  EXPECT_THAT(of("Texture \"t\" \"float\" \"marble\""),
              ElementsAre("scene.pbrt:4:1: Texture \"t\": is a texture of spectra alone"));
  EXPECT_THAT(of("Texture \"t\" \"float\" \"fbm\" \"integer octaves\" -1"),
              ElementsAre("scene.pbrt:4:27: Texture \"t\": \"octaves\" must lie between 0 and 64"));
  EXPECT_THAT(of("Texture \"t\" \"float\" \"directionmix\" \"vector3 dir\" [0 0 0]"),
              ElementsAre("scene.pbrt:4:36: Texture \"t\": \"dir\" is no direction"));
  EXPECT_THAT(of("Material \"dielectric\" \"texture roughness\" \"c\""),
              ElementsAre("scene.pbrt:4:23: Material \"dielectric\": \"roughness\" needs a float "
                          "texture, not the spectrum texture \"c\""));
  EXPECT_THAT(of("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"texture alpha\" \"c\""),
              testing::Contains("scene.pbrt:4:53: Shape \"trianglemesh\": \"alpha\" needs a float "
                                "texture, not the spectrum texture \"c\""));
  std::string deep =
      "Texture \"t0\" \"spectrum\" \"scale\" \"texture tex\" \"c\" \"float scale\" .5";
  for (int i = 1; i <= 14; ++i)
    deep += "\nTexture \"t" + std::to_string(i) + "\" \"spectrum\" \"scale\" \"texture tex\" \"t" +
            std::to_string(i - 1) + "\" \"float scale\" .5";
  EXPECT_THAT(of(deep + "\nMaterial \"diffuse\" \"texture reflectance\" \"t13\""),
              ElementsAre());  // 3 + 2 * 14 steps
  EXPECT_THAT(
      of(deep + "\nMaterial \"diffuse\" \"texture reflectance\" \"t14\""),
      ElementsAre(
          "scene.pbrt:18:1: the texture \"t14\" is made of more than 31 textures and constants"));
  EXPECT_THAT(of(deep), ElementsAre());
}

TEST(BadInput, Files) {
  const fs::path folder = temporary_folder();
  const StubImages images;
  const auto import = [&](const char* name) {
    return complaint_of([&] { import_scene(folder / name, images); });
  };
  write_file(folder / "empty.pbrt", "");
  write_file(folder / "garbage.pbrt", std::string("World\x01\x02\0\xff", 9));
  write_file(folder / "scene.blend", "x");
  write_file(folder / "self.pbrt", "WorldBegin\nInclude \"self.pbrt\"\nShape \"sphere\"");
  write_file(folder / "a.pbrt", "WorldBegin\nShape \"sphere\"\nInclude \"b.pbrt\"");
  write_file(folder / "b.pbrt", "Shape \"sphere\"\n  Shape \"cube\"");
  write_file(folder / "bad.spd", "400 1\n500 x");
  write_file(
      folder / "spectrum.pbrt",
      "WorldBegin\nMaterial \"diffuse\" \"spectrum reflectance\" \"bad.spd\"\nShape \"sphere\"");
  write_file(
      folder / "wide.pbrt",
      "WorldBegin\nLightSource \"infinite\" \"string filename\" \"b.pbrt\"\nShape \"sphere\"");
  write_file(folder / "cut.pbrt.gz",
             std::string("\x1f\x8b\x08\x00\x00\x00\x00\x00\x00\x03\x4b", 11));
  fs::create_directory(folder / "folder.pbrt");
  const std::string at = folder.string() + "/";
  EXPECT_EQ(import("missing.pbrt"), at + "missing.pbrt: no such file");
  EXPECT_EQ(import("folder.pbrt"), at + "folder.pbrt: is a folder, not a file");
  EXPECT_EQ(import("empty.pbrt"), at + "empty.pbrt: the file is empty");
  EXPECT_EQ(import("garbage.pbrt"), at + "garbage.pbrt:1:6: this is no text (byte 0x01)");
  EXPECT_THAT(
      import("scene.blend"),
      testing::StartsWith(
          at +
          "scene.blend: no known scene format (known: .pbrt, .pbrt.gz, .swc, .capsules, .pdb, "));
  EXPECT_EQ(import("self.pbrt"), at + "self.pbrt:2:9: recursive Include of " + at +
                                     "self.pbrt: " + at + "self.pbrt includes " + at + "self.pbrt");
  EXPECT_EQ(import("a.pbrt"),
            at + "b.pbrt:2:3: unknown Shape \"cube\"; the nearest known name is \"cone\"");
  EXPECT_EQ(import("spectrum.pbrt"),
            at + "spectrum.pbrt:2:20: " + at + "bad.spd:2:5: expected a number, found \"x\"");
  EXPECT_EQ(import("wide.pbrt"),
            at + "wide.pbrt:2:24: LightSource \"infinite\": \"filename\" " + at +
                "b.pbrt is 3 x 2 pixels, neither 1:1 (equal-area) nor 2:1 (latitude-longitude)");
  EXPECT_THAT(import("cut.pbrt.gz"), testing::StartsWith(at + "cut.pbrt.gz: "));
}

}  // namespace
}  // namespace caplet::test
