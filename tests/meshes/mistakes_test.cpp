// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// glTF, OBJ, MTL and OFF: numbers of all kinds, what is refused and what is told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>

#include "import/detail/mesh_file.h"
#include "import/import.h"
#include "support/import_files.h"
#include "support/log_of.h"

namespace caplet::mistakes_test {
namespace {

using test::complaint;
using test::OneTexel;
using test::write_beside;
using testing::AllOf;
using testing::HasSubstr;

Scene scene_of(const std::string& name, const std::string& text) {
  return import_scene(write_beside(name, text), OneTexel());
}
const TriangleMeshShape& mesh_of(const Shape& shape) {
  return std::get<TriangleMeshShape>(shape.geometry);
}
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

template <class Number>
void put(std::string& to, std::initializer_list<Number> numbers) {
  for (const Number number : numbers)
    to.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// A glTF file of one mesh; its accessors, of one view of 112 bytes, are 0: three positions, 1:
/// three infinite ones, 2: three of 16-bit integers, 3: the indices 2 1 0 of 32 bits, 4: indices of
/// which one is negative; then those given.
std::string gltf(const std::string& primitive, const std::string& accessors = "",
                 const std::string& more = "") {
  const float inf = std::numeric_limits<float>::infinity();
  std::string bytes;
  put<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0, inf, 0, 0, 0, inf, 0, 0, 0, -inf});
  put<std::int16_t>(bytes, {-32768, -32767, 0, 32767, 8192, -16384, 1, 2, 3, 0});
  put<std::uint32_t>(bytes, {2, 1, 0});
  put<std::int8_t>(bytes, {0, -1, 2, 0, 0, 0, 0, 0});
  EXPECT_EQ(bytes.size(), 112U);
  write_beside("numbers.bin", bytes);
  return R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"name":"it","primitives":[{)" +
         primitive +
         R"(}]}],"buffers":[{"byteLength":112,"uri":"numbers.bin"}],"bufferViews":[{"buffer":0,"byteLength":112}],"accessors":[)"
         R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
         R"({"bufferView":0,"byteOffset":36,"componentType":5126,"count":3,"type":"VEC3"},)"
         R"({"bufferView":0,"byteOffset":72,"componentType":5122,"count":3,"type":"VEC3"},)"
         R"({"bufferView":0,"byteOffset":92,"componentType":5125,"count":3,"type":"SCALAR"},)"
         R"({"bufferView":0,"byteOffset":104,"componentType":5120,"count":3,"type":"SCALAR"})" +
         accessors + "]" + more + "}";
}
const std::string kPlaced = R"("attributes":{"POSITION":0})";

// glTF 2.0, 3.6.2.2 and 3.11: 16-bit integers, of which normalized ones are max(c / 32767, -1).
TEST(Gltf, PositionsOf16Bits) {
  const Scene plain = scene_of("x.gltf", gltf(R"("attributes":{"POSITION":2})"));
  EXPECT_EQ(mesh_of(plain.shapes.at(0)).positions,
            (std::vector<glm::vec3>{{-32768, -32767, 0}, {32767, 8192, -16384}, {1, 2, 3}}));
  const Scene normalized = scene_of(
      "x.gltf",
      gltf(
          R"("attributes":{"POSITION":5})",
          R"(,{"bufferView":0,"byteOffset":72,"componentType":5122,"normalized":true,"count":3,"type":"VEC3"})"));
  const std::vector<glm::vec3>& p = mesh_of(normalized.shapes.at(0)).positions;
  EXPECT_EQ(p.at(0), glm::vec3(-1, -1, 0));
  EXPECT_EQ(p.at(1), glm::vec3(1, 8192 / 32767.0F, -16384 / 32767.0F));
  EXPECT_EQ(p.at(2), glm::vec3(1 / 32767.0F, 2 / 32767.0F, 3 / 32767.0F));
}

TEST(Gltf, IndicesOf32Bits) {
  const Scene scene = scene_of("x.gltf", gltf(kPlaced + R"(,"indices":3)"));
  EXPECT_EQ(mesh_of(scene.shapes.at(0)).triangles, (Triangles{{2, 1, 0}}));
}

// glTF 2.0, 3.7.2.1: the triangles of a fan share its first vertex.
TEST(Gltf, FansShareTheirFirstVertex) {
  const Scene scene = scene_of(
      "x.gltf",
      gltf(R"("mode":6,"attributes":{"POSITION":5})",
           R"(,{"bufferView":0,"byteOffset":72,"componentType":5120,"count":5,"type":"VEC3"})"));
  EXPECT_EQ(mesh_of(scene.shapes.at(0)).triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(Gltf, MistakesAreRefused) {
  const auto accessor = [](const std::string& json) { return ",{\"bufferView\":0," + json + "}"; };
  const auto material = [&](const std::string& image, const std::string& of) {
    return gltf(kPlaced + R"(,"material":0)", "",
                R"(,"images":[{"uri":")" + image +
                    R"("}],"textures":[{"source":0}],"materials":[{)" + of + "}]");
  };
  const auto light = [](const std::string& type) {
    return R"({"asset":{"version":"2.0"},"nodes":[{"extensions":{"KHR_lights_punctual":{"light":0}}}],"extensions":{"KHR_lights_punctual":{"lights":[{"type":")" +
           type + R"("}]}}})";
  };
  const std::string base = R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}})";
  const std::string fifth = R"("attributes":{"POSITION":5})";
  const std::pair<std::string, std::string> cases[] = {
      {gltf(R"("attributes":{"POSITION":1})"),
       "element 0 of accessor 1 is not finite or out of range"},
      {gltf(R"("attributes":{"POSITION":0,"COLOR_0":1})"),
       "element 0 of accessor 1 is not finite or out of range"},
      {gltf(R"("attributes":{"POSITION":3})"), "accessor 3 has another type than is needed"},
      {gltf(R"("attributes":{"POSITION":0,"COLOR_0":3})"),
       "accessor 3 has another type than colours have"},
      {gltf(R"("attributes":{"POSITION":0,"COLOR_0":5})",
            accessor(R"("componentType":5126,"count":2,"type":"VEC4")")),
       "a mesh has another number of colours than of positions"},
      {gltf(R"("attributes":{"POSITION":0,"NORMAL":5})",
            accessor(R"("componentType":5126,"count":2,"type":"VEC3")")),
       "a mesh has another number of normals or texture coordinates than of positions"},
      {gltf(R"("attributes":{"POSITION":0,"TEXCOORD_0":5})",
            accessor(R"("componentType":5126,"count":4,"type":"VEC2")")),
       "a mesh has another number of normals or texture coordinates than of positions"},
      {gltf(kPlaced + R"(,"indices":0)"), "accessor 0 has another type than indices have"},
      {gltf(kPlaced + R"(,"indices":5)",
            accessor(R"("componentType":5126,"count":3,"type":"SCALAR")")),
       "accessor 5 has another type than indices have"},
      {gltf(kPlaced + R"(,"indices":4)"), "element 1 of accessor 4 is negative"},
      {gltf(kPlaced + R"(,"indices":-1)"), "an index of a accessor is no whole number"},
      {gltf(kPlaced + R"(,"material":0.5)", "", R"(,"materials":[{}])"),
       "an index of a material is no whole number"},
      {gltf(fifth, accessor(R"("componentType":5126,"count":3,"type":"VEC3","sparse":{})")),
       "accessor 5 has a componentType that there is not"},
      {gltf(fifth, accessor(R"("componentType":5124,"count":3,"type":"VEC3")")),
       "accessor 5 has a componentType that there is not"},
      {gltf(fifth, accessor(R"("count":3,"type":"VEC3")")),
       "accessor 5 has a componentType that there is not"},
      {gltf(fifth, accessor(R"("componentType":5126,"count":3,"type":"MAT3")")),
       "accessor 5 has a type that is not read"},
      {gltf(fifth, accessor(R"("componentType":5126,"count":-1,"type":"VEC3")")),
       "accessor 5 has a count or offset out of range"},
      {gltf(fifth, accessor(R"("componentType":5126,"count":4294967296,"type":"VEC3")")),
       "accessor 5 has a count or offset out of range"},
      {gltf(fifth, accessor(R"("componentType":5126,"byteOffset":-4,"count":3,"type":"VEC3")")),
       "accessor 5 has a count or offset out of range"},
      {R"({"asset":{"version":"2.0"},"nodes":[{"translation":[0,1e17,0]}]})",
       "translation is not finite or out of range"},
      {light("area"), "a light of type 'area'"},
      {material("data:image/png,abc", base), "a data address is not of base64"},
      {material("data:image/png;base64", base), "a data address is not of base64"},
      {material("data:image/png;base64,*", base), "a data address has a letter that is none of"},
      {material("broken.png", base), "image 0: these bytes are no picture"},
      {material("grey.png", R"("normalTexture":{"index":0})"),
       "a normal texture is an image in grey, which has no normals"},
  };
  for (const auto& [text, said] : cases)
    EXPECT_THAT(complaint([&, &text = text] { scene_of("x.gltf", text); }),
                AllOf(HasSubstr("x.gltf"), HasSubstr(said)))
        << text;
}

