// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// OBJ with MTL, STL, OFF and PLY opened as scenes: the conventions of docs/formats/meshes.md and
// bad input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "import/detail/mesh_file.h"
#include "import/import.h"
#include "support/data.h"
#include "support/import_files.h"

namespace caplet::mesh_files_test {
namespace {

using test::complaint;
using test::OneTexel;
using testing::AllOf;
using testing::HasSubstr;

Scene scene_of(const std::string& name, const std::string& bytes,
               const ImportOptions& options = {}) {
  return import_scene(test::write_file(name, bytes), OneTexel(), options);
}
/// With a file beside it.
Scene scene_beside(const std::string& name, const std::string& bytes, const std::string& other,
                   const std::string& of_other) {
  const std::filesystem::path path = test::write_file(other, of_other).parent_path() / name;
  std::ofstream(path, std::ios::binary) << bytes;
  return import_scene(path, OneTexel());
}
const TriangleMeshShape& mesh_of(const Shape& shape) {
  return std::get<TriangleMeshShape>(shape.geometry);
}
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// What was in the files that were asked for, and how their names ended.
class Seen : public OneTexel {
 public:
  TextureImage read_texture(const std::filesystem::path& path,
                            const ImageEncoding& encoding) const override {
    std::ifstream stream(path, std::ios::binary);
    files.emplace_back(path.extension().string(),
                       std::string(std::istreambuf_iterator<char>(stream), {}));
    return OneTexel::read_texture(path, encoding);
  }
  mutable std::vector<std::pair<std::string, std::string>> files;
};

// glTF 2.0, 3.10.1: an image is a file, a data URI or a view of a buffer.
TEST(Gltf, ImagesAreWithinTheFileOrBesideIt) {
  // "\x89PNG" and "\xff\xd8\xff\xe0" in base64; a triangle, and behind it the first of both.
  std::string buffer(36, '\0');
  const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::memcpy(buffer.data(), corners, sizeof corners);
  const std::filesystem::path folder = test::write_file("t.bin", buffer + "\x89PNG").parent_path();
  std::ofstream(folder / "beside.png") << "beside";
  std::ofstream(folder / "\xc3\xa4 [k].png") << "coded";
  const auto seen = [&](const std::string& image) {
    std::ofstream(folder / "t.gltf")
        << R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"material":0,"attributes":{"POSITION":0}}]}],)"
        << R"("materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"textures":[{"source":0}],"images":[)"
        << image
        << R"(],"buffers":[{"byteLength":40,"uri":"t.bin"}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":4}],)"
        << R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}]})";
    const Seen images;
    import_scene(folder / "t.gltf", images);
    return images.files;
  };
  using Files = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(seen(R"({"uri":"data:image/png;base64,iVBORw=="})"), (Files{{".png", "\x89PNG"}}));
  EXPECT_EQ(seen(R"({"uri":"data:image/jpeg;base64,/9j/4A=="})"),
            (Files{{".jpg", "\xff\xd8\xff\xe0"}}));
  EXPECT_EQ(seen(R"({"bufferView":1,"mimeType":"image/png"})"), (Files{{".png", "\x89PNG"}}));
  EXPECT_EQ(seen(R"({"uri":"beside.png"})"), (Files{{".png", "beside"}}));
  for (const char* uri :
       {"%c3%a4%20%5bk%5d.png", "%C3%A4%20%5Bk%5D.png"})  // RFC 3986, 2.1: letters of either case
    EXPECT_EQ(seen(std::string(R"({"uri":")") + uri + R"("})"), (Files{{".png", "coded"}})) << uri;
}

TEST(Gltf, LinesAreNoShapes) {
  const Scene scene = scene_of(
      "l.gltf",
      R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":1},)"
      R"({"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":39,"uri":"data:;base64,)" +
          std::string(52, 'A') + R"("}]})");
  ASSERT_EQ(scene.shapes.size(), 1U);
  EXPECT_EQ(mesh_of(scene.shapes[0]).triangles.size(), 1U);
}

// glTF 2.0, 5.11: a view lies within its buffer.
TEST(Gltf, ViewsLieWithinTheirBuffers) {
  const auto said = [](const std::string& view) {
    return complaint([&] {
      scene_of(
          "v.gltf",
          R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
          R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,)" +
              view + R"(}],"buffers":[{"byteLength":39,"uri":"data:;base64,)" +
              std::string(52, 'A') + R"("}]})");
    });
  };
  EXPECT_EQ(said(R"("byteLength":36)"), "");
  EXPECT_EQ(said(R"("byteOffset":3,"byteLength":36)"), "");
  for (const char* view : {R"("byteOffset":4,"byteLength":36)", R"("byteOffset":40,"byteLength":0)",
                           R"("byteLength":40)", R"("byteOffset":-4,"byteLength":36)",
                           R"("byteOffset":36,"byteLength":-36)"})
    EXPECT_THAT(said(view), HasSubstr("buffer view 0 goes from byte")) << view;
}

