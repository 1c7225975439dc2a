// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Much that is wrong at once, what is wrong but used nowhere, scenes of pbrt-v3, and files made to
// take for ever.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <zlib.h>

#include "import_text.h"

namespace caplet::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> messages_of(const Diagnostics& diagnostics) {
  try {
    diagnostics.finish();
  } catch (const InputError& error) {
    return error.messages();
  }
  return {};
}

std::vector<std::string> file_complaints(const fs::path& path) {
  try {
    import_scene(path, StubImages());
  } catch (const InputError& error) {
    return error.messages();
  }
  return {};
}

// --- Many ---

TEST(Errors, OfOneKindAreOneLineWithTheirNumber) {
  Diagnostics diagnostics(2);
  EXPECT_TRUE(messages_of(diagnostics).empty());
  for (int line = 1; line <= 10'000; ++line)
    diagnostics.error({"f", line}, "hair is not rendered yet", "hair");
  diagnostics.error({"f", 7}, "no number");
  EXPECT_THAT(
      messages_of(diagnostics),
      ElementsAre("f:1: hair is not rendered yet (and 9999 more of this kind)", "f:7: no number"));
  for (int line = 8; line < 11; ++line) diagnostics.error({"f", line}, "no number");
  EXPECT_THAT(messages_of(diagnostics).back(), "and 3 more errors");
  EXPECT_EQ(messages_of(diagnostics).size(), 3u);
}

TEST(Errors, OfFeaturesOfManyStatementsAreGrouped) {
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 10'000; ++i)
    text +=
        "Material \"measured\"\nShape \"sphere\"\nActiveTransform EndTim\nMakeNamedMaterial \"" +
        std::to_string(i) +
        "\" \"string type\" \"diffuse\" \"string normalmap\" \"n.png\"\nNamedMaterial \"" +
        std::to_string(i) + "\"\nShape \"disk\"\n";
  EXPECT_THAT(
      complaints(text),
      ElementsAre(
          "scene.pbrt:4:17: unknown ActiveTransform \"EndTim\"; the nearest known name is "
          "\"EndTime\" (and 9999 more of this kind)",
          "scene.pbrt:2:1: Material \"measured\" is not rendered yet (and 9999 more of this kind)",
          "scene.pbrt:5:47: MakeNamedMaterial \"0\": \"normalmap\" no such file \"n.png\" (and "
          "9999 more of this kind)"));
}

TEST(Errors, StopReadingWhereEverythingIsWrong) {
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 150'000; ++i) text += "Shape \"sphere\" \"float radius\" -1\n";
  const auto found = complaints(text);
  ASSERT_EQ(found.size(), 22u);
  EXPECT_EQ(found[20], "and 99980 more errors");
  EXPECT_EQ(found[21], "too much is wrong here: reading stopped");
}

// Ends in time because a name is looked for in a table, and the nearest known name only where it is
// shown.
TEST(Errors, OfTwoHundredThousandUnknownParameters) {
  std::string text = "WorldBegin\nShape \"sphere\"\n";
  for (int i = 0; i < 200'000; ++i) text += "\"float p" + std::to_string(i) + "\" 1\n";
  const auto found = complaints(text);
  EXPECT_EQ(found.front(),
            "scene.pbrt:3:1: Shape \"sphere\": unknown parameter \"p0\"; the nearest known name is "
            "\"name\"");
  EXPECT_THAT(found[20], HasSubstr("more errors"));
}

TEST(Errors, OfManyNamesThatDoNotExistAmongManyThatDo) {
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 20'000; ++i)
    text += "ObjectBegin \"o" + std::to_string(i) +
            "\" Shape \"sphere\" ObjectEnd ObjectInstance \"x" + std::to_string(i) +
            "\" CoordSysTransform \"c" + std::to_string(i) + "\"\n";
  EXPECT_EQ(complaints(text).back(), "and 39980 more errors");
}

// --- Not used ---

TEST(Unused, MaterialsMediaAndTexturesDoNotBlockAScene) {
  const Scene scene = world_of(
      "Material \"measured\"\nMakeNamedMaterial \"a\" \"string type\" \"measured\"\n"
      "MakeNamedMaterial \"b\" \"string type\" \"diffuse\" \"string normalmap\" \"n.png\"\n"
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\nMediumInterface \"\" \"\"\n"
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"no-such.png\"\n"
      "MakeNamedMaterial \"c\" \"string type\" \"diffuse\" \"texture reflectance\" \"t\"\n"
      "Material \"diffuse\" \"string reflectance\" \"half\"\n"
      "Material \"diffuse\" \"spectrum reflectance\" [400 .25 700 .25]\nShape \"sphere\"");
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(
      std::get<SampledSpectrum>(
          std::get<DiffuseMaterial>(scene.materials[scene.shapes[0].material].model).reflectance)
          .values[0],
      0.25);
}

TEST(Unused, AreErrorsWhereTheyAreUsed) {
  const std::string world = "WorldBegin\n";
  EXPECT_THAT(complaints(world + "MakeNamedMaterial \"a\" \"string type\" "
                                 "\"measured\"\nNamedMaterial \"a\"\nShape \"sphere\""),
              ElementsAre("scene.pbrt:2:23: Material \"measured\" is not rendered yet"));
  EXPECT_THAT(complaints(world + "MakeNamedMaterial \"a\" \"string type\" \"measured\"\nShape "
                                 "\"sphere\" \"string materials\" \"a\""),
              ElementsAre("scene.pbrt:2:23: Material \"measured\" is not rendered yet"));
  // What is unknown is an error in any case.
  EXPECT_THAT(
      complaints(world + "Material \"hare\"\nMaterial \"diffuse\"\nShape \"sphere\""),
      ElementsAre("scene.pbrt:2:1: unknown Material \"hare\"; the nearest known name is \"hair\""));
}

TEST(Unused, AttributesOfMaterialsAreChecked) {
  EXPECT_THAT(
      complaints("WorldBegin\nAttribute \"material\" \"float rufness\" 1\nMaterial "
                 "\"diffuse\"\nShape \"sphere\""),
      ElementsAre(
          "scene.pbrt:2:22: no statement after this Attribute knows the parameter \"rufness\""));
  EXPECT_TRUE(complaints("WorldBegin\nAttribute \"shape\" \"float radius\" 1\nAttribute \"shape\" "
                         "\"float radius\" 2\nShape \"sphere\"")
                  .empty());
}

// --- pbrt-v3 (the names: pbrt-v4's own upgrade of such files) ---

TEST(Version3, IsNamedWithTheNewNames) {
  EXPECT_THAT(
      complaints(
          "Film \"image\" \"integer xresolution\" 8\nPixelFilter \"box\" \"float xwidth\" "
          "1\nWorldBegin\n"
          "LightSource \"infinite\" \"color L\" [1 1 1]\nMaterial \"matte\" \"rgb Kd\" [.5 .5 .5]\n"
          "Texture \"t\" \"color\" \"constant\"\nMaterial \"diffuse\" \"rgb Kd\" [.5 .5 .5]\nShape "
          "\"sphere\"\nShape \"nurbs\"\n"
          "WorldEnd\n"),
      ElementsAre(
          "scene.pbrt:1:1: unknown Film \"image\": that is pbrt-v3's name for \"rgb\"",
          "scene.pbrt:2:19: PixelFilter \"box\": unknown parameter \"xwidth\": that is pbrt-v3's "
          "name for \"xradius\"",
          "scene.pbrt:4:24: unknown parameter type \"color\": that is pbrt-v3's name for \"rgb\"",
          "scene.pbrt:5:1: unknown Material \"matte\": that is pbrt-v3's name for \"diffuse\" "
          "(\"Kd\" is \"reflectance\")",
          "scene.pbrt:6:13: a texture is \"float\" or \"spectrum\", not \"color\": that is "
          "pbrt-v3's name for \"spectrum\"",
          "scene.pbrt:9:1: unknown Shape \"nurbs\": that is pbrt-v3's, which pbrt-v4 does not have",
          "scene.pbrt:10:1: unknown directive \"WorldEnd\": this scene is in the language of "
          "pbrt-v3, Caplet reads that of "
          "pbrt-v4; pbrt-v4's own \"pbrt --upgrade\" rewrites it",
          "scene.pbrt:7:20: Material \"diffuse\": unknown parameter \"Kd\": that is pbrt-v3's name "
          "for \"reflectance\""));
}

// --- Files that scenes name ---

TEST(Errors, OfFilesHaveThePlaceThatNamesThem) {
  const fs::path folder = temporary_folder();
  write_file(folder / "bad.ply", "ply\nformat ascii 2.0\n");
  write_file(folder / "bad.capsules", "<0,0,0> <1,0,0> 1\n<0,0,0> 1\n");
  write_file(folder / "scene.pbrt",
             "WorldBegin\nShape \"plymesh\" \"string filename\" \"bad.ply\"\n  Shape \"capsules\" "
             "\"string filename\" "
             "\"bad.capsules\"\n");
  const std::string at = folder.string() + "/";
  EXPECT_THAT(
      file_complaints(folder / "scene.pbrt"),
      ElementsAre(testing::AllOf(testing::StartsWith(at + "scene.pbrt:2:17: " + at + "bad.ply:"),
                                 HasSubstr("PLY")),
                  testing::StartsWith(at + "scene.pbrt:3:20: " + at + "bad.capsules:2:9: ")));
}

TEST(Files, GzipThatOnlyFillsTheMemoryIsRefused) {
  const fs::path folder = temporary_folder();
  const std::string blanks(1 << 20, ' ');
  const auto write = [&](const char* name, int megabytes) {
    const gzFile file = gzopen((folder / name).c_str(), "wb9");
    gzputs(file, "WorldBegin Shape \"sphere\"");
    for (int i = 0; i < megabytes; ++i)
      gzwrite(file, blanks.data(), static_cast<unsigned>(blanks.size()));
    gzclose(file);
  };
  write("bomb.pbrt.gz", 80);
  write("small.pbrt.gz", 16);
  write_file(folder / "scene.pbrt", "WorldBegin\nShape \"sphere\"\nInclude \"bomb.pbrt.gz\"");
  EXPECT_THAT(file_complaints(folder / "bomb.pbrt.gz"),
              ElementsAre(HasSubstr("bomb.pbrt.gz: unpacks to more than 67108864 bytes")));
  EXPECT_THAT(file_complaints(folder / "scene.pbrt"), ElementsAre(HasSubstr("scene.pbrt:3:9: ")));
  EXPECT_TRUE(file_complaints(folder / "small.pbrt.gz").empty());
}

TEST(Files, BytesOfNoTextAreFoundInLongOnes) {
  for (const std::size_t at : {0u, 255u, 256u, 700u, 1023u, 1030u}) {
    std::string text(1040, ' ');
    text[at] = '\x01';
    if (at > 500) text[500] = '\n';
    const std::string place =
        at > 500 ? "2:" + std::to_string(at - 500) : "1:" + std::to_string(at + 1);
    EXPECT_THAT(complaints(text),
                ElementsAre("scene.pbrt:" + place + ": this is no text (byte 0x01)"));
  }
}

TEST(Files, IncludesInACircleAreShownInOrder) {
  const fs::path folder = temporary_folder();
  write_file(folder / "a.pbrt", "WorldBegin\nShape \"sphere\"\nInclude \"b.pbrt\"");
  write_file(folder / "b.pbrt", "\nImport \"c.pbrt\"");
  write_file(folder / "c.pbrt", "Include \"b.pbrt\"");
  const std::string at = folder.string() + "/";
  EXPECT_THAT(file_complaints(folder / "a.pbrt"),
              ElementsAre(at + "c.pbrt:1:9: recursive Include of " + at + "b.pbrt: " + at +
                          "b.pbrt includes " + at + "c.pbrt includes " + at + "b.pbrt"));
}

TEST(Files, FifosAreNotWaitedFor) {
  const fs::path fifo = temporary_folder() / "fifo";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  for (const std::string statement :
       {"Include", "Shape \"capsules\" \"string filename\"",
        "Shape \"plymesh\" \"string filename\"", "Material \"diffuse\" \"spectrum reflectance\""})
    EXPECT_THAT(complaints("WorldBegin\nShape \"sphere\"\n" + statement + " \"" + fifo.string() +
                           "\"\nShape \"sphere\""),
                ElementsAre(HasSubstr("regular file")))
        << statement;
}

// Eight levels of twenty includes each, 20^8 files in all.
TEST(Files, ATreeOfIncludesEnds) {
  const fs::path folder = temporary_folder();
  for (int level = 0; level < 9; ++level) {
    std::string text = level == 0 ? "WorldBegin\nShape \"sphere\"\n" : "";
    for (int i = 0; i < 20 && level < 8; ++i)
      text += "Include \"" + std::to_string(level + 1) + ".pbrt\"\n";
    write_file(folder / (std::to_string(level) + ".pbrt"), text);
  }
  EXPECT_THAT(file_complaints(folder / "0.pbrt"),
              ElementsAre(HasSubstr("more than 65536 files are included")));
}

}  // namespace
}  // namespace caplet::test