// glTF 2.0, 5.26: 33071 is CLAMP_TO_EDGE, 10497 is REPEAT, which is usual.
TEST(Gltf, SamplersSayWhatIsBeyondAnImage) {
  const auto wrap = [](const std::string& sampler) {
    const Scene scene = scene_of(
        "x.gltf",
        gltf(kPlaced + R"(,"material":0)", "",
             R"(,"images":[{"uri":"a.png"}],"textures":[{"source":0,"sampler":0}],"samplers":[{)" +
                 sampler +
                 R"(}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])"));
    return std::string(texture_wrap_names.at(
        static_cast<std::size_t>(std::get<ImagemapTexture>(scene.textures.at(0).model).wrap)));
  };
  EXPECT_EQ(wrap(R"("wrapS":33071)"), "clamp");
  EXPECT_EQ(wrap(R"("wrapS":10497)"), "repeat");
  EXPECT_EQ(wrap(""), "repeat");
}

TEST(Gltf, ColoursOfVerticesBesideTexturesAreLeftOut) {
  test::LogOf log;
  const Scene scene = scene_of(
      "x.gltf",
      gltf(
          R"("attributes":{"POSITION":0,"COLOR_0":0},"material":0)", "",
          R"(,"images":[{"uri":"a.png"}],"textures":[{"source":0}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])"));
  EXPECT_EQ(scene.textures.size(), 1U);
  EXPECT_EQ(mesh_of(scene.shapes.at(0)).positions.size(), 3U);
  EXPECT_THAT(log.text(), AllOf(HasSubstr("x.gltf"),
                                HasSubstr("the colours of the vertices of 'it' are left out: its "
                                          "material has textures")));
}

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(Obj, MistakesAreRefusedWithTheirPlace) {
  std::filesystem::create_directory(write_beside("x.obj", "").parent_path() / "folder.mtl");
  const std::pair<std::string, std::string> cases[] = {
      {kCorners + "f 1 x 2\n", "x.obj:4:5: 'x' is no corner"},
      {kCorners + "f 1 2 /2\n", "x.obj:4:7: '/2' is no corner"},
      {kCorners + "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1/1 3\n", "x.obj:6:9: '2/1/1/1' is no corner"},
      {"\nmtllib folder.mtl\n" + kCorners + "f 1 2 3\n", "x.obj:2: "},
      {"mtllib broken.mtl\n" + kCorners + "usemtl a\nf 1 2 3\n",
       "broken.mtl:2: these bytes are no picture"},
  };
  write_beside("broken.mtl", "# a comment\nnewmtl a\nmap_Kd broken.png\n");
  write_beside("broken.png", "");
  for (const auto& [text, said] : cases)
    EXPECT_THAT(complaint([&, &text = text] { scene_of("x.obj", text); }), HasSubstr(said)) << text;
}