TEST(Stl, TextMayHaveEmptyLines) {
  const Scene scene = scene_of(
      "t.stl",
      "solid a\n\nfacet normal 0 0 1\n \nouter loop\nvertex 0 0 0\n\nvertex 1 0 0\nvertex 0 2 0\n"
      "endloop\nendfacet\n\nendsolid a\n\n");
  EXPECT_EQ(mesh_of(scene.shapes.at(0)).positions,
            (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}));
}

// docs/formats/ply.md: the names that programs give to texture coordinates.
TEST(PlyFiles, NamesOfTextureCoordinates) {
  for (const auto& [u, v] :
       {std::pair("u", "v"), std::pair("s", "t"), std::pair("texture_u", "texture_v"),
        std::pair("texture_s", "texture_t")}) {
    const Scene scene =
        scene_of("t.ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float "
                 "y\nproperty float z\n" +
                     std::string("property float ") + u + "\nproperty float " + v +
                     "\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                     "0 0 0 .25 .5\n1 0 0 .75 1\n0 1 0 0 .125\n3 0 1 2\n");
    EXPECT_EQ(mesh_of(scene.shapes.at(0)).uvs,
              (std::vector<glm::vec2>{{0.25F, 0.5F}, {0.75F, 1}, {0, 0.125F}}))
        << u;
  }
}

TEST(Obj, CornersOfAllKinds) {
  const Scene scene = scene_of(
      "a.obj",
      "# a square and a triangle\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvn 0 0 1\n"
      "f 1/1/1 2/2/1 3/2/1 4/1/1\no second\nf -4//-1 -3//-1 \\\n-2//-1\ng third\nf 1/1 2/2 3/2\nl "
      "1 2\n");
  ASSERT_EQ(scene.shapes.size(), 3u);
  const TriangleMeshShape& square = mesh_of(scene.shapes[0]);
  EXPECT_EQ(square.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(square.positions[2], glm::vec3(1, 1, 0));
  EXPECT_EQ(square.uvs[1], glm::vec2(1, 1));
  EXPECT_EQ(square.normals[3], glm::vec3(0, 0, 1));
  EXPECT_EQ(scene.shapes[0].name, "a");
  EXPECT_EQ(scene.shapes[1].name, "second");
  EXPECT_TRUE(mesh_of(scene.shapes[1]).uvs.empty());
  EXPECT_EQ(mesh_of(scene.shapes[1]).normals.size(), 3u);
  EXPECT_EQ(mesh_of(scene.shapes[1]).positions[0], glm::vec3(0, 0, 0));
  EXPECT_TRUE(mesh_of(scene.shapes[2]).normals.empty());
  EXPECT_EQ(mesh_of(scene.shapes[2]).uvs.size(), 3u);
}

/// Areas of a shape's triangles, along z.
double area_of(const Shape& shape) {
  const TriangleMeshShape& mesh = mesh_of(shape);
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3 p(mesh.positions[a]), q(mesh.positions[b]), r(mesh.positions[c]);
    EXPECT_GE(glm::cross(q - p, r - p).z, 0);
    sum += glm::cross(q - p, r - p).z / 2;
  }
  return sum;
}

// An arrow head, an L and a comb: triangles of positive areas that add up to theirs, which a fan's
// do not.
TEST(Polygons, ThatAreNotConvexAreCutAtTheirEars) {
  const char* head = "v 0 0 0\nv 2 -1 0\nv 0.5 0 0\nv 2 1 0\n";
  for (const char* face : {"f 1 2 3 4\n", "f 2 3 4 1\n", "f 3 4 1 2\n", "f 4 1 2 3\n"}) {
    const Scene scene = scene_of("h.obj", std::string(head) + face);
    EXPECT_EQ(mesh_of(scene.shapes[0]).triangles.size(), 2u);
    EXPECT_DOUBLE_EQ(area_of(scene.shapes[0]), 0.5) << face;
  }
  const Scene l =
      scene_of("l.off", "OFF\n6 1 0\n3 1 0\n1 1 0\n1 3 0\n0 3 0\n0 0 0\n3 0 0\n6 0 1 2 3 4 5\n");
  EXPECT_EQ(mesh_of(l.shapes[0]).triangles.size(), 4u);
  EXPECT_DOUBLE_EQ(area_of(l.shapes[0]), 5);
  std::string comb = "v 10 -1 0\n";
  std::string face = "f 1";
  for (int i = 10; i >= 0; --i) {
    comb += "v " + std::to_string(i) + (i % 2 == 0 ? " 1 0\n" : " 0 0\n");
    face += " " + std::to_string(12 - i);
  }
  comb += "v 0 -1 0\n";
  const Scene teeth = scene_of("c.obj", comb + face + " 13\n");
  EXPECT_EQ(mesh_of(teeth.shapes[0]).triangles.size(), 11u);
  EXPECT_DOUBLE_EQ(area_of(teeth.shapes[0]), 15);
}

TEST(Polygons, AreFansWhereNothingElseIsThere) {
  using Cut = std::vector<std::array<std::uint32_t, 3>>;
  const auto cut = [](const std::vector<glm::vec3>& corners) { return triangles_of(corners); };
  EXPECT_EQ(cut({}), Cut());
  EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}}), Cut());
  const Cut quad{{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}), quad);
  EXPECT_EQ(cut({{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {0, 1, 0}}), quad);  // the other way around
  EXPECT_EQ(cut({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}), quad);  // of no area as a whole
  EXPECT_EQ(cut({{2, 2, 2}, {2, 2, 2}, {2, 2, 2}, {2, 2, 2}}), quad);
}

