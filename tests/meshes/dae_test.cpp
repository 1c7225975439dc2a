// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// COLLADA: where its nodes place what its faces are, materials, bad input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <glm/geometric.hpp>

#include "import/detail/mesh_file.h"
#include "import/import.h"
#include "support/import_files.h"
#include "support/log_of.h"

namespace caplet {
namespace {

using test::complaint;
using testing::AllOf;
using testing::HasSubstr;

/// Four vertices, a normal and two texture coordinates, then faces; a scene of nodes; what else.
std::string dae(const std::string& faces,
                const std::string& nodes = "<node id='n'><instance_geometry url='#g'/></node>",
                const std::string& more = "", const std::string& asset = "") {
  return "<?xml version='1.0'?>\n<COLLADA version='1.4.1'><asset>" + asset +
         "</asset>\n<library_geometries><geometry id='g' name='it'><mesh>\n"
         "<source id='p'><float_array id='pa' count='12'>0 0 0 1 0 0 1 1 0 0 1 "
         "0</float_array><technique_common>"
         "<accessor source='#pa' count='4' stride='3'/></technique_common></source>\n"
         "<source id='q'><float_array id='qa' count='4'>0 0 1 9</float_array><technique_common>"
         "<accessor source='#qa' count='1' stride='4'/></technique_common></source>\n"
         "<source id='t'><float_array id='ta' count='5'>7 0 0 1 0.5</float_array><technique_common>"
         "<accessor source='#ta' count='2' offset='1' stride='2'/></technique_common></source>\n"
         "<vertices id='v'><input semantic='POSITION' source='#p'/></vertices>\n" +
         faces + "\n</mesh></geometry></library_geometries>\n" + more +
         "<library_visual_scenes><visual_scene id='s'>" + nodes +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene "
         "url='#s'/></scene></COLLADA>";
}
const std::string kVertex = "<input semantic='VERTEX' source='#v' offset='0'/>";
const std::string kTwo =
    "<triangles count='2' material='m'>" + kVertex + "<p>0 1 2 0 2 3</p></triangles>";

std::vector<TriangleMeshShape> meshes(const std::string& text) {
  return read_dae_meshes(test::write_file("a.dae", text), {});
}
Scene scene_of(const std::string& text, const ImportOptions& options = {}) {
  return import_scene(test::write_file("a.dae", text), test::NoImages(), options);
}
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

TEST(Collada, FacesOfAllKinds) {
  EXPECT_EQ(meshes(dae(kTwo)).at(0).triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(meshes(dae("<polylist count='2'>" + kVertex +
                       "<vcount>4 3</vcount><p>0 1 2 3 1 2 3</p></polylist>"))
                .at(0)
                .triangles,
            (Triangles{{0, 1, 2}, {0, 2, 3}, {1, 2, 3}}));
  EXPECT_EQ(meshes(dae("<polygons count='2'>" + kVertex +
                       "<p>0 1 2 3</p><ph><p>1 2 3</p><h>0 1 2</h></ph></polygons>"))
                .at(0)
                .triangles,
            (Triangles{{0, 1, 2}, {0, 2, 3}, {1, 2, 3}}));
  EXPECT_EQ(
      meshes(dae("<trifans count='1'>" + kVertex + "<p>0 1 2 3</p></trifans>")).at(0).triangles,
      (Triangles{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(
      meshes(dae("<tristrips count='1'>" + kVertex + "<p>0 1 2 3</p></tristrips>")).at(0).triangles,
      (Triangles{{0, 1, 2}, {2, 1, 3}}));
  EXPECT_EQ(meshes(dae("<lines count='1'>" + kVertex + "<p>0 1</p></lines>" + kTwo)).size(), 1U);
}

TEST(Collada, CornersHaveIndicesOfTheirOwn) {
  const TriangleMeshShape mesh =
      meshes(dae("<triangles count='2'>" + kVertex +
                 "<input semantic='NORMAL' source='#q' offset='2'/><input semantic='TEXCOORD' "
                 "source='#t' offset='1'/>"
                 "<p>0 0 0 1 0 0 2 1 0 0 0 0 2 0 0 3 1 0</p></triangles>"))
          .at(0);
  ASSERT_EQ(mesh.positions.size(), 5U);  // vertex 2 with either texture coordinate
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 3, 4}}));
  EXPECT_EQ(mesh.positions[2], mesh.positions[3]);
  EXPECT_EQ(mesh.uvs[2], glm::vec2(1, 0.5F));
  EXPECT_EQ(mesh.uvs[3], glm::vec2(0, 0));
  for (const glm::vec3& n : mesh.normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
}

// By hand: the first transformation of a node is the outermost.
TEST(Collada, NodesPlaceWhatTheyHold) {
  const auto corner = [](const std::string& transforms) {  // (1, 0, 0)
    return meshes(dae(kTwo, "<node>" + transforms + "<instance_geometry url='#g'/></node>"))
        .at(0)
        .positions.at(1);
  };
  const auto near = [](const glm::vec3& a, const glm::vec3& b) {
    EXPECT_LT(glm::length(a - b), 1e-6F) << a.x << ' ' << a.y << ' ' << a.z;
  };
  near(corner("<translate>1 2 3</translate><scale>2 3 4</scale>"), {3, 2, 3});
  near(corner("<scale>2 3 4</scale><translate>1 2 3</translate>"), {4, 6, 12});
  near(corner("<rotate>0 0 2 90</rotate>"), {0, 1, 0});
  near(corner("<matrix>0 -1 0 5 1 0 0 6 0 0 1 7 0 0 0 1</matrix>"), {5, 7, 7});
  near(corner("<lookat>1 2 3 1 2 -9 0 1 0</lookat>"), {2, 2, 3});   // as it is, looking along -z
  near(corner("<lookat>0 0 0 -1 0 0 0 1 0</lookat>"), {0, 0, -1});  // its right is -z
  near(corner("<translate>1 0 0</translate><node><rotate>0 0 1 90</rotate><instance_geometry "
              "url='#g'/></node>"),
       {1, 1, 0});
  const std::vector<TriangleMeshShape> nested =
      meshes(dae(kTwo,
                 "<node><translate>1 0 0</translate><node><scale>2 2 2</scale><instance_node "
                 "url='#of'/></node></node>",
                 "<library_nodes><node id='of'><translate>0 0 1</translate><instance_geometry "
                 "url='#g'/></node></library_nodes>",
                 "<unit meter='0.01'/><up_axis>Z_UP</up_axis>"));
  near(nested.at(0).positions.at(1), {0.03F, 0, 0.02F});
}

// A mirror keeps the faces' order; normals of what is scaled by (1, 1, 2) and turned stay across
// the faces.
TEST(Collada, NormalsGoWithTheFaces) {
  const std::string faces =
      "<triangles count='1'>" + kVertex +
      "<input semantic='NORMAL' source='#q' offset='1'/><p>0 0 1 0 2 0</p></triangles>";
  const TriangleMeshShape mesh =
      meshes(dae(faces,
                 "<node><rotate>1 0 0 30</rotate><scale>1 1 2</scale><rotate>1 0 0 "
                 "45</rotate><instance_geometry url='#g'/></node>"))
          .at(0);
  const glm::vec3 across =
      glm::cross(mesh.positions[1] - mesh.positions[0], mesh.positions[2] - mesh.positions[0]);
  EXPECT_LT(glm::length(glm::normalize(across) - glm::normalize(mesh.normals.at(0))), 1e-6F);
}

TEST(Collada, SkinsAreAsTheyAreBound) {
  const std::vector<TriangleMeshShape> parts =
      meshes(dae(kTwo, "<node><instance_controller url='#c'/></node>",
                 "<library_controllers><controller id='c'><skin source='#g'><bind_shape_matrix>1 0 "
                 "0 4 0 1 0 5 0 0 1 6 0 0 0 "
                 "1</bind_shape_matrix>"
                 "</skin></controller></library_controllers>"));
  EXPECT_EQ(parts.at(0).positions.at(0), glm::vec3(4, 5, 6));
}

TEST(Collada, AScenesAxisAndUnit) {
  const Scene z = scene_of(dae(
      kTwo,
      "<node id='n' name='plate'><translate>0 0 2</translate><instance_geometry url='#g'/></node>",
      "", "<unit meter='0.5'/><up_axis>Z_UP</up_axis>"));
  ASSERT_EQ(z.shapes.size(), 1U);
  EXPECT_EQ(z.shapes[0].name, "plate");
  const glm::dvec4 at = z.shapes[0].world_from_object * glm::dvec4(0, 0, 0, 1);
  EXPECT_LT(glm::length(glm::dvec3(at) - glm::dvec3(0, 1, 0)), 1e-12);
  const Scene y = scene_of(dae(kTwo));
  EXPECT_EQ(glm::dvec3(y.shapes[0].world_from_object * glm::dvec4(1, 2, 3, 1)),
            glm::dvec3(1, 2, 3));
}

// The table of COLLADA's specification: to the right, up and toward the viewer are -y, x, z of
// X_UP; x, y, z of Y_UP; x, z, -y of Z_UP.
TEST(Collada, UpIsWhatTheFileSays) {
  const auto moved = [](const std::string& asset) {
    return glm::dvec3(scene_of(dae(kTwo, "<node><instance_geometry url='#g'/></node>", "", asset))
                          .shapes.at(0)
                          .world_from_object *
                      glm::dvec4(1, 2, 3, 1));
  };
  EXPECT_EQ(moved("<up_axis>X_UP</up_axis>"), glm::dvec3(-2, 1, 3));
  EXPECT_EQ(moved("<up_axis> Y_UP\n</up_axis>"), glm::dvec3(1, 2, 3));
  EXPECT_EQ(moved("<up_axis>Z_UP</up_axis>"), glm::dvec3(1, 3, -2));
  EXPECT_EQ(moved(""), glm::dvec3(1, 2, 3));
}

TEST(Collada, MaterialsAreThoseThatAreBound) {
  const auto with = [](const std::string& shading, const std::string& more = "",
                       const std::string& bound = "#red") {
    return scene_of(
        dae(kTwo,
            "<node><instance_geometry url='#g'><bind_material><technique_common><instance_material "
            "symbol='m' target='" +
                bound + "'/></technique_common></bind_material></instance_geometry></node>",
            "<library_materials><material id='red' name='Red'><instance_effect "
            "url='#e'/></material></library_materials>"
            "<library_effects><effect id='e'><profile_COMMON>" +
                more + "<technique sid='t'>" + shading +
                "</technique></profile_COMMON></effect></library_effects>"));
  };
  const auto material = [](const Scene& scene) {
    return scene.materials.at(scene.shapes.at(0).material);
  };
  const Scene red = with("<lambert><diffuse><color>0.8 0.1 0.2 1</color></diffuse></lambert>");
  EXPECT_EQ(material(red).name, "Red");
  EXPECT_EQ(std::get<RgbSpectrum>(std::get<DiffuseMaterial>(material(red).model).reflectance).rgb,
            glm::dvec3(0.8, 0.1, 0.2));
  const Scene glossy = with(
      "<phong><diffuse><color>0 0 1 1</color></diffuse><specular><color>1 1 1 "
      "1</color></specular><shininess><float>30</float></shininess></phong>");
  EXPECT_NEAR(std::get<PrincipledMaterial>(material(glossy).model).roughness, 0.5,
              1e-12);  // as Ns of MTL
  const Scene lamp = with("<constant><emission><color>3 2 1 1</color></emission></constant>");
  ASSERT_TRUE(lamp.shapes[0].emission);
  EXPECT_EQ(std::get<RgbSpectrum>(lamp.shapes[0].emission->radiance).rgb, glm::dvec3(3, 2, 1));
  const auto alpha = [&](const std::string& transparent) -> double {
    const Scene scene = with("<lambert>" + transparent + "</lambert>");
    const std::optional<TextureOperand>& operand = scene.shapes[0].alpha;
    return operand ? std::get<ConstantSpectrum>(operand->value).value : 1;
  };
  EXPECT_EQ(alpha(""), 1);
  EXPECT_NEAR(alpha("<transparent opaque='A_ONE'><color>0 0 0 "
                    "0.5</color></transparent><transparency><float>0.5</float></transparency>"),
              0.25, 1e-12);
  EXPECT_NEAR(alpha("<transparent><color>1 1 1 "
                    "1</color></transparent><transparency><float>0.75</float></transparency>"),
              0.75, 1e-12);
  EXPECT_NEAR(alpha("<transparent opaque='RGB_ZERO'><color>0.25 0.25 0.25 1</color></transparent>"),
              0.75, 1e-6);
  EXPECT_EQ(alpha("<transparent><color>1 1 1 "
                  "1</color></transparent><transparency><float>0</float></transparency>"),
            1);
  EXPECT_EQ(alpha("<transparent><color>1 1 1 "
                  "1</color></transparent><transparency><float>3</float></transparency>"),
            1);
  EXPECT_EQ(material(with("", "", "#none")).name, "default");
}

TEST(Collada, ATexturesImageIsFoundThroughItsSampler) {
  const std::string effect =
      "<library_images><image id='i'><init_from>a%20b.png</init_from></image></library_images>"
      "<library_materials><material id='m'><instance_effect "
      "url='#e'/></material></library_materials><library_effects><effect "
      "id='e'><profile_COMMON>"
      "<newparam sid='su'><surface type='2D'><init_from>i</init_from></surface></newparam>"
      "<newparam sid='sa'><sampler2D><source>su</source></sampler2D></newparam>"
      "<technique><lambert><diffuse><texture texture='sa' "
      "texcoord='u'/></diffuse></lambert></technique></profile_COMMON></effect></library_effects>";
  const std::filesystem::path path =
      test::write_file("a.dae", dae(kTwo, "<node><instance_geometry url='#g'/></node>", effect));
  EXPECT_TRUE(
      import_scene(path, test::NoImages()).textures.empty());  // there is no such file: a warning
  std::ofstream(path.parent_path() / "a b.png") << "no picture";
  EXPECT_THAT(complaint([&] { import_scene(path, test::NoImages()); }),
              HasSubstr("a.dae:"));  // it is looked for
}

TEST(Collada, ArraysOfTwoGeometriesMayHaveTheSameIds) {
  std::string text =
      dae(kTwo, "<node><instance_geometry url='#g'/><instance_geometry url='#h'/></node>");
  const std::size_t begin = text.find("<geometry"), end = text.find("</geometry>") + 11;
  std::string other = text.substr(begin, end - begin);
  other.replace(other.find("id='g'"), 6, "id='h'");
  other.replace(other.find("0 0 0 1 0 0"), 11, "5 0 0 6 0 0");
  text.insert(end, other);
  const std::vector<TriangleMeshShape> parts = meshes(text);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[1].positions.at(0), glm::vec3(5, 0, 0));
}

/// Reads each image as a texel, and tells which.
class OneTexel : public test::NoImages {
 public:
  TextureImage read_texture(const std::filesystem::path& path,
                            const ImageEncoding& encoding) const override {
    TextureImage image;
    image.width = image.height = image.channels = 1;
    image.bytes = {10};
    image.file = path.string();
    image.encoding = encoding;
    return image;
  }
};

// COLLADA 1.5 names the image within the sampler; a texture may also name the image itself.
TEST(Collada, ATextureNamesAnImageInThreeWays) {
  const auto with = [](const std::string& parameters, const std::string& name) {
    return dae(kTwo,
               "<node><instance_geometry url='#g'><bind_material><technique_common>"
               "<instance_material symbol='m' target='#m'/></technique_common></bind_material>"
               "</instance_geometry></node>",
               "<library_images><image id='i'><init_from><ref>file://a%20b.png</ref></init_from>"
               "</image></library_images><library_materials><material id='m'><instance_effect "
               "url='#e'/></material></library_materials><library_effects><effect id='e'>"
               "<profile_COMMON>" +
                   parameters + "<technique><lambert>\n<diffuse><texture texture='" + name +
                   "' texcoord='u'/></diffuse></lambert></technique></profile_COMMON></effect>"
                   "</library_effects>");
  };
  const std::filesystem::path folder = test::temporary_folder();
  std::ofstream(folder / "a b.png") << "no picture";
  const auto read = [&](const std::string& text) {
    std::ofstream(folder / "a.dae") << text;
    return import_scene(folder / "a.dae", OneTexel());
  };
  const std::pair<const char*, const char*> ways[] = {
      {"<newparam sid='su'><surface type='2D'><init_from> i </init_from></surface></newparam>"
       "<newparam sid='sa'><sampler2D><source> su </source></sampler2D></newparam>",
       "sa"},
      {"<newparam sid='sa'><sampler2D><instance_image url='#i'/></sampler2D></newparam>", "sa"},
      {"<newparam sid='sa'><sampler2D><instance_image url='i'/></sampler2D></newparam>", "sa"},
      {"", "i"}};
  for (const auto& [parameters, name] : ways) {
    const Scene scene = read(with(parameters, name));
    ASSERT_EQ(scene.textures.size(), 1U) << parameters;
    EXPECT_EQ(std::get<ImagemapTexture>(scene.textures[0].model).image->file,
              (folder / "a b.png").string());
    const Material& material = scene.materials.at(scene.shapes.at(0).material);
    EXPECT_EQ(std::get<RgbSpectrum>(std::get<DiffuseMaterial>(material.model).reflectance).rgb,
              glm::dvec3(1));
  }
  test::LogOf log;
  EXPECT_TRUE(read(with("", "nowhere")).textures.empty());
  EXPECT_TRUE(read(with("", "m")).textures.empty());  // which is a material
  EXPECT_THAT(log.text(),
              AllOf(HasSubstr("a.dae:11:2: the texture 'nowhere' has no image: it is left out"),
                    HasSubstr("a.dae:11:2: the texture 'm' has no image: it is left out")));
}

// Without <scene> the first visual scene is drawn, and without that every geometry.
TEST(Collada, WithoutASceneAllIsDrawn) {
  std::string text = dae(kTwo,
                         "<node name='placed'><translate>5 0 0</translate><instance_geometry "
                         "url='#g'/></node>");
  const std::size_t scene = text.find("<scene>");
  text.erase(scene, text.find("</scene>") + 8 - scene);
  const Scene placed = scene_of(text);
  ASSERT_EQ(placed.shapes.size(), 1U);
  EXPECT_EQ(placed.shapes[0].name, "placed");
  EXPECT_EQ(glm::dvec3(placed.shapes[0].world_from_object[3]), glm::dvec3(5, 0, 0));
  const std::size_t library = text.find("<library_visual_scenes>");
  text.erase(library, text.find("</library_visual_scenes>") + 24 - library);
  const Scene all = scene_of(text);
  ASSERT_EQ(all.shapes.size(), 1U);
  EXPECT_EQ(all.shapes[0].name, "it");
  EXPECT_EQ(all.shapes[0].world_from_object, glm::dmat4(1));
  EXPECT_EQ(std::get<TriangleMeshShape>(all.shapes[0].geometry).triangles.size(), 2U);
}

// Its numbers are rows of as many as are needed.
TEST(Collada, ASourceMayHaveNoAccessor) {
  std::string text = dae(kTwo);
  const std::string accessor =
      "<technique_common><accessor source='#pa' count='4' stride='3'/></technique_common>";
  text.erase(text.find(accessor), accessor.size());
  EXPECT_EQ(meshes(text).at(0).positions,
            (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
}

// If two elements have one id, which is not allowed, the first is used, as in a browser
// (getElementById).
TEST(Collada, OfTwoOfOneIdTheFirstIsMeant) {
  const std::string text = dae(kTwo, "<node><instance_node url='#of'/></node>",
                               "<library_nodes><node id='of'><translate>0 0 "
                               "1</translate><instance_geometry url='#g'/></node>"
                               "<node id='of'><translate>0 0 2</translate><instance_geometry "
                               "url='#g'/></node></library_nodes>");
  const std::vector<TriangleMeshShape> parts = meshes(text);
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].positions.at(0), glm::vec3(0, 0, 1));
}

// What is left out is counted, and the first of it is where the warning says.
TEST(Collada, WhatIsLeftOutIsSaid) {
  test::LogOf log;
  meshes(dae(kTwo + "\n<lines count='1'>" + kVertex + "<p>0 1</p></lines>\n<linestrips count='1'>" +
             kVertex + "<p>0 1 2</p></linestrips>"));
  EXPECT_THAT(log.text(), HasSubstr("a.dae:9:2: 2 lines, splines and skews of nodes are left out"));
  const std::vector<TriangleMeshShape> all =
      meshes(dae(kTwo,
                 "\n<node><skew>1 2 3 4 5 6 7</skew><instance_geometry url='#g'/>"
                 "<instance_controller url='#c'/></node>",
                 "<library_controllers><controller id='c'><morph source='#g'/></controller>"
                 "</library_controllers>"));
  EXPECT_EQ(all.size(), 1U);
  EXPECT_EQ(all.at(0).positions.at(2), glm::vec3(1, 1, 0));
  EXPECT_THAT(log.text(),
              HasSubstr("a.dae:11:8: 2 lines, splines and skews of nodes are left out"));
}

struct Bad {
  std::string text, said;
};
TEST(Collada, BadInput) {
  const std::string instance = "<node><instance_geometry url='#g'/></node>";
  std::string deep = "<node>", many = "<library_nodes>";
  for (int i = 0; i < 600; ++i) deep = "<node>" + deep;
  for (int i = 0; i < 601; ++i) deep += "</node>";
  for (int i = 0; i < 40; ++i)
    many += "<node id='k" + std::to_string(i) + "'><instance_node url='#k" + std::to_string(i + 1) +
            "'/><instance_node url='#k" + std::to_string(i + 1) + "'/></node>";
  many += "<node id='k40'/></library_nodes>";
  const Bad bad[] = {
      {"<COLLADA", "a.dae:1:"},
      {"<dae/>", "the root element is not <COLLADA>"},
      {dae(""), "holds no faces"},
      {dae(kTwo, "<node><instance_geometry url='#x'/></node>"),
       "there is no geometry of the id 'x'"},
      {dae(kTwo, "<node><instance_geometry url='b.dae#g'/></node>"),
       "only what is in the file itself"},
      {dae("<triangles count='1'>" + kVertex + "<p>0 1 4</p></triangles>"),
       "a.dae:8:2: vertex 4: there are 4"},
      {dae("<triangles count='2'>" + kVertex + "<p>0 1 2</p></triangles>"),
       "3 corners are fewer than are announced"},
      {dae("<triangles count='1'>" + kVertex + "<p>0 1 x</p></triangles>"),
       "'x' is no count or index"},
      {dae("<triangles count='1'><p>0 1 2</p></triangles>"), "without places of its vertices"},
      {dae("<triangles count='1'><input semantic='VERTEX' source='#v' "
           "offset='99999999999'/><p>0</p></triangles>"),
       "is no place of a corner's number"},
      {dae("<triangles count='1'>" + kVertex +
           "<input semantic='NORMAL' source='#t' offset='0'/><p>0 1 2</p></triangles>"),
       "rows of 2 numbers, and 3 are needed"},
      {dae("<polylist count='1'>" + kVertex + "<vcount>4000000000</vcount><p>0 1 2</p></polylist>"),
       "fewer than <vcount> says"},
      {dae(kTwo, "<node><matrix>1 0 0</matrix><instance_geometry url='#g'/></node>"),
       "matrix: 16 numbers, not 3"},
      {dae(kTwo, "<node><translate>1e39 0 0</translate><instance_geometry url='#g'/></node>"),
       "out of range"},
      {dae(kTwo, "<node><lookat>0 0 0 0 1 0 0 1 0</lookat><instance_geometry url='#g'/></node>"),
       "looks along"},
      {dae(kTwo, "<node id='a'><instance_node url='#a'/></node>"), "nodes hold themselves"},
      {dae(kTwo, deep), "too many within each other"},
      {dae(kTwo, "<node><instance_node url='#k0'/></node>", many), "more than 1000000 nodes"},
      {dae(kTwo, instance, "", "<unit meter='0'/>"), "meter is not positive"},
      {dae(kTwo, "\n<node><matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2</matrix></node>"),
       "a.dae:11:8: the last row of a matrix is not 0 0 0 1"},
      {dae(kTwo, "<node><matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 1 0 1</matrix></node>"),
       "the last row of a matrix is not 0 0 0 1"},
      {dae("<triangles count='two'>" + kVertex + "<p>0 1 2</p></triangles>"),
       "a.dae:8:2: count=\"two\" is no count"},
      {dae("<triangles count='1'>\n<input semantic='VERTEX' source='#v' offset='-1'/><p>0 1 2</p>"
           "</triangles>"),
       "a.dae:9:2: offset=\"-1\" is no count"},
      {dae("<source id='r'>\n<float_array id='ra'>0 0 z</float_array></source><triangles count='1'>"
           "<input semantic='POSITION' source='#r' offset='0'/><p>0 0 0</p></triangles>"),
       "a.dae:9:2: <float_array>: "},
      {dae("<source id='r'/><triangles count='1'>"
           "<input semantic='POSITION' source='#r' offset='0'/><p>0 0 0</p></triangles>"),
       "a.dae:8:2: <source> without an array of floats"},
      {dae(kTwo, "<node><translate>1e16 0 0</translate><instance_geometry url='#g'/></node>", "",
           "<unit meter='1000'/>"),
       "a.dae:8:2: a vertex is not finite or out of range"},
  };
  for (const Bad& one : bad)
    EXPECT_THAT(complaint([&] { meshes(one.text); }),
                AllOf(HasSubstr("a.dae"), HasSubstr(one.said)));
  // 2^16 times a thousand vertices are 65 million.
  std::string row, corners, doubled = "<library_nodes>";
  for (int i = 0; i < 1000; ++i) row += "0 0 0 ";
  for (int i = 0; i < 999; ++i) corners += std::to_string(i) + " ";
  for (int i = 0; i < 16; ++i)
    doubled += "<node id='k" + std::to_string(i) + "'><instance_node url='#k" +
               std::to_string(i + 1) + "'/><instance_node url='#k" + std::to_string(i + 1) +
               "'/></node>";
  doubled += "<node id='k16'><instance_geometry url='#g'/></node></library_nodes>";
  EXPECT_THAT(
      complaint([&] {
        meshes(dae("<source id='r'><float_array id='ra'>" + row +
                       "</float_array></source><triangles count='1'><input semantic='POSITION' "
                       "source='#r' offset='0'/><p>" +
                       corners + "</p></triangles>",
                   "<node><instance_node url='#k0'/></node>", doubled));
      }),
      HasSubstr("a.dae:3:22: more than 50000000 vertices with those of instances"));
  std::string announced = dae(kTwo);
  announced.replace(announced.find("count='4' stride='3'"), 20, "count='5' stride='3'");
  EXPECT_THAT(complaint([&] { meshes(announced); }),
              HasSubstr("5 rows are announced, and 4 are there"));
}

}  // namespace
}  // namespace caplet
