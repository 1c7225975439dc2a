// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// MJCF: materials, textures, lights, cameras and planes, and meshes of COLLADA.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "import/import.h"
#include "support/data.h"
#include "support/import_files.h"

namespace caplet::mjcf_looks_test {
namespace {

using test::complaint;
using testing::HasSubstr;

Scene scene_of_text(const std::string& text, ImportOptions options = {}) {
  if (!options.text("up")) options.set("up", "y");
  return import_scene(test::write_file("looks.xml", "<mujoco>" + text + "</mujoco>"),
                      test::NoImages(), options);
}
double red(const Spectrum& spectrum) { return std::get<RgbSpectrum>(spectrum).rgb.r; }

TEST(MjcfLooks, AGeomsColourReplacesItsMaterials) {
  const Scene scene =
      scene_of_text(R"(<asset><material name="m" rgba=".5 1 1 .25" specular="0"/></asset>
<worldbody><geom size="1" material="m"/><geom size="1" material="m" rgba="1 0 0 1"/><geom size="1" material="m" rgba=".5 .5 .5 1"/><geom size="1"/></worldbody>)");
  const auto of = [&](std::size_t i) {
    return std::get<DiffuseMaterial>(scene.materials[scene.shapes[i].material].model);
  };
  EXPECT_NEAR(red(of(0).reflectance), 0.21404, 1e-5);  // sRGB's 0.5
  EXPECT_EQ(red(of(1).reflectance), 1);
  EXPECT_NEAR(red(of(2).reflectance), 0.21404, 1e-5);
  EXPECT_EQ(scene.shapes[2].material, scene.shapes[0].material);  // grey is as if nothing were said
  ASSERT_TRUE(scene.shapes[0].alpha);
  EXPECT_EQ(std::get<ConstantSpectrum>(scene.shapes[0].alpha->value).value, 0.25);
  EXPECT_FALSE(scene.shapes[1].alpha);
}

TEST(MjcfLooks, MaterialsAreInterfacesAndMirrors) {
  const Scene scene = scene_of_text(
      R"(<asset><material name="m" specular=".5" shininess=".25" reflectance=".2"/><material name="e" emission=".5"/></asset>
<worldbody><geom size="1" material="m"/><geom size="1" material="e"/></worldbody>)");
  const auto& mix = std::get<MixMaterial>(scene.materials[scene.shapes[0].material].model);
  EXPECT_EQ(mix.amount, 0.2);
  const auto& base = std::get<PrincipledMaterial>(scene.materials[mix.materials[0]].model);
  // 0.04 at right angles is an index of 1.5; alpha^2 = 2 / (32 + 2).
  EXPECT_NEAR(base.eta, 1.5, 1e-12);
  EXPECT_NEAR(std::pow(base.roughness, 4), 2.0 / 34, 1e-12);
  EXPECT_EQ(std::get<ConstantSpectrum>(
                *std::get<ConductorMaterial>(scene.materials[mix.materials[1]].model).reflectance)
                .value,
            1);
  ASSERT_TRUE(scene.shapes[1].emission);
  EXPECT_EQ(scene.shapes[1].emission->scale, 0.5);
}

/// The value of a texel's channel, as on a screen.
int texel(const TextureImage& image, int row, int column, int channel) {
  return image.bytes[static_cast<std::size_t>(3 * (row * image.width + column) + channel)];
}

TEST(MjcfLooks, BuiltInTexturesAreMujocos) {
  const Scene scene = scene_of_text(
      R"(<asset><texture name="c" type="2d" builtin="checker" width="4" height="4" rgb1="1 1 1" rgb2="0 0 0" mark="cross" markrgb=".5 .5 .5"/>
<texture name="g" type="2d" builtin="gradient" width="3" height="3" rgb1="1 1 1" rgb2="0 0 0"/>
<texture name="q" type="cube" builtin="gradient" width="64" height="64" rgb1="1 0 0" rgb2="0 0 1"/>
<material name="c" texture="c" texrepeat="2 3"/><material name="g" texture="g" rgba="1 0 0 1"/><material name="q" texture="q"/></asset>
<worldbody><geom type="box" size="1 2 4" material="c"/><geom size="1" material="g"/><geom type="capsule" size="1 3" pos="5 6 7" material="q"/></worldbody>)");
  const auto texture = [&](std::size_t i) -> const Texture& {
    return scene.textures[*texture_of(scene.materials[scene.shapes[i].material], "base_color")];
  };
  const auto& board = std::get<ImagemapTexture>(texture(0).model);
  // mujoco 4.0's tex_data.
  const int expected[4][4] = {
      {255, 255, 127, 0}, {255, 255, 127, 0}, {127, 127, 127, 127}, {0, 0, 127, 255}};
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      EXPECT_EQ(texel(*board.image, row, column, 0), expected[row][column]);
  // Twice over the 2 of x, three times over the 4 of y.
  EXPECT_EQ(board.mapping.v1, glm::dvec3(1, 0, 0));
  EXPECT_EQ(board.mapping.v2, glm::dvec3(0, 0.75, 0));
  const auto& spot = std::get<ImagemapTexture>(texture(1).model);
  EXPECT_EQ(texel(*spot.image, 1, 1, 1), 0);  // white, times red
  EXPECT_EQ(texel(*spot.image, 1, 1, 0), 255);
  EXPECT_EQ(texel(*spot.image, 0, 1, 0), 0);
  const auto& around = std::get<ImagemapTexture>(texture(2).model);
  ASSERT_EQ(around.mapping.kind, TextureMapping::Kind::spherical);
  // From y to -y, red to blue, as mujoco 4.0 draws it: a quarter of a turn from x (rows are from
  // below), in the middle of angles from z.
  const int rows = around.image->height, middle = around.image->width / 2;
  EXPECT_GT(texel(*around.image, 3 * rows / 4, middle, 0), 250);
  EXPECT_LT(texel(*around.image, rows / 4, middle, 0), 5);
  EXPECT_NEAR(texel(*around.image, 0, 0, 0), 127, 3);
  // The capsule's middle, and its surface over its radius and half length.
  const glm::dvec4 p = around.mapping.texture_from_world * glm::dvec4(6, 6, 7, 1),
                   top = around.mapping.texture_from_world * glm::dvec4(5, 6, 10, 1);
  EXPECT_NEAR(p.x, 1, 1e-12);
  EXPECT_NEAR(top.z, 1, 1e-12);
}

// MJCF's reference: of a material's layers those of the roles rgb and rgba are its colour.
TEST(MjcfLooks, LayersOfMaterialsHaveRoles) {
  for (const char* role : {"rgb", "rgba"}) {
    const Scene scene = scene_of_text(
        "<asset><texture name='red' type='2d' builtin='flat' width='1' height='1' rgb1='1 0 0'/>"
        "<texture name='blue' type='2d' builtin='flat' width='1' height='1' rgb1='0 0 1'/>"
        "<material name='m'><layer role='normal' texture='blue'/><layer role='" +
        std::string(role) +
        "' texture='red'/><layer role='roughness' texture='blue'/></material>"
        "<material name='n'><layer role='normal' texture='blue'/></material></asset>"
        "<worldbody><geom type='box' size='1 1 1' material='m'/><geom type='box' size='1 1 1' "
        "material='n'/></worldbody>");
    const auto texture = [&](std::size_t i) {
      return texture_of(scene.materials[scene.shapes.at(i).material], "base_color");
    };
    ASSERT_TRUE(texture(0)) << role;
    const auto& image = *std::get<ImagemapTexture>(scene.textures[*texture(0)].model).image;
    EXPECT_EQ(texel(image, 0, 0, 0), 255) << role;
    EXPECT_EQ(texel(image, 0, 0, 2), 0) << role;
    EXPECT_FALSE(texture(1)) << role;
  }
}

// mujoco 4.0's tex_data of cubes, by the faces that directions from the middle meet (as it draws
// them): columns by the angle from z in 22.5 degrees, rows from above by turns from x, backwards.
TEST(MjcfLooks, FacesOfCubesAreMujocos) {
  const auto image_of = [](const std::string& builtin) {
    const Scene scene = scene_of_text(
        "<asset><texture name='c' type='cube' builtin='" + builtin +
        "' width='4' height='4' rgb1='1 0 0' rgb2='0 0 1'/><material name='c' texture='c'/></asset>"
        "<worldbody><geom size='1' material='c'/></worldbody>");
    return std::get<ImagemapTexture>(scene.textures.at(0).model).image;
  };
  const auto board = image_of("checker");
  ASSERT_EQ(board->width, 8);
  EXPECT_EQ(texel(*board, 13, 0, 0), 255);  // front: to the right and up
  EXPECT_EQ(texel(*board, 0, 0, 0), 0);     // front: to the right and down
  EXPECT_EQ(texel(*board, 15, 3, 0), 255);  // right: to the left (z above 0) and up
  EXPECT_EQ(texel(*board, 15, 4, 0), 0);    // right: to the right and up
  const auto plain = image_of("flat");
  EXPECT_EQ(texel(*plain, 4, 4, 0), 0);  // -y is down
  EXPECT_EQ(texel(*plain, 12, 4, 0), 255);
}

// Where mujoco 4.0 (drawn by OSMesa) shows the columns and rows of an image of 256 x 256 whose
// colours are their numbers: the fraction of columns from the left is a x + b y + c, that of rows
// from the top likewise, of planes and boxes; of balls, repeat times the turns around z from x, and
// repeat times the angle from z in half turns. Both but for whole numbers.
TEST(MjcfLooks, TexturesLieAsMujocos) {
  struct Lies {
    const char *geom, *material;
    double a, c, e, f;  // columns a x + c, rows e y + f
  };
  const Lies flat[] = {
      {"type='plane' size='2 1 .1'", "texrepeat='1 1'", 0.25, 0.5, -0.5, 0.5},
      {"type='plane' size='2 1 .1'", "texrepeat='2 3'", 0.5, 0, -1.5, 0.5},
      {"type='plane' size='2 1 .1'", "texrepeat='1 1' texuniform='true'", 0.5, 0, -0.5, 0.5},
      {"type='plane' size='2 1 .1'", "texrepeat='2 3' texuniform='true'", 1, 0, -1.5, 0.5},
      {"type='plane' size='0 0 1'", "texrepeat='2 3' texuniform='true'", 1, 0.5, -1.5, 0.5},
      {"type='box' size='2 1 .5'", "texrepeat='2 3'", 0.5, 0, -1.5, 0.5},
      {"type='box' size='2 1 .5'", "texrepeat='2 3' texuniform='true'", 1, 0, -1.5, 0.5},
      {"type='box' size='2.5 1.5 .5'", "texrepeat='1 1' texuniform='true'", 0.5, 0.25, -0.5, 0.75},
      {"type='box' size='2.5 .75 .5'", "texrepeat='1 1' texuniform='true'", 0.5, 0.25, -0.5,
       0.375}};
  const auto mapping_of = [](const std::string& geom, const std::string& material) {
    const Scene scene = scene_of_text(
        "<asset><texture name='c' type='2d' builtin='checker' width='4' height='4'/><material "
        "name='c' texture='c' " +
        material + "/></asset><worldbody><geom " + geom + " material='c'/></worldbody>");
    const Material& of = scene.materials.at(scene.shapes.at(0).material);
    return std::get<ImagemapTexture>(scene.textures.at(*texture_of(of, "base_color")).model)
        .mapping;
  };
  const auto same = [](double a, double b) { return std::abs(a - b - std::round(a - b)) < 1e-9; };
  for (const Lies& one : flat) {
    const TextureMapping mapping = mapping_of(one.geom, one.material);
    for (const auto& [x, y] : {std::pair(0.3, -0.2), std::pair(-1.1, 0.7)}) {
      const glm::dvec3 p(mapping.texture_from_world * glm::dvec4(x, y, 0, 1));
      EXPECT_TRUE(same(glm::dot(mapping.v1, p) + mapping.udelta, one.a * x + one.c))
          << one.geom << one.material;
      EXPECT_TRUE(same(1 - glm::dot(mapping.v2, p) - mapping.vdelta, one.e * y + one.f))
          << one.geom << one.material;
    }
  }
  // Our coordinates are u = turns around z from x, v = 1 - the angle from z in half turns.
  for (const auto& [geom, material, columns, rows] :
       {std::tuple("size='1.5'", "texrepeat='3 2'", 3.0, 2.0),
        std::tuple("size='1.5'", "texrepeat='1 1' texuniform='true'", 1.5, 1.5),
        std::tuple("type='ellipsoid' size='2 1 .5'", "texrepeat='1 3' texuniform='true'", 2.0,
                   3.0)}) {
    const TextureMapping mapping = mapping_of(geom, material);
    ASSERT_EQ(mapping.kind, TextureMapping::Kind::uv) << geom;
    for (const auto& [turns, angle] : {std::pair(0.1, 0.25), std::pair(0.85, 0.9)}) {
      EXPECT_TRUE(same(mapping.uscale * turns + mapping.udelta, columns * turns)) << geom;
      EXPECT_TRUE(same(1 - mapping.vscale * (1 - angle) - mapping.vdelta, rows * angle)) << geom;
    }
  }
  // The side of a capsule of radius 1 and half length 1.5 has rows from its top, over 3 of the pi +
  // 3 of its profile.
  const TextureMapping side = mapping_of("type='capsule' size='1 1.5'", "texrepeat='3 2'");
  for (const double z : {-1.5, 0.2, 1.5}) {
    const double along = (std::acos(-1.0) / 2 + 1.5 + z) / (std::acos(-1.0) + 3);
    EXPECT_TRUE(same(1 - side.vscale * along - side.vdelta, 2 * (0.5 - z / 3))) << z;
  }
}

TEST(MjcfLooks, TheFilesLightsReplaceTheStudio) {
  const std::string body = "<worldbody><geom size='1' pos='0 0 1'/>";
  EXPECT_EQ(scene_of_text(body + "</worldbody>").lights.size(), 1U);
  const std::string lit =
      "<visual><headlight ambient='.25 .25 .25' diffuse='0 0 0'/></visual>" + body +
      "<light pos='0 0 4' dir='0 0 -2' diffuse='.5 .5 .5'/><light directional='true' dir='1 0 0' "
      "ambient='.5 0 0'/>"
      "<light pos='0 0 3' cutoff='180' diffuse='1 1 1'/><light active='false'/>"
      "<light diffuse='0 0 0' ambient='.125 0 0'/><geom type='plane' size='0 0 1' pos='0 0 -9'/>"
      "</worldbody>";
  const Scene scene = scene_of_text(lit);
  ASSERT_EQ(scene.lights.size(), 4U);
  const double pi = std::acos(-1.0);
  const auto& spot = std::get<SpotLight>(scene.lights[0].model);
  EXPECT_NEAR(red(spot.intensity), 0.5 * 9 * pi, 1e-9);  // 3 from the middle of the sphere
  EXPECT_NEAR(spot.total_angle, pi / 4, 1e-12);
  EXPECT_EQ(spot.direction, glm::dvec3(0, 0, -1));
  EXPECT_NEAR(red(std::get<DistantLight>(scene.lights[1].model).irradiance), 0.7 * pi, 1e-9);
  EXPECT_NEAR(red(std::get<PointLight>(scene.lights[2].model).intensity), 4 * pi, 1e-9);
  EXPECT_NEAR(red(std::get<InfiniteLight>(scene.lights[3].model).radiance), 0.875, 1e-5);
  EXPECT_EQ(scene_of_text(lit, {{{"light", "studio"}}}).lights.size(), 1U);
}

TEST(MjcfLooks, LightsAndCamerasFollowTheirTargets) {
  // mujoco 4.0's light_xdir and cam_xmat.
  const Scene scene = scene_of_text(
      R"(<worldbody><light mode="targetbody" target="b" pos="1 2 3"/><camera name="c" mode="targetbody" target="b" pos="1 2 3" fovy="60"/>
<body name="b" pos="0 1 0"><geom size="1"/></body></worldbody>)",
      {{{"camera", "c"}}});
  const auto& spot = std::get<SpotLight>(scene.lights[0].model);
  EXPECT_NEAR(spot.direction.x, -0.30151134, 1e-8);
  EXPECT_NEAR(spot.direction.z, -0.90453403, 1e-8);
  const glm::dmat4& camera = scene.view.camera.world_from_camera;
  EXPECT_NEAR(camera[0].x, -0.70710678, 1e-8);
  EXPECT_NEAR(camera[0].y, 0.70710678, 1e-8);
  EXPECT_NEAR(camera[1].x, -0.63960215, 1e-8);
  EXPECT_NEAR(camera[1].z, 0.42640143, 1e-8);
  EXPECT_NEAR(camera[2].z, -0.90453403, 1e-8);
  EXPECT_EQ(glm::dvec3(camera[3]), glm::dvec3(1, 2, 3));
  EXPECT_NEAR(fov_of(scene.view.camera), std::acos(-1.0) / 3, 1e-12);
  EXPECT_THAT(complaint([&] {
                scene_of_text("<worldbody><geom size='1'/><camera name='a'/></worldbody>",
                              {{{"camera", "b"}}});
              }),
              HasSubstr("no camera 'b' (it has: a)"));
}

TEST(MjcfLooks, PlanesAreFloorsBeyondThePicture) {
  const Scene scene = scene_of_text(
      "<worldbody><geom type='plane' size='0 2 1'/><geom size='1' pos='3 0 0'/></worldbody>");
  const Shape& plane = scene.shapes[1];
  EXPECT_TRUE(plane.is_backdrop && plane.one_sided);
  const auto& mesh = std::get<TriangleMeshShape>(plane.geometry);
  EXPECT_EQ(mesh.positions[2].y, 2);
  EXPECT_LT(mesh.positions[0].x, -80);
  EXPECT_GT(mesh.positions[2].x, 80);
  // The camera is as near as without it.
  const Scene alone = scene_of_text("<worldbody><geom size='1' pos='3 0 0'/></worldbody>");
  EXPECT_EQ(scene.view.camera.world_from_camera, alone.view.camera.world_from_camera);
  EXPECT_EQ(scene_of_text("<worldbody><geom type='plane' size='0 0 1'/></worldbody>").shapes.size(),
            1U);
}

TEST(MjcfLooks, SkiesAreSeen) {
  const Scene scene = scene_of_text(
      R"(<asset><texture type="skybox" builtin="gradient" width="64" height="64" rgb1="1 1 1" rgb2="0 0 0"/></asset>
<worldbody><geom size="1"/><light/></worldbody>)");
  const auto& sky = std::get<InfiniteLight>(scene.lights.back().model);
  ASSERT_TRUE(sky.image);
  EXPECT_EQ(sky.image->width, 2 * sky.image->height);
  EXPECT_GT(sky.image->rgb.front(), 0.9F);
  EXPECT_LT(sky.image->rgb.back(), 0.1F);
  // A white one would light everything white.
  const Scene white = scene_of_text(
      R"(<asset><texture type="skybox" builtin="flat" width="8" height="8" rgb1="1 1 1" rgb2="1 1 1"/></asset>
<worldbody><geom size="1"/><light/></worldbody>)");
  EXPECT_NEAR(white.lights.back().scale, 0.35, 1e-6);
}

TEST(MjcfLooks, TheExampleWalks) {
  const Scene scene = import_scene(test::source_folder() / "scenes/walker.xml", test::NoImages(),
                                   {{{"up", "y"}, {"pose", "step"}}});
  EXPECT_EQ(count_primitives(scene),
            (std::map<std::string, std::uint64_t>{
                {"capsule", 10}, {"box", 1}, {"cylinder", 4}, {"sphere", 8}, {"triangle", 2}}));
  // The front leg's angles about y: 35 degrees and 0.35, then -68 degrees and 0.25.
  const double degree = std::acos(-1.0) / 180, thigh = 35 * degree + 0.35,
               shin = thigh - 68 * degree + 0.25;
  bool found = false;
  for (const Shape& shape : scene.shapes) {
    if (shape.name != "foot_0_0") continue;
    found = true;
    const glm::dvec3 at(shape.world_from_object[3]);
    EXPECT_NEAR(at.x, 0.19 - 0.21 * std::sin(thigh) - 0.22 * std::sin(shin), 1e-9);
    EXPECT_NEAR(at.y, -0.11, 1e-9);
    EXPECT_NEAR(at.z, 0.44 - 0.01 - 0.21 * std::cos(thigh) - 0.22 * std::cos(shin), 1e-9);
  }
  EXPECT_TRUE(found);
}

TEST(RobotMeshes, ColladaIsReadInItsUnit) {
  const std::string mesh_file =
      test::write_file(
          "t.dae",
          R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="0.1"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 2 0</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><translate>0 0 3</translate><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)")
          .string();
  // What is seen is read with its materials, what collides without them.
  for (const std::string kind : {"visual", "collision"}) {
    const Scene scene = import_scene(
        test::write_file("t.urdf", "<robot><link name='a'><" + kind +
                                       "><geometry><mesh filename='file://" + mesh_file +
                                       "'/></geometry></" + kind + "></link></robot>"),
        test::NoImages(), {{{"up", "y"}, {"groups", kind}}});
    const auto& mesh = std::get<TriangleMeshShape>(scene.shapes[0].geometry);
    ASSERT_EQ(mesh.positions.size(), 3U);
    const auto corner = [&](std::size_t i) {
      return scene.shapes[0].world_from_object * glm::dvec4(mesh.positions[i], 1);
    };
    EXPECT_NEAR(corner(1).x, 0.1, 1e-6);
    EXPECT_NEAR(corner(2).y, 0.2, 1e-6);
    EXPECT_NEAR(corner(0).z, 0.3, 1e-6);
  }
  const std::string bad_file = test::write_file("bad.dae", "<COLLADA").string();
  EXPECT_THAT(complaint([&] {
                import_scene(test::write_file(
                                 "t.urdf",
                                 "<robot><link name='a'><visual><geometry><mesh filename='file://" +
                                     bad_file + "'/></geometry></visual></link></robot>"),
                             test::NoImages());
              }),
              HasSubstr("bad.dae"));
}

}  // namespace
}  // namespace caplet::mjcf_looks_test