// Whatever it is, also what crosses itself after some ears were cut: two fewer triangles than
// corners.
TEST(Polygons, HaveTwoTrianglesFewerThanCorners) {
  std::mt19937 random(7);
  for (int i = 0; i < 20000; ++i) {
    std::vector<glm::vec3> corners(3 + random() % 7);
    for (glm::vec3& corner : corners)
      corner = {static_cast<float>(random() % 8), static_cast<float>(random() % 8), 0};
    ASSERT_EQ(triangles_of(corners).size(), corners.size() - 2);
  }
}

TEST(Obj, FacesOfFewerThanThreeCornersAreLeftOut) {
  const Scene scene = scene_of("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\nf 1\nf 1 2 3\n");
  EXPECT_EQ(mesh_of(scene.shapes.at(0)).triangles.size(), 1u);
}

TEST(Obj, MaterialsAreThoseOfTheLibrary) {
  const std::string library =
      "newmtl red\nKd 0.8 0.1 0.1\nnewmtl metal\nKd .9 .9 .9\nKs 1 1 1\nPm 1\nPr 0.25\nmap_Kd -s 2 "
      "2 1 a picture.png\n"
      "newmtl glass\nd 0.2\nNi 1.4\nillum 7\nnewmtl lamp\nKe 3 2 1\nnewmtl thin\nd 0.5\nnewmtl "
      "glossy\nKs .5 .5 .5\nNs 30\n";
  std::string text = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const char* name : {"red", "metal", "glass", "lamp", "thin", "glossy"})
    text += std::string("usemtl ") + name + "\nf 1 2 3\n";
  const std::filesystem::path folder = test::write_file("m.mtl", library).parent_path();
  std::ofstream(folder / "m.obj") << text;
  // Without the image: the colour alone.
  const Scene without = import_scene(folder / "m.obj", OneTexel());
  EXPECT_FALSE(texture_of(without.materials[without.shapes.at(1).material], "base_color"));
  std::ofstream(folder / "a picture.png") << "for the reader of images";
  const Scene scene = import_scene(folder / "m.obj", OneTexel());
  ASSERT_EQ(scene.shapes.size(), 6u);
  const auto material = [&](std::size_t i) -> const Material& {
    return scene.materials[scene.shapes[i].material];
  };
  EXPECT_EQ(std::get<RgbSpectrum>(std::get<DiffuseMaterial>(material(0).model).reflectance).rgb,
            glm::dvec3(0.8F, 0.1F, 0.1F));
  const auto& metal = std::get<PrincipledMaterial>(material(1).model);
  EXPECT_EQ(metal.metallic, 1);
  EXPECT_EQ(metal.roughness, 0.25);
  ASSERT_TRUE(texture_of(material(1), "base_color"));
  const Texture& texture = scene.textures.at(*texture_of(material(1), "base_color"));
  EXPECT_EQ(std::filesystem::path(std::get<ImagemapTexture>(texture.model).image->file).filename(),
            "a picture.png");
  EXPECT_EQ(std::get<ImagemapTexture>(texture.model).image->encoding.kind,
            ImageEncoding::Kind::srgb);
  EXPECT_FALSE(texture.is_float);
  EXPECT_EQ(std::get<ConstantSpectrum>(std::get<DielectricMaterial>(material(2).model).eta).value,
            static_cast<double>(1.4F));
  ASSERT_TRUE(scene.shapes[3].emission);
  EXPECT_EQ(std::get<RgbSpectrum>(scene.shapes[3].emission->radiance).rgb, glm::dvec3(3, 2, 1));
  ASSERT_TRUE(scene.shapes[4].alpha);
  EXPECT_EQ(std::get<ConstantSpectrum>(scene.shapes[4].alpha->value).value, 0.5);
  // Ns 30: alpha^2 = 2 / 32, so alpha = 1/4 and the roughness 1/2.
  EXPECT_NEAR(std::get<PrincipledMaterial>(material(5).model).roughness, 0.5, 1e-12);
  EXPECT_TRUE(scene.automatic_camera);
}

