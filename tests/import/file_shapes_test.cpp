// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Shape "swc" and Shape "file": what other importers read, within a pbrt scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "import_text.h"
#include "support/log_of.h"

namespace caplet {
namespace {

using test::write_file;
using testing::HasSubstr;

class FileShapes : public testing::Test {
 protected:
  FileShapes() {
    write_file(folder_ / "n.swc", "1 1 0 0 0 2 -1\n2 3 0 3 0 1 1\n3 2 0 -4 0 1 1\n");
    write_file(folder_ / "n.txt", "1 1 0 0 0 2 -1\n2 3 0 3 0 1 1\n");
    write_file(folder_ / "t.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    write_file(folder_ / "inner.pbrt", "WorldBegin\nShape \"sphere\"\n");
    // Two nodes share a mesh: instances.
    write_file(
        folder_ / "two.gltf",
        R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0},{"mesh":0,"translation":[5,0,0]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  }
  Scene world(const std::string& text) const {
    return pbrt::import_text((folder_ / "scene.pbrt").string(),
                             "Camera \"perspective\"\nWorldBegin\nLightSource \"point\"\n" + text,
                             test::StubImages());
  }
  std::string said(const std::string& text) const {
    std::string out;
    for (const std::string& one : test::complaints_when([&] { return world(text); }))
      out += one + "\n";
    return out;
  }
  static const std::string& material_of(const Scene& scene, const Shape& shape) {
    return scene.materials.at(shape.material).name;
  }
  std::filesystem::path folder_ = test::temporary_folder();
};

TEST_F(FileShapes, FilesOfOptionsLieBesideTheScene) {
  write_file(folder_ / "m.xyz", "1\n\nC 0 0 0\n");
  // NumPy's format, version 1.0: one frame of one atom.
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1, 3), }";
  header.resize(117, ' ');
  const double place[3] = {1, 2, 3};
  write_file(folder_ / "m.npy",
             std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + "\n" +
                 std::string(reinterpret_cast<const char*>(place), sizeof place));
  const Scene scene =
      world("Shape \"file\" \"string filename\" \"m.xyz\" \"string positions\" \"m.npy\"\n");
  ASSERT_EQ(scene.shapes.size(), 1U);
  EXPECT_EQ(std::get<CapsulesShape>(scene.shapes[0].geometry).p0,
            (std::vector<glm::vec3>{{1, 2, 3}}));
}

TEST_F(FileShapes, HaveTheStatementsTransformAndMaterial) {
  const Scene scene = world(
      "MakeNamedMaterial \"m\" \"string type\" \"diffuse\"\nNamedMaterial \"m\"\nTranslate 10 0 "
      "0\nScale 2 2 "
      "2\nReverseOrientation\n"
      "AreaLightSource \"diffuse\"\nShape \"swc\" \"string filename\" \"n.swc\" \"string name\" "
      "\"cell\"\n");
  ASSERT_EQ(scene.shapes.size(), 2U);
  EXPECT_EQ(scene.shapes[0].name, "cell: sample 1");
  EXPECT_EQ(scene.shapes[1].name, "cell: n");
  for (const Shape& shape : scene.shapes) {
    EXPECT_EQ(material_of(scene, shape), "m");
    EXPECT_TRUE(shape.reverse_orientation);
    EXPECT_TRUE(shape.emission.has_value());
    EXPECT_THAT(shape.where.to_string(), HasSubstr("scene.pbrt:10"));
  }
  EXPECT_EQ(scene.materials.size(), 1U);
  const Bounds bounds = bounds_of(scene);  // from -5 to 4, twice as large
  EXPECT_DOUBLE_EQ(bounds.min.y, -10);
  EXPECT_DOUBLE_EQ(bounds.max.y, 8);
  EXPECT_DOUBLE_EQ(bounds.max.x, 14);
}

TEST_F(FileShapes, HaveTheirOwnMaterialsWhereTheStatementSaysSo) {
  const std::string before =
      "MakeNamedMaterial \"axon\" \"string type\" \"conductor\"\nNamedMaterial \"axon\"\nShape "
      "\"sphere\"\n";
  const Scene scene = world(
      before +
      "Shape \"file\" \"string filename\" \"n.swc\" \"bool ownmaterials\" true\nShape \"disk\"\n");
  ASSERT_EQ(scene.shapes.size(), 4U);
  EXPECT_EQ(material_of(scene, scene.shapes[1]), "soma");
  const auto& capsules = std::get<CapsulesShape>(scene.shapes[2].geometry);
  EXPECT_EQ(scene.materials.at(capsules.materials[0]).name, "basal dendrite");
  EXPECT_TRUE(std::holds_alternative<DiffuseMaterial>(
      scene.materials.at(capsules.materials[1]).model));  // of the file
  for (const std::size_t i : {0U, 3U})
    EXPECT_TRUE(std::holds_alternative<ConductorMaterial>(
        scene.materials.at(scene.shapes[i].material).model));
  // An option of the format, which colours.
  const Scene colored =
      world("Shape \"swc\" \"string filename\" \"n.swc\" \"string color\" \"depth\"\n");
  EXPECT_EQ(material_of(colored, colored.shapes[0]), "depth 0");
}

TEST_F(FileShapes, SwcIsReadWhateverItsName) {
  EXPECT_EQ(world("Shape \"swc\" \"string filename\" \"n.txt\"\n").shapes.size(), 2U);
  EXPECT_THAT(said("Shape \"file\" \"string filename\" \"n.txt\"\n"),
              HasSubstr("no known scene format"));
}

TEST_F(FileShapes, AreInObjectsLikeAnyShape) {
  const Scene scene = world(
      "ObjectBegin \"o\"\nShape \"sphere\"\nTranslate 1 0 0\nShape \"file\" \"string filename\" "
      "\"t.off\"\nObjectEnd\n"
      "ObjectInstance \"o\"\nTranslate 0 7 0\nObjectInstance \"o\"\n");
  EXPECT_TRUE(scene.shapes.empty());
  ASSERT_EQ(scene.objects.size(), 1U);
  ASSERT_EQ(scene.objects[0].shapes.size(), 2U);
  EXPECT_EQ(scene.objects[0].shapes[1].world_from_object[3], glm::dvec4(1, 0, 0, 1));
  EXPECT_EQ(scene.instances.size(), 2U);
  EXPECT_EQ(bounds_of(scene).max.y, 8);
}

TEST_F(FileShapes, OfInstancesAreInstances) {
  const std::string statement = "Shape \"file\" \"string filename\" \"two.gltf\"\n";
  const Scene scene = world("Translate 0 2 0\n" + statement);
  ASSERT_EQ(scene.instances.size(), 2U);
  EXPECT_EQ(bounds_of(scene).min.y, 2);
  EXPECT_EQ(bounds_of(scene).max.x, 6);
  EXPECT_THAT(said("ObjectBegin \"o\"\n" + statement + "ObjectEnd\nShape \"sphere\"\n"),
              HasSubstr("holds instances, which cannot be within ObjectBegin"));
}

TEST_F(FileShapes, CamerasAndLightsOfTheirsAreNotTaken) {
  write_file(
      folder_ / "lit.gltf",
      R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0},{"extensions":{"KHR_lights_punctual":{"light":0}}}],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}},"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  test::LogOf log;
  const Scene scene = world("\n Shape \"file\" \"string filename\" \"lit.gltf\"\n");
  EXPECT_EQ(scene.shapes.size(), 1U);
  EXPECT_EQ(scene.lights.size(), 1U);  // the scene's own
  EXPECT_THAT(log.text(), testing::ContainsRegex("scene\\.pbrt:5:2: the shapes alone of "
                                                 ".*lit\\.gltf are taken: not its camera and "
                                                 "lights"));
}

TEST_F(FileShapes, SayWhatIsWrong) {
  EXPECT_THAT(said("Shape \"file\"\n"), HasSubstr("\"string filename\" is missing"));
  EXPECT_THAT(said("Shape \"file\" \"string filename\" \"none.swc\"\n"), HasSubstr("no such file"));
  EXPECT_THAT(said("Shape \"file\" \"string filename\" \"inner.pbrt\"\n"),
              HasSubstr("Include or Import"));
  EXPECT_THAT(said("Shape \"swc\" \"string filename\" \"t.off\"\n"), HasSubstr("t.off:1"));
  EXPECT_THAT(said("Shape \"swc\" \"string filename\" \"n.swc\" \"string colour\" \"order\"\n"),
              HasSubstr("\"color\""));
  EXPECT_THAT(said("Shape \"swc\" \"string filename\" \"n.swc\" \"string color\" \"moon\"\n"),
              HasSubstr("scene.pbrt:4"));
  EXPECT_THAT(said("Shape \"file\" \"string filename\" \"t.off\" \"string color\" \"order\"\n"),
              HasSubstr("color"));
}

}  // namespace
}  // namespace caplet