TEST(Obj, WhatCannotBeHadIsToldWithItsPlace) {
  test::LogOf log;
  write_beside("glass.mtl", "newmtl glass\nd 0.5\nillum 7\nKd 0.5 0.5 0.5\n");
  const Scene scene = scene_of("y.obj",
                               "mtllib gone.mtl\nmtllib glass.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\n"
                               "v 0 1 0 0 0 1\nusemtl glass\nf 1 2 3\nusemtl brass\no a\nf 1 2 3\n"
                               "o b\nf 1 2 3\n");
  ASSERT_EQ(scene.shapes.size(), 3U);
  EXPECT_TRUE(std::holds_alternative<DielectricMaterial>(
      scene.materials.at(scene.shapes[0].material).model));
  const std::string text = log.text();
  EXPECT_THAT(
      text,
      AllOf(testing::ContainsRegex(
                "y\\.obj:1: the materials of '.*gone\\.mtl' cannot be had: there is no such file"),
            HasSubstr("y.obj:7: the colours of the vertices are left out: the material 'glass' has "
                      "textures or no colour"),
            HasSubstr("y.obj:10: the material 'brass' is in no mtllib: it is grey")));
  EXPECT_EQ(text.find("'brass'"), text.rfind("'brass'"));  // once
}

TEST(Obj, MaterialsHaveImagesOfNumbers) {
  for (const char* name : {"m.png", "r.png", "d.png"}) write_beside(name, "");
  write_beside("maps.mtl", "newmtl a\nPm 1\nmap_Pm m.png\nmap_Pr r.png\nmap_d d.png\n");
  const Scene scene = scene_of("z.obj", "mtllib maps.mtl\n" + kCorners + "usemtl a\nf 1 2 3\n");
  const Shape& shape = scene.shapes.at(0);
  const auto expect_image = [&](std::size_t texture, const char* name) {
    const Texture& one = scene.textures.at(texture);
    EXPECT_TRUE(one.is_float) << name;
    const TextureImage& image = *std::get<ImagemapTexture>(one.model).image;
    EXPECT_EQ(std::filesystem::path(image.file).filename(), name);
    EXPECT_EQ(image.encoding.kind, ImageEncoding::Kind::linear) << name;
  };
  const Material& material = scene.materials.at(shape.material);
  ASSERT_EQ(material.textures.size(), 2U);
  EXPECT_EQ(material.textures[0].field, "metallic");
  expect_image(material.textures[0].texture, "m.png");
  EXPECT_EQ(material.textures[1].field, "roughness");
  expect_image(material.textures[1].texture, "r.png");
  ASSERT_TRUE(shape.alpha && shape.alpha->texture);
  expect_image(*shape.alpha->texture, "d.png");
}