// What is seen of a surface: `d`, or 1 less `Tr`, in which MTL's writers say the same.
TEST(Obj, TransparencyIsOneLessOpacity) {
  const auto seen = [](const std::string& statement) {
    const Scene scene =
        scene_beside("t.obj", "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n",
                     "t.mtl", "newmtl a\n" + statement + "\n");
    const auto& alpha = scene.shapes.at(0).alpha;
    return alpha ? std::get<ConstantSpectrum>(alpha->value).value : 1;
  };
  EXPECT_EQ(seen("Tr 0.375"), 0.625);
  EXPECT_EQ(seen("d 0.625"), 0.625);
  EXPECT_EQ(seen("d -halo 0.25"), 1);
  EXPECT_EQ(seen("Tr 0"), 1);
  EXPECT_EQ(seen("Tr 1"), 0);
  EXPECT_EQ(seen("d 0.75\nTr 0.5"), 0.5);  // the last
}

std::string binary_stl(std::uint32_t announced, const std::vector<std::array<float, 9>>& facets) {
  std::string out(80, ' ');
  out.append(reinterpret_cast<const char*>(&announced), 4);
  for (const std::array<float, 9>& corners : facets) {
    out.append(12, '\0');
    out.append(reinterpret_cast<const char*>(corners.data()), 36);
    out.append(2, '\0');
  }
  return out;
}

TEST(Stl, BothKindsAreWelded) {
  const std::string text =
      "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\nfacet normal 0 0 "
      "1\nouter loop\nvertex 1 0 0\nvertex 1 1 0\nvertex -0 1 0\nendloop\nendfacet\nendsolid x\n";
  for (const std::string& bytes :
       {text, binary_stl(2, {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {1, 0, 0, 1, 1, 0, -0.0F, 1, 0}})}) {
    const Scene scene = scene_of("two.stl", bytes);
    EXPECT_EQ(mesh_of(scene.shapes.at(0)).positions.size(), 4u);
    EXPECT_EQ(mesh_of(scene.shapes[0]).triangles, (Triangles{{0, 1, 2}, {1, 3, 2}}));
    // z is up: it goes to y, and y to -z.
    const glm::dmat4& m = scene.shapes[0].world_from_object;
    EXPECT_EQ(glm::dvec3(m * glm::dvec4(1, 2, 3, 1)), glm::dvec3(1, 3, -2));
  }
}

TEST(Up, IsAnyAxis) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const auto moved = [&](const char* up) {
    return glm::dvec3(scene_of("u.obj", text, {{{"up", up}}}).shapes.at(0).world_from_object *
                      glm::dvec4(1, 2, 3, 1));
  };
  EXPECT_EQ(moved("y"), glm::dvec3(1, 2, 3));
  EXPECT_EQ(moved("z"), glm::dvec3(1, 3, -2));
  EXPECT_EQ(moved("x"), glm::dvec3(-2, 1, 3));
  EXPECT_THAT(complaint([&] { moved("w"); }), AllOf(HasSubstr("--up"), HasSubstr("x, y, z")));
}

TEST(Off, WithColoursAndComments) {
  const Scene scene = scene_of("c.off",
                               "COFF # colours\n4 2 0\n0 0 0 255 0 0 255\n1 0 0 1 1 1 1\n# more\n1 "
                               "1 0\n0 1 0\n4 0 1 2 3 9 9 9\n3 0 1 2\n");
  EXPECT_EQ(mesh_of(scene.shapes.at(0)).triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
  EXPECT_EQ(mesh_of(scene.shapes[0]).positions[2], glm::vec3(1, 1, 0));
}

TEST(Ply, IsASceneOfItsOwn) {
  const Scene scene = scene_of(
      "t.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face "
      "1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_EQ(mesh_of(scene.shapes.at(0)).triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(scene.shapes[0].name, "t");
  EXPECT_FALSE(scene.lights.empty());
}

/// A triangle (0 0 0, 1 0 0, 0 1 0) with uvs and indices of bytes, as a base64 buffer by Python's
/// base64 module.
std::string gltf_text(const std::string& nodes, const std::string& more = "",
                      const std::string& material = "") {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":)" + nodes +
         R"(,"meshes":[{"name":"tri","primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2)" +
         material +
         R"(}]}],"buffers":[{"byteLength":63,"uri":"data:application/octet-stream;base64,)"
         "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAEC"
         R"("}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},{"buffer":0,"byteOffset":60,"byteLength":3}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"},)"
         R"({"bufferView":2,"componentType":5121,"count":3,"type":"SCALAR"}])" +
         more + "}";
}

