// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Colours of vertices and faces: what their texture says where rays would ask for it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "import/detail/mesh_file.h"
#include "import/import.h"
#include "support/data.h"
#include "support/import_files.h"

namespace caplet::vertex_colors_test {
namespace {

using glm::vec3;
using testing::HasSubstr;

Scene scene_of(const std::string& name, const std::string& bytes) {
  return import_scene(test::write_file(name, bytes), test::NoImages());
}

/// sRGB by IEC 61966-2-1.
vec3 decoded(vec3 c) {
  for (int k = 0; k < 3; ++k)
    c[k] = c[k] <= 0.04045F ? c[k] / 12.92F : std::pow((c[k] + 0.055F) / 1.055F, 2.4F);
  return c;
}

/// Between the middles of four texels; (0, 0) is the image's lower left corner.
vec3 looked_up(const TextureImage& image, glm::vec2 uv) {
  const float x = uv.x * static_cast<float>(image.width) - 0.5F,
              y = (1 - uv.y) * static_cast<float>(image.height) - 0.5F;
  const float fx = x - std::floor(x), fy = y - std::floor(y);
  const auto texel = [&](float column, float row) {
    const auto i =
        static_cast<std::size_t>(std::clamp(column, 0.0F, static_cast<float>(image.width - 1)));
    const auto j =
        static_cast<std::size_t>(std::clamp(row, 0.0F, static_cast<float>(image.height - 1)));
    const std::size_t at = 3 * (j * static_cast<std::size_t>(image.width) + i);
    return vec3(image.floats[at], image.floats[at + 1], image.floats[at + 2]);
  };
  const float left = std::floor(x), top = std::floor(y);
  return (1 - fy) * ((1 - fx) * texel(left, top) + fx * texel(left + 1, top)) +
         fy * ((1 - fx) * texel(left, top + 1) + fx * texel(left + 1, top + 1));
}

/// The colour of a shape at barycentric coordinates of a triangle.
vec3 color_at(const Scene& scene, const Shape& shape, std::size_t triangle, vec3 part,
              const char* field = "reflectance") {
  const Material& material = scene.materials.at(shape.material);
  if (material.textures.empty()) return vec3(-1);
  EXPECT_EQ(material.textures.at(0).field, field);
  const auto& texture =
      std::get<ImagemapTexture>(scene.textures.at(material.textures.at(0).texture).model);
  EXPECT_STREQ(texture_wrap_names.at(static_cast<std::size_t>(texture.wrap)),
               "clamp");  // as looked_up does
  const auto& mesh = std::get<TriangleMeshShape>(shape.geometry);
  glm::vec2 uv(0);
  for (std::size_t k = 0; k < 3; ++k)
    uv += part[static_cast<glm::length_t>(k)] * mesh.uvs.at(mesh.triangles.at(triangle)[k]);
  return looked_up(*texture.image, uv);
}

constexpr float kClose = 1e-5F;  // floats of uv: 2^-23 of four texels, of colours' differences

TEST(CornerColors, AreInterpolatedLinearly) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> draw(0, 1);
  // 37 triangles: a block of 8 x 8 of four texels, partly used.
  TriangleMeshShape mesh;
  std::vector<vec3> colors;
  for (std::uint32_t i = 0; i < 37; ++i) {
    for (int k = 0; k < 3; ++k) {
      mesh.positions.emplace_back(draw(random), draw(random), draw(random));
      colors.emplace_back(draw(random), draw(random), draw(random));
    }
    mesh.triangles.push_back({3 * i, 3 * i + 2, 3 * i + 1});
  }
  const TriangleMeshShape before = mesh;
  const ImagemapTexture texture = texture_of_corners(mesh, colors);
  EXPECT_EQ(texture.image->width * texture.image->height, 4 * 64);
  ASSERT_EQ(mesh.triangles.size(), 37u);
  for (std::size_t i = 0; i < 37; ++i)
    for (int draws = 0; draws < 20; ++draws) {
      vec3 part(draw(random), draw(random), draw(random));
      part /= part.x + part.y + part.z;
      vec3 expected(0);
      glm::vec2 uv(0);
      for (std::size_t k = 0; k < 3; ++k) {
        const float one = part[static_cast<glm::length_t>(k)];
        expected += one * colors[3 * i + k];
        uv += one * mesh.uvs[mesh.triangles[i][k]];
        EXPECT_EQ(mesh.positions[mesh.triangles[i][k]], before.positions[before.triangles[i][k]]);
      }
      EXPECT_LT(glm::length(looked_up(*texture.image, uv) - expected), kClose) << i;
    }
}

const std::string ply_head =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\n";

TEST(VertexColors, OfPly) {
  const Scene scene = scene_of(
      "v.ply",
      ply_head +
          "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n"
          "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
          "0 0 0 255 0 0 255\n1 0 0 0 255 0 255\n1 1 0 0 0 255 255\n0 1 0 51 102 153 255\n4 0 1 2 "
          "3\n");
  const Shape& shape = scene.shapes.at(0);
  EXPECT_LT(glm::length(color_at(scene, shape, 0, {1, 0, 0}) - vec3(1, 0, 0)), kClose);
  EXPECT_LT(glm::length(color_at(scene, shape, 0, {0, 0.5F, 0.5F}) - vec3(0, 0.5F, 0.5F)), kClose);
  EXPECT_LT(glm::length(color_at(scene, shape, 1, {0, 0, 1}) - decoded({0.2F, 0.4F, 0.6F})),
            kClose);
  // These are colours of faces, as floats; a face that is left out has one as well.
  const Scene faces =
      scene_of("f.ply", ply_head +
                            "element face 3\nproperty list uchar int vertex_indices\nproperty "
                            "float red\nproperty float green\nproperty float "
                            "blue\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 1 .1 .1 .1\n4 0 1 2 "
                            "3 1 0.5 0\n3 0 1 2 0 0 2\n");
  for (const std::size_t triangle : {0u, 1u})
    EXPECT_LT(glm::length(color_at(faces, faces.shapes.at(0), triangle, {0.2F, 0.3F, 0.5F}) -
                          decoded({1, 0.5F, 0})),
              kClose);
  EXPECT_LT(glm::length(color_at(faces, faces.shapes.at(0), 2, {0.2F, 0.3F, 0.5F}) - vec3(0, 0, 1)),
            kClose);
}

TEST(VertexColors, OfObj) {
  const std::string square = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 .2 .4 .6\n";
  const Scene scene = scene_of("v.obj", square + "f 1 2 3\nf 1 3 4\n");
  EXPECT_LT(
      glm::length(color_at(scene, scene.shapes.at(0), 1, {0, 0, 1}) - decoded({0.2F, 0.4F, 0.6F})),
      kClose);
  // To 255; a part some of whose vertices have none has none; a weight is no colour.
  const Scene bytes = scene_of("b.obj",
                               "v 0 0 0 255 0 0\nv 1 0 0 51 102 153\nv 1 1 0 0 0 255\nv 0 1 0 1\no "
                               "a\nf 1 2 3\no b\nf 2 3 4\n");
  EXPECT_LT(
      glm::length(color_at(bytes, bytes.shapes.at(0), 0, {0, 1, 0}) - decoded({0.2F, 0.4F, 0.6F})),
      kClose);
  EXPECT_EQ(color_at(bytes, bytes.shapes.at(1), 0, {1, 0, 0}), vec3(-1));
  // Any channel above 1 shows that the file counts to 255.
  for (int channel = 0; channel < 3; ++channel) {
    const std::string bright[3] = {"255 0 0", "0 255 0", "0 0 255"};
    const Scene one = scene_of(
        "c.obj", "v 0 0 0 " + bright[channel] + "\nv 1 0 0 0 0 0\nv 1 1 0 0 0 0\nf 1 2 3\n");
    vec3 expected(0);
    expected[channel] = 1;
    EXPECT_LT(glm::length(color_at(one, one.shapes.at(0), 0, {1, 0, 0}) - expected), kClose)
        << channel;
  }
  // Times the material's.
  const std::filesystem::path folder =
      test::write_file("half.mtl", "newmtl half\nKd 0.5 0.5 0.25\n").parent_path();
  std::ofstream(folder / "h.obj") << "mtllib half.mtl\nusemtl half\n" << square << "f 1 2 3\n";
  const Scene half = import_scene(folder / "h.obj", test::NoImages());
  EXPECT_LT(
      glm::length(color_at(half, half.shapes.at(0), 0, {0, 0.5F, 0.5F}) - vec3(0, 0.25F, 0.125F)),
      kClose);
}

TEST(VertexColors, OfOff) {
  const Scene vertices = scene_of("v.off",
                                  "CNOFF\n3 1 0\n0 0 0 0 0 1 255 0 0 255\n1 0 0 0 0 1 51 102 "
                                  "153\n1 1 0 0 0 1 0 0 255\n3 0 1 2\n");
  EXPECT_LT(glm::length(color_at(vertices, vertices.shapes.at(0), 0, {0, 1, 0}) -
                        decoded({0.2F, 0.4F, 0.6F})),
            kClose);
  const Scene faces = scene_of(
      "f.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 0.2 0.4 0.6\n3 0 1 2 1 0 0 1\n");
  EXPECT_LT(glm::length(color_at(faces, faces.shapes.at(0), 1, {0.3F, 0.3F, 0.4F}) -
                        decoded({0.2F, 0.4F, 0.6F})),
            kClose);
  EXPECT_LT(glm::length(color_at(faces, faces.shapes.at(0), 2, {0.3F, 0.3F, 0.4F}) - vec3(1, 0, 0)),
            kClose);
  // If only one face has a colour, there is none.
  const Scene one = scene_of("o.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2 1 0 0\n3 0 2 1\n");
  EXPECT_EQ(color_at(one, one.shapes.at(0), 0, {1, 0, 0}), vec3(-1));
}

// Numbers above 1 are bytes, and those above 255 are 255.
TEST(VertexColors, AreWithinTheirRange) {
  EXPECT_EQ(decoded_color({300, 255, 0}, 300), glm::vec3(1, 1, 0));
  EXPECT_EQ(decoded_color({1, -0.5f, 0}, 1), glm::vec3(1, 0, 0));
}

/// A triangle whose corners are red, half green and blue in linear bytes, as a base64 buffer by
/// Python's base64 module.
std::string gltf_text(const std::string& material) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":)"
         R"({"POSITION":0,"COLOR_0":1},"material":0}]}],"materials":[)" +
         material +
         R"(],"buffers":[{"byteLength":48,"uri":"data:application/octet-stream;base64,)"
         "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA/wAA/wCAAP8AAP//"
         R"("}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":12}],"accessors":[)"
         R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
         R"({"bufferView":1,"componentType":5121,"normalized":true,"count":3,"type":"VEC4"}]})";
}

TEST(VertexColors, OfGltf) {
  const Scene scene =
      scene_of("v.gltf", gltf_text(R"({"pbrMetallicRoughness":{"baseColorFactor":[1,0.5,1,1]}})"));
  EXPECT_LT(glm::length(color_at(scene, scene.shapes.at(0), 0, {0, 1, 0}, "base_color") -
                        vec3(0, 0.5F * 128 / 255, 0)),
            kClose);
  EXPECT_LT(glm::length(color_at(scene, scene.shapes.at(0), 0, {0.5F, 0, 0.5F}, "base_color") -
                        vec3(0.5F, 0, 0.5F)),
            kClose);
}

}  // namespace
}  // namespace caplet::vertex_colors_test