// Robots take the meshes alone: parts by name and material, without a library.
TEST(Obj, MeshesAloneHaveNoMaterials) {
  const std::filesystem::path path = write_beside(
      "parts.obj", "mtllib gone.mtl\n" + kCorners +
                       "v 0 0 9 1 0 0\nvt 0.25 0.5\nvn 0 0 1\nusemtl a\nf 1/1 2/1 3/1\n"
                       "usemtl b\nf 1//1 2//1 3//1\nf 2//1 3//1 4\n");
  test::LogOf log;
  const std::vector<TriangleMeshShape> parts = read_obj_meshes(path, {});
  EXPECT_EQ(log.text(), "");
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(parts[0].uvs, (std::vector<glm::vec2>(3, {0.25F, 0.5F})));
  EXPECT_TRUE(parts[0].normals.empty());
  EXPECT_EQ(parts[1].triangles, (Triangles{{0, 1, 2}, {1, 2, 3}}));
  EXPECT_EQ(parts[1].positions.at(3), glm::vec3(0, 0, 9));
  EXPECT_TRUE(parts[1].normals.empty());  // the last corner has none
  EXPECT_TRUE(parts[1].uvs.empty());
}

// "4OFF" has four coordinates, "nOFF" as many as it says.
TEST(Off, OfOtherThanThreeCoordinatesIsRefused) {
  for (const char* kind : {"4OFF", "nOFF", "C4OFF"})
    EXPECT_THAT(complaint([&] {
                  scene_of("x.off",
                           std::string(kind) + "\n3 1 0\n0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n");
                }),
                AllOf(HasSubstr("x.off:1"),
                      HasSubstr("points of other than three coordinates are not read")))
        << kind;
}

}  // namespace
}  // namespace caplet::mistakes_test