TEST(Gltf, NodesPlaceMeshes) {
  // 90 degrees about z, then moved: x goes to y.
  const Scene one = scene_of(
      "n.gltf",
      gltf_text(
          R"([{"mesh":0,"name":"here","translation":[1,2,3],"rotation":[0,0,0.7071067811865476,0.7071067811865476],"scale":[2,1,1]}])"));
  ASSERT_EQ(one.shapes.size(), 1u);
  EXPECT_EQ(one.shapes[0].name, "here");
  EXPECT_EQ(mesh_of(one.shapes[0]).triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(mesh_of(one.shapes[0]).positions[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(mesh_of(one.shapes[0]).uvs[2], glm::vec2(0, 0));  // (0, 1) from the top
  EXPECT_LT(glm::length(glm::dvec3(one.shapes[0].world_from_object * glm::dvec4(1, 0, 0, 1)) -
                        glm::dvec3(1, 4, 3)),
            1e-12);
  // A parent's matrix, by columns; two nodes of one mesh are instances.
  const Scene two = scene_of(
      "t.gltf",
      gltf_text(
          R"([{"children":[1,2],"matrix":[0,1,0,0,-1,0,0,0,0,0,1,0,5,0,0,1]},{"mesh":0,"translation":[1,0,0]},{"mesh":0}])"));
  ASSERT_EQ(two.instances.size(), 2u);
  EXPECT_EQ(glm::dvec3(two.instances[0].world_from_object * glm::dvec4(0, 0, 0, 1)),
            glm::dvec3(5, 1, 0));
  EXPECT_EQ(glm::dvec3(two.instances[1].world_from_object * glm::dvec4(1, 0, 0, 1)),
            glm::dvec3(5, 1, 0));
}

TEST(Gltf, MaterialsCamerasAndLights) {
  const Scene scene = scene_of(
      "m.gltf",
      gltf_text(
          R"([{"mesh":0,"children":[1,2]},{"camera":0,"translation":[0,0,4]},{"extensions":{"KHR_lights_punctual":{"light":0}},"translation":[0,3,0]}])",
          R"(,"materials":[{"name":"gold","pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0.25,0.75],"metallicFactor":0.9,"roughnessFactor":0.2},)"
          R"("alphaMode":"BLEND","emissiveFactor":[0.1,0.2,0.3],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":10},)"
          R"("KHR_materials_ior":{"ior":1.33},"KHR_materials_clearcoat":{"clearcoatFactor":0.5}}}],)"
          R"("cameras":[{"type":"perspective","perspective":{"yfov":0.5,"znear":0.1}}],)"
          R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":683,"color":[1,0.5,0]}]}})",
          R"(,"material":0)"));
  const auto& gold =
      std::get<PrincipledMaterial>(scene.materials.at(scene.shapes.at(0).material).model);
  EXPECT_EQ(std::get<RgbSpectrum>(gold.base_color).rgb, glm::dvec3(1, 0.5, 0.25));
  EXPECT_EQ(gold.metallic, 0.9);
  EXPECT_EQ(gold.roughness, 0.2);
  EXPECT_EQ(gold.eta, 1.33);
  EXPECT_EQ(gold.coat, 0.5);
  EXPECT_EQ(std::get<ConstantSpectrum>(scene.shapes[0].alpha.value().value).value, 0.75);
  EXPECT_LT(glm::length(std::get<RgbSpectrum>(scene.shapes[0].emission.value().radiance).rgb -
                        glm::dvec3(1, 2, 3)),
            1e-12);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].scale, 1);
  EXPECT_EQ(std::get<PointLight>(scene.lights[0].model).position, glm::dvec3(0, 3, 0));
  EXPECT_EQ(fov_of(scene.view.camera), 0.5);
  EXPECT_FALSE(scene.automatic_camera);
  // It looks along -z, y up, x right.
  EXPECT_EQ(glm::dvec3(scene.view.camera.world_from_camera * glm::dvec4(1, 2, 3, 1)),
            glm::dvec3(1, 2, 1));
}

TEST(Gltf, TexturesOfChannels) {
  const Scene scene = scene_of(
      "x.gltf",
      gltf_text(
          R"([{"mesh":0}])",
          R"(,"images":[{"uri":"a%20b.png"}],"textures":[{"source":0}],"materials":[{"pbrMetallicRoughness":{"roughnessFactor":0.5,)"
          R"("metallicRoughnessTexture":{"index":0,"extensions":{"KHR_texture_transform":{"scale":[2,4],"offset":[0.25,0.5]}}},"baseColorTexture":{"index":0}}}])",
          R"(,"material":0)"));
  const Material& material = scene.materials.at(scene.shapes.at(0).material);
  const auto map = [&](const char* field) {
    return std::get<ImagemapTexture>(scene.textures.at(*texture_of(material, field)).model);
  };
  EXPECT_EQ(std::filesystem::path(map("base_color").image->file).filename(), "a b.png");
  EXPECT_EQ(map("base_color").image->encoding.kind, ImageEncoding::Kind::srgb);
  // The one texel is 10, 20, 30 of 255.
  EXPECT_EQ(map("roughness").image->channels, 1);
  EXPECT_EQ(map("roughness").image->floats, (std::vector<float>{0.5F * (20.0F / 255.0F)}));
  EXPECT_EQ(map("metallic").image->floats, (std::vector<float>{30.0F / 255.0F}));
  EXPECT_EQ(map("metallic").mapping.uscale, 2);
  EXPECT_EQ(map("metallic").mapping.udelta, 0.25);
  // v from the bottom is 1 - (4 (1 - v) + 0.5).
  EXPECT_EQ(map("metallic").mapping.vscale, 4);
  EXPECT_EQ(map("metallic").mapping.vdelta, -3.5);
}

/// A glTF file of one triangle with this material; its textures are "one.png" and "two.png".
Scene with_material(const std::string& material) {
  return scene_of(
      "x.gltf",
      gltf_text(
          R"([{"mesh":0}])",
          R"(,"images":[{"uri":"one.png"},{"uri":"two.png"}],"textures":[{"source":0},{"source":1}],)"
          R"("materials":[{"name":"it",)" +
              material + "}]",
          R"(,"material":0)"));
}

// Alpha is that of the base colour, times its factor; what is masked is there or not.
TEST(Gltf, AlphaModes) {
  const auto alpha = [](const std::string& mode, const std::string& texture,
                        const std::string& factor) {
    const Scene scene =
        with_material(mode + R"("pbrMetallicRoughness":{"baseColorTexture":{"index":)" + texture +
                      R"(},"baseColorFactor":[1,1,0.5,)" + factor + "]}");
    const auto& by = scene.shapes.at(0).alpha;
    if (!by) return std::vector<float>();
    if (!by->texture)
      return std::vector<float>{static_cast<float>(std::get<ConstantSpectrum>(by->value).value)};
    const Texture& map = scene.textures.at(*by->texture);
    EXPECT_TRUE(map.is_float);
    EXPECT_EQ(std::get<ImagemapTexture>(map.model).image->width, 2);
    return std::get<ImagemapTexture>(map.model).image->floats;
  };
  const std::string blend = R"("alphaMode":"BLEND",)", mask = R"("alphaMode":"MASK",)",
                    opaque = R"("alphaMode":"OPAQUE",)";
  using Values = std::vector<float>;
  EXPECT_THAT(alpha(blend, "1", "1"),
              testing::Pointwise(testing::FloatEq(), Values{100 / 255.0F, 200 / 255.0F}));
  EXPECT_THAT(alpha(blend, "1", "0.5"),
              testing::Pointwise(testing::FloatEq(), Values{50 / 255.0F, 100 / 255.0F}));
  EXPECT_EQ(alpha(mask, "1", "1"), (Values{0, 1}));
  EXPECT_EQ(alpha(mask + R"("alphaCutoff":0.25,)", "1", "1"), (Values{1, 1}));
  EXPECT_EQ(alpha(mask + R"("alphaCutoff":0.25,)", "1", "0.5"), (Values{0, 1}));
  EXPECT_EQ(alpha(blend, "0", "1"), Values());
  EXPECT_EQ(alpha(blend, "0", "0.75"), Values{0.75});
  EXPECT_EQ(alpha(mask, "0", "0.75"), Values{1});
  EXPECT_EQ(alpha(mask, "0", "0.25"), Values{0});
  EXPECT_EQ(alpha(opaque, "1", "0.5"), Values());
  EXPECT_EQ(alpha("", "1", "0.5"), Values());
}

TEST(Gltf, ColoursOfTexturesAreTinted) {
  const Scene scene = with_material(
      R"("emissiveFactor":[0.5,1,2],"emissiveTexture":{"index":1},"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4}},)"
      R"("pbrMetallicRoughness":{"baseColorTexture":{"index":1},"baseColorFactor":[1,0.5,0.25,1]})");
  const Material& material = scene.materials.at(scene.shapes.at(0).material);
  const auto& image =
      *std::get<ImagemapTexture>(scene.textures.at(*texture_of(material, "base_color")).model)
           .image;
  EXPECT_EQ(image.channels, 3);
  EXPECT_THAT(image.floats,
              testing::Pointwise(testing::FloatEq(),
                                 std::vector<float>{10 / 255.0F, 10 / 255.0F, 7.5F / 255,  //
                                                    40 / 255.0F, 25 / 255.0F, 15 / 255.0F}));
  const AreaEmission& emission = scene.shapes[0].emission.value();
  EXPECT_TRUE(emission.two_sided);
  ASSERT_TRUE(emission.image);
  EXPECT_EQ(emission.image->width, 2);
  EXPECT_EQ(emission.image->height, 1);
  EXPECT_THAT(emission.image->rgb,
              testing::Pointwise(testing::FloatEq(),
                                 std::vector<float>{20 / 255.0F, 80 / 255.0F, 240 / 255.0F,  //
                                                    80 / 255.0F, 200 / 255.0F, 480 / 255.0F}));
}

// Colours are (x + 1, y + 1, z + 1) / 2; a scale is of x and y.
TEST(Gltf, NormalTextures) {
  const auto map_of = [](const std::string& more) -> std::shared_ptr<const TextureImage> {
    const Scene scene = with_material(R"("normalTexture":{"index":0)" + more + "}");
    const auto& map = scene.materials.at(scene.shapes.at(0).material).normalmap;
    return map ? std::get<NormalmapTexture>(scene.textures.at(*map).model).image : nullptr;
  };
  const auto plain = map_of("");
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->encoding.kind, ImageEncoding::Kind::linear);
  EXPECT_EQ(plain->bytes, (std::vector<std::uint8_t>{10, 20, 30}));
  const glm::dvec3 n(20 / 255.0 - 1, 40 / 255.0 - 1, 60 / 255.0 - 1);
  const glm::dvec3 half = glm::normalize(n * glm::dvec3(0.5, 0.5, 1));
  const auto scaled = map_of(R"(,"scale":0.5)");
  ASSERT_TRUE(scaled);
  ASSERT_EQ(scaled->floats.size(), 3U);
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(scaled->floats[static_cast<std::size_t>(k)], (half[k] + 1) / 2, 1e-6) << k;
  EXPECT_FALSE(map_of(R"(,"scale":0)"));
  EXPECT_FALSE(map_of(R"(,"extensions":{"KHR_texture_transform":{"scale":[2,2]}})"));
  EXPECT_FALSE(map_of(R"(,"extensions":{"KHR_texture_transform":{"offset":[0,0.5]}})"));
}

// The picture has the shape of the camera's window.
TEST(Gltf, OrthographicCameras) {
  const auto with = [](const std::string& window) {
    return scene_of("x.gltf",
                    gltf_text(R"([{"mesh":0,"children":[1]},{"camera":0,"translation":[0,0,4]}])",
                              R"(,"cameras":[{"type":"orthographic","orthographic":{)" + window +
                                  R"("znear":0.1,"zfar":9}}])"));
  };
  const Scene scene = with(R"("xmag":4,"ymag":1,)");
  EXPECT_EQ(fov_of(scene.view.camera), 0);
  EXPECT_EQ(scene.view.camera.screen_window, (std::array<double, 4>{-4, 4, -1, 1}));
  EXPECT_EQ(scene.view.film.height, scene.view.film.width / 4);
  EXPECT_FALSE(scene.automatic_camera);
  EXPECT_EQ(glm::dvec3(scene.view.camera.world_from_camera * glm::dvec4(1, 2, 3, 1)),
            glm::dvec3(1, 2, 1));
  for (const char* bad :
       {R"("xmag":0,"ymag":1,)", R"("xmag":1,"ymag":0,)", R"("xmag":1,"ymag":1e9,)"})
    EXPECT_THAT(complaint([&] { with(bad); }), HasSubstr("xmag and ymag")) << bad;
}

TEST(Gltf, BinaryFiles) {
  std::string json =
      R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":5}]}],)"
      R"("buffers":[{"byteLength":48}],"bufferViews":[{"buffer":0,"byteLength":48}],"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}]})";
  while (json.size() % 4 != 0) json += ' ';
  const float points[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  std::string out = "glTF";
  const auto put = [&](std::uint32_t value) {
    out.append(reinterpret_cast<const char*>(&value), 4);
  };
  put(2);
  put(static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + sizeof points));
  put(static_cast<std::uint32_t>(json.size()));
  put(0x4e4f534a);
  out += json;
  put(sizeof points);
  put(0x004e4942);
  out.append(reinterpret_cast<const char*>(points), sizeof points);
  const Scene scene = scene_of("b.glb", out);
  EXPECT_EQ(mesh_of(scene.shapes.at(0)).triangles, (Triangles{{0, 1, 2}, {1, 3, 2}}));
  EXPECT_THAT(complaint([&] { scene_of("b.glb", out.substr(0, out.size() - 4)); }),
              AllOf(HasSubstr("b.glb"), HasSubstr("bytes are announced")));
}

// Counts by trimesh.
TEST(SharedMeshes, HaveTheCountsOfOthers) {
  CAPLET_NEEDS_DATA();
  const auto primitives = [](const char* file) {
    const Scene scene = import_scene(test::data_folder() / "meshes" / file, OneTexel());
    std::size_t count = 0;
    for (const Shape& shape : scene.shapes) count += mesh_of(shape).triangles.size();
    return count;
  };
  EXPECT_EQ(primitives("spot/spot.obj"), 5856u);
  EXPECT_EQ(primitives("trimesh/unit_sphere.STL"), 1280u);
  EXPECT_EQ(primitives("bevy_small/CornellBox.glb"), 36u);
  EXPECT_EQ(primitives("bevy_small/sphere.gltf"), 3968u);
  EXPECT_EQ(primitives("bevy_small/torus.gltf"), 3072u);
  EXPECT_EQ(count_primitives(import_scene(
                test::data_folder() / "meshes/2CylinderEngine/2CylinderEngine.glb", OneTexel())),
            (std::map<std::string, std::uint64_t>{{"triangle", 121496}}));
}

struct Bad {
  const char *name, *text, *says;
};
void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.text; }
class BadMesh : public testing::TestWithParam<Bad> {};
TEST_P(BadMesh, IsRefusedAtItsPlace) {
  const Bad& bad = GetParam();
  EXPECT_THAT(complaint([&] { scene_of(bad.name, bad.text); }),
              AllOf(HasSubstr(bad.name), HasSubstr(bad.says)));
}
INSTANTIATE_TEST_SUITE_P(
    All, BadMesh,
    testing::Values(
        Bad{"a.obj", "v 0 0 0\n", "no faces"}, Bad{"b.obj", "v 0 0\n", ":1:6: a number is missing"},
        Bad{"c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", ":4:7: '4': there are 3"},
        Bad{"d.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 4\n", ":4:5:"},
        Bad{"e.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 0 2\n", ":4:5:"},
        Bad{"f.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/9 2/1 3/1\n", ":4:3:"},
        Bad{"g.obj", "v 0 nan 0\n", ":1:5:"}, Bad{"h.obj", "v 0 0 0\nf 1 1/2/3/4 1\n", ":2:5:"},
        Bad{"a.stl", "hello\n", ":1:1:"},
        Bad{"b.stl", "solid x\nfacet\nvertex 0 0 0\n", ":3:1: a vertex outside"},
        Bad{"c.stl", "solid x\nouter loop\nvertex 0 0 0\n", "ends within"},
        Bad{"d.stl", "solid x\nouter loop\nvertex 0 0 0\nendloop\n", ":4:1:"},
        Bad{"e.stl", "solid x\nendsolid x\n", "no faces"},
        Bad{"f.stl", "solid x\nfacet\nbox 1 2\n", ":3:1: 'box'"},
        Bad{"a.off", "OFF\n1000000000 1 0\n0 0 0\n", ":3:"}, Bad{"b.off", "PLY\n", ":1:"},
        Bad{"c.off", "OFF\n1 1 0\n0 0 0\n3 0 0 1\n", ":4: vertex 1: there are 1"},
        Bad{"d.off", "OFF\n1 -1 0\n", ":2:"}, Bad{"e.off", "OFF\n-1 0 0\n", "a count is negative"},
        Bad{"a.gltf", "{\n  \"asset\": }", ":2:12:"}, Bad{"b.gltf", "{}", "glTF 2.0"},
        Bad{"c.gltf", R"({"asset":{"version":"2.0"}})", "no triangles"},
        Bad{"d.gltf", R"({"asset":{"version":"2.0"},"nodes":[{"children":[0]}]})", "cycles"},
        Bad{"e.gltf", R"({"asset":{"version":"2.0"},"nodes":[{"mesh":3}]})", "mesh 3: there are 0"},
        Bad{"f.gltf", R"({"asset":{"version":"2.0"},"nodes":{"mesh":3}})", "nodes is no list"},
        Bad{"g.gltf",
            R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"]})",
            "KHR_draco"},
        Bad{"h.gltf",
            R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":1000000000,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":3}],"buffers":[{"byteLength":3,"uri":"data:;base64,AAAA"}]})",
            "1000000000 elements beyond its 3 bytes"},
        Bad{"a.ply", "ply\n", "a.ply"}),
    [](const auto& of) {
      std::string name = of.param.name;
      name[1] = '_';
      return name;
    });

TEST(BadMeshes, OfBinaryStl) {
  EXPECT_THAT(complaint([] {
                scene_of("s.stl", binary_stl(3, {{0, 0, 0, 1, 0, 0, 0, 1, 0}}));
              }),
              AllOf(HasSubstr("3 facets are announced"), HasSubstr("234 bytes"), HasSubstr("134")));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(complaint([&] {
                scene_of("n.stl", binary_stl(1, {{0, 0, 0, nan, 0, 0, 0, 1, 0}}));
              }),
              HasSubstr("corner 2 of facet 1"));
}

TEST(BadMeshes, OfNumbersBeyondDoubles) {
  EXPECT_THAT(complaint([] { scene_of("x.gltf", "{\n  \"asset\": 5e999}"); }),
              AllOf(HasSubstr("x.gltf:2:12: "), HasSubstr("the number 5e999 is out of range")));
}

// 3,000 primitives that share 96 KB of vertices, which take 1.2 GB as floats; without indices none
// of them is kept.
TEST(BadMeshes, OfWhatIsSharedTooOften) {
  std::string primitives;
  for (int i = 0; i < 3000; ++i)
    primitives += std::string(i == 0 ? "" : ",") + R"({"attributes":{"POSITION":0},"indices":1})";
  const std::string text =
      R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[)" + primitives +
      R"(]}],"accessors":[{"bufferView":0,"componentType":5120,"count":32768,"type":"VEC3"},)" +
      R"({"bufferView":0,"componentType":5121,"count":0,"type":"SCALAR"}],)" +
      R"("bufferViews":[{"buffer":0,"byteLength":98304}],"buffers":[{"uri":"data:;base64,)" +
      std::string(131'072, 'A') + R"("}]})";
  EXPECT_THAT(complaint([&] { scene_of("x.gltf", text); }), HasSubstr("what the meshes share"));
}

TEST(BadMeshes, OfMaterials) {
  EXPECT_THAT(complaint([] {
                scene_beside("b.obj", "mtllib bad.mtl\n", "bad.mtl", "newmtl a\nKd 1 x 0\n");
              }),
              HasSubstr("bad.mtl:2:6:"));
}

}  // namespace
}  // namespace caplet::mesh_files_test
