// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// MJCF: where geoms lie by hand and by mujoco 4.0, counts of the shared files, bad input.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>

#include "import/import.h"
#include "support/data.h"
#include "support/import_files.h"

namespace caplet::mjcf_test {
namespace {

using test::complaint;
using testing::HasSubstr;

const double kRoot = std::sqrt(0.5);

Scene scene_of(const std::filesystem::path& path, ImportOptions options = {}) {
  if (!options.text("up")) options.set("up", "y");
  return import_scene(path, test::NoImages(), options);
}
Scene scene_of_text(const std::string& text, const ImportOptions& options = {}) {
  return scene_of(test::write_file("robot.xml", "<mujoco>" + text + "</mujoco>"), options);
}
Scene world(const std::string& text, const ImportOptions& options = {}) {
  return scene_of_text("<worldbody>" + text + "</worldbody>", options);
}
glm::dvec3 at(const Shape& shape, glm::dvec3 p = {0, 0, 0}) {
  return glm::dvec3(shape.world_from_object * glm::dvec4(p, 1));
}
glm::dvec3 way(const Shape& shape, glm::dvec3 v) {
  return glm::dvec3(shape.world_from_object * glm::dvec4(v, 0));
}
void expect_near(glm::dvec3 a, glm::dvec3 b, double within = 1e-9) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], within) << k;
}
const Shape& named(const Scene& scene, const std::string& name) {
  for (const Shape& shape : scene.shapes)
    if (shape.name == name) return shape;
  throw std::runtime_error("no shape " + name);
}

TEST(Mjcf, SolidsAreOfHalfLengths) {
  const Scene scene =
      world(R"(<geom size="2"/><geom type="capsule" size="1 3"/><geom type="cylinder" size="1 3"/>
<geom type="box" size="1 2 3"/><geom type="ellipsoid" size="1 2 3"/>)");
  ASSERT_EQ(scene.shapes.size(), 5U);
  EXPECT_EQ(std::get<SphereShape>(scene.shapes[0].geometry).radius, 2);
  const auto capsule = std::get<CapsulesShape>(scene.shapes[1].geometry);
  EXPECT_EQ(capsule.p1[0], glm::vec3(0, 0, 3));
  EXPECT_EQ(capsule.radius0[0], 1);
  const auto cylinder = std::get<CylinderShape>(scene.shapes[2].geometry);
  EXPECT_EQ(cylinder.p0, glm::dvec3(0, 0, -3));
  EXPECT_EQ(cylinder.radius, 1);
  EXPECT_EQ(std::get<BoxShape>(scene.shapes[3].geometry).p1, glm::dvec3(1, 2, 3));
  EXPECT_EQ(std::get<SphereShape>(scene.shapes[4].geometry).radius, 1);
  expect_near(at(scene.shapes[4], {1, 1, 1}), {1, 2, 3});
  EXPECT_EQ(scene.shapes[3].name, "geom 3");
}

TEST(Mjcf, EndsMakeTheAxis) {
  const Scene scene = world(
      R"(<geom type="capsule" size=".5" fromto="1 2 3 1 2 7"/><geom type="box" size=".1" fromto="0 0 0 1 2 3"/>)");
  expect_near(at(scene.shapes[0]), {1, 2, 5});
  EXPECT_EQ(std::get<CapsulesShape>(scene.shapes[0].geometry).p1[0].z, 2);
  // mujoco 4.0: geom_size, geom_quat.
  expect_near(std::get<BoxShape>(scene.shapes[1].geometry).p1, {0.1, 0.1, 1.87082869}, 1e-8);
  const double x = 0.84894846, y = -0.42447423, w = 0.31481445;
  expect_near(way(scene.shapes[1], {1, 0, 0}), {1 - 2 * y * y, 2 * x * y, -2 * w * y}, 1e-7);
  expect_near(way(scene.shapes[1], {0, 0, 1}), {2 * w * y, -2 * w * x, 1 - 2 * (x * x + y * y)},
              1e-7);
}

TEST(Mjcf, TurnsAreOfSixKinds) {
  const auto turned = [](const std::string& how, const std::string& compiler = "") {
    return scene_of_text(compiler + "<worldbody><geom type='box' size='1 2 3' " + how +
                         "/></worldbody>")
        .shapes[0];
  };
  const Shape about_z = turned("quat='2 0 0 2'");
  expect_near(way(about_z, {1, 0, 0}), {0, 1, 0});
  expect_near(way(turned("axisangle='0 0 5 90'"), {1, 0, 0}), {0, 1, 0});
  expect_near(way(turned("xyaxes='0 2 0 -1 1 0'"), {1, 0, 0}), {0, 1, 0});
  expect_near(way(turned("xyaxes='0 2 0 -1 1 0'"), {0, 1, 0}), {-1, 0, 0});
  expect_near(way(turned("zaxis='0 3 0'"), {0, 0, 1}), {0, 1, 0});
  expect_near(way(turned("zaxis='0 3 0'"), {1, 0, 0}), {1, 0, 0});
  expect_near(way(turned("zaxis='0 0 -1'"), {0, 1, 0}), {0, -1, 0});
  // About x, then about the y that has come of it: z goes to -y, then to the new x, which is the
  // old one.
  expect_near(way(turned("euler='90 90 0'"), {0, 0, 1}), {1, 0, 0});
  expect_near(way(turned("euler='90 90 0'"), {0, 1, 0}), {0, 0, 1});
  // Capitals: about fixed axes, x then y: y goes to z, then to x.
  expect_near(way(turned("euler='90 90 0'", "<compiler eulerseq='XYZ'/>"), {0, 1, 0}), {1, 0, 0});
  const double quarter = std::acos(0.0);
  expect_near(
      way(turned("euler='0 0 " + std::to_string(quarter) + "'", "<compiler angle='radian'/>"),
          {1, 0, 0}),
      {0, 1, 0}, 1e-6);
  EXPECT_THAT(complaint([&] { turned("quat='1 0 0 0' euler='0 0 0'"); }), HasSubstr("both"));
}

TEST(Mjcf, DefaultsGoFromClassToClass) {
  const Scene scene = scene_of_text(R"(<default><geom type="box" size=".1 .2 .3" euler="90 0 0"/>
<default class="a"><geom rgba="1 0 0 1" size=".5"/><default class="b"><geom size="1 1"/></default></default></default>
<worldbody><geom/><geom class="b" quat="1 0 0 0"/><body childclass="a"><geom/><frame childclass="b"><geom/></frame>
<body><geom class="main" size="4"/></body></body></worldbody>)");
  const auto size = [&](std::size_t i) { return std::get<BoxShape>(scene.shapes[i].geometry).p1; };
  expect_near(size(0), {0.1, 0.2, 0.3});
  expect_near(size(1), {1, 1, 0.3});
  expect_near(size(2), {0.5, 0.2, 0.3});
  expect_near(size(3), {1, 1, 0.3});
  expect_near(size(4), {4, 0.2, 0.3});
  expect_near(way(scene.shapes[0], {0, 1, 0}), {0, 0, 1});
  expect_near(way(scene.shapes[1], {0, 1, 0}), {0, 1, 0});  // its own turn replaces the class's
  EXPECT_EQ(scene.shapes[2].material, scene.shapes[3].material);
  EXPECT_NE(scene.shapes[0].material, scene.shapes[2].material);
}

TEST(Mjcf, BodiesAndFramesAreWithinEachOther) {
  const Scene scene = world(
      R"(<body pos="1 0 0" euler="0 0 90"><geom name="a" size=".1" pos="1 0 0"/><frame pos="0 1 0" euler="0 0 90">
<geom name="b" size=".1" pos="1 0 0"/><body pos="0 0 5"><geom name="c" size=".1"/></body></frame><geom name="d" size=".1"/></body><geom name="w" size="1"/>)");
  expect_near(at(named(scene, "a")), {1, 1, 0});
  expect_near(at(named(scene, "b")), {-1, 0, 0});
  expect_near(at(named(scene, "c")), {0, 0, 5});
  // What a body holds comes before its bodies: mujoco's order.
  std::string order;
  for (const Shape& shape : scene.shapes) order += shape.name;
  EXPECT_EQ(order, "wabdc");
}

TEST(Mjcf, ReplicasGoOnFromEachOther) {
  const Scene scene = world(
      R"(<replicate count="3" offset="1 0 0" euler="0 0 90" sep="_"><geom name="a" size=".1" pos="0 0 1"/></replicate>)");
  // The first turn of 0, the second of 90 degrees, which the second step has.
  expect_near(at(named(scene, "a_0")), {0, 0, 1});
  expect_near(at(named(scene, "a_1")), {1, 0, 1});
  expect_near(at(named(scene, "a_2")), {1, 1, 1});
  expect_near(way(named(scene, "a_1"), {1, 0, 0}), {0, 1, 0});
  // mujoco 4.0's names.
  const Scene nested = world(
      R"(<replicate count="10" sep="_"><replicate count="2"><geom name="a" size="1"/></replicate></replicate>)");
  EXPECT_EQ(nested.shapes[2].name, "a0_01");
}

// Places of mujoco 4.0: turns about all three axes, of each order and about axes that turn with
// them or stay.
TEST(Mjcf, ReplicasTurnInTheCompilersOrder) {
  struct Case {
    const char* order;
    glm::dvec3 second, third;
  };
  for (const Case& c :
       {Case{"xyz", {0.64278761, 0.61697778, 0.66341395}, {0.39798366, 1.16008473, 0.83465216}},
        Case{"XYZ", {0.74084306, 1.10504046, 0.66341395}, {0.3105375, 2.43817923, 0.46984631}},
        Case{"zYx", {0.70658796, 0.33658605, 0.24620194}, {0.22329093, 1.06426652, -0.07665319}}}) {
    const Scene scene =
        scene_of_text(std::string("<compiler eulerseq='") + c.order +
                      "'/><worldbody><replicate count='3' offset='0 1 0' euler='30 40 50' sep='_'>"
                      "<geom name='a' size='.1' pos='0 0 1'/></replicate></worldbody>");
    SCOPED_TRACE(c.order);
    expect_near(at(named(scene, "a_1")), c.second, 1e-8);
    expect_near(at(named(scene, "a_2")), c.third, 1e-8);
  }
}

TEST(Mjcf, JointsMoveBodies) {
  const std::string text = R"(<worldbody><body pos="1 0 0"><frame pos="0 0 1" euler="90 0 0">
<joint name="j" axis="0 1 0" pos=".1 .2 .3" ref="30"/></frame><geom size=".1" pos=".5 .6 .7"/></body></worldbody>)";
  expect_near(at(scene_of_text(text).shapes[0]), {1.5, 0.6, 0.7});
  // mujoco 4.0's geom_xpos at qpos 1.
  expect_near(at(scene_of_text(text, {{{"pose", "j=1"}}}).shapes[0]), {1.04273472, 0.68321955, 0.7},
              1e-8);
  EXPECT_THAT(complaint([&] {
                scene_of_text(text, {{{"pose", "k=1"}}});
              }),
              HasSubstr("no joint 'k'"));
  EXPECT_THAT(complaint([&] {
                scene_of_text(text, {{{"pose", "j=1 2"}}});
              }),
              HasSubstr("1 numbers, not 2"));
}

TEST(Mjcf, KeyframesHaveTheNumbersOfAllJoints) {
  const std::string text =
      R"(<worldbody><body pos="1 0 0"><joint name="j" type="ball" pos=".1 .2 .3"/><geom size=".1" pos=".5 .6 .7"/>
<body><joint name="s" type="slide" axis="1 1 0" ref=".2"/><geom size=".1"/></body></body></worldbody>
<keyframe><key name="k" qpos="2 1 0 .5 .7"/><key name="short" qpos="1 0"/></keyframe>)";
  const Scene scene = scene_of_text(text, {{{"pose", "k"}}});
  // mujoco 4.0's geom_xpos.
  expect_near(at(scene.shapes[0]), {1.38571429, 0.25714286, 0.92857143}, 1e-8);
  expect_near(at(scene.shapes[1]), {1.21376606, 0.60559592, 0.27957466}, 1e-8);
  EXPECT_THAT(complaint([&] {
                scene_of_text(text, {{{"pose", "short"}}});
              }),
              HasSubstr("robot.xml:3:"));
  EXPECT_THAT(complaint([&] {
                scene_of_text(text, {{{"pose", "x"}}});
              }),
              HasSubstr("no keyframe 'x' (it has: k, short)"));
  const Scene free =
      world("<body pos='1 2 3'><freejoint name='f'/><geom size='1' pos='1 0 0'/></body>",
            {{{"pose", "f=0 0 7 1 0 0 1"}}});
  expect_near(at(free.shapes[0]), {0, 1, 7});
  // As the file has it where nobody says more.
  expect_near(at(world("<body pos='1 2 3'><freejoint name='f'/><geom size='1' pos='1 0 0'/></body>")
                     .shapes[0]),
              {2, 2, 3});
}

// Mocap bodies stand where a keyframe's mpos and mquat put them, each by its own numbers in the
// order of the bodies; a quarter turn about x takes y to z, one about z takes x to y.
TEST(Mjcf, KeyframesPlaceMocapBodies) {
  const std::string text =
      R"(<worldbody><body mocap="true" pos="9 9 9"><geom size=".1" pos="0 1 0"/></body><body pos="5 5 5"><geom size=".1"/></body>
<body mocap="true"><geom size=".1" pos="1 0 0"/></body></worldbody>
<keyframe><key name="k" mpos="1 2 3 40 50 60" mquat="1 1 0 0 2 0 0 2"/><key name="first" mpos="1 2 3"/></keyframe>)";
  const Scene scene = scene_of_text(text, {{{"pose", "k"}}});
  expect_near(at(scene.shapes[0]), {1, 2, 4});
  expect_near(at(scene.shapes[1]), {5, 5, 5});
  expect_near(at(scene.shapes[2]), {40, 51, 60});
  // Without: as written.
  const Scene written = scene_of_text(text);
  expect_near(at(written.shapes[0]), {9, 10, 9});
  expect_near(at(written.shapes[2]), {1, 0, 0});
  // Numbers for the first alone leave the second where it is.
  const Scene first = scene_of_text(text, {{{"pose", "first"}}});
  expect_near(at(first.shapes[0]), {1, 3, 3});
  expect_near(at(first.shapes[2]), {1, 0, 0});
}

TEST(Mjcf, FilesAreIncludedWhereTheyAreNamed) {
  const std::string part =
      test::write_file("part.xml", "<mujocoinclude><geom name='a' size='1'/></mujocoinclude>")
          .string();
  const std::string settings =
      test::write_file("settings.xml",
                       "<x><compiler angle='radian'/><default><geom pos='0 0 9'/></default></x>")
          .string();
  const Scene scene = scene_of_text("<worldbody><body pos='1 0 0'><include file='" + part +
                                    "'/></body></worldbody><include file='" + settings + "'/>");
  expect_near(at(named(scene, "a")), {1, 0, 9});
  const std::string again =
      test::write_file("again.xml", "<x><include file='again.xml'/></x>").string();
  EXPECT_THAT(complaint([&] { scene_of_text("\n<include file='" + again + "'/>"); }),
              HasSubstr("again.xml:1:5: "));
  EXPECT_THAT(complaint([] { scene_of_text("\n<include file='none.xml'/>"); }),
              HasSubstr("robot.xml:2:2: "));
}

// A file that has no canonical name: a link to itself.
TEST(Mjcf, AnIncludedFileThatCannotBeReadIsNamed) {
  const std::filesystem::path path =
      test::write_file("robot.xml", "<mujoco>\n<include file='loop.xml'/></mujoco>");
  std::filesystem::create_symlink("loop.xml", path.parent_path() / "loop.xml");
  EXPECT_THAT(complaint([&] { import_scene(path, test::NoImages()); }),
              testing::AllOf(HasSubstr("robot.xml:2:"), HasSubstr("loop.xml")));
}

TEST(Mjcf, ModelsAreAttachedWithTheirOwnSettings) {
  const std::string arm =
      test::write_file(
          "arm.xml",
          R"(<mujoco model="arm"><compiler angle="radian"/><default><geom size=".25"/></default>
<worldbody><body name="base" pos="0 0 2"><geom name="g" pos="1 0 0"/><body name="tip" pos="0 5 0" euler="0 0 1.5707963267948966"><geom name="t" pos="1 0 0"/></body></body>
<geom name="floor"/></worldbody></mujoco>)")
          .string();
  const std::string asset = "<asset><model name='m' file='" + arm + "'/></asset>";
  const Scene scene = scene_of_text(asset +
                                    "<worldbody><body pos='1 0 0'><attach model='m' body='base' "
                                    "prefix='p_'/></body></worldbody>");
  expect_near(at(named(scene, "p_g")), {2, 0, 2});
  expect_near(at(named(scene, "p_t")), {1, 6, 2});
  EXPECT_EQ(scene.shapes.size(), 2U);
  // A body that is within others comes with its own place alone.
  const Scene tip =
      scene_of_text(asset + "<worldbody><attach model='m' body='tip' prefix='p_'/></worldbody>");
  expect_near(at(named(tip, "p_t")), {0, 6, 0});
  EXPECT_EQ(
      scene_of_text(asset + "<worldbody><attach model='m' prefix='p_'/></worldbody>").shapes.size(),
      3U);
  const std::string unnamed = "<asset><model file='" + arm + "'/></asset>";
  EXPECT_EQ(scene_of_text(unnamed + "<worldbody><attach model='arm' prefix='p_'/></worldbody>")
                .shapes.size(),
            3U);
  const auto self = test::write_file(
      "self.xml", "<mujoco model='s'><asset><model file='self.xml'/></asset></mujoco>");
  EXPECT_THAT(complaint([&] { scene_of(self); }), HasSubstr("attached to itself"));
}

TEST(Mjcf, MeshesLieWhereTheFileSays) {
  const Scene scene = scene_of_text(
      R"(<asset><mesh name="t" vertex="0 0 0 1 0 0 0 2 0 0 0 3" face="0 2 1 0 1 3 0 3 2 1 2 3"
refpos=".1 .2 .3" refquat=".7 .1 .2 .3" scale="1 2 3"/></asset><worldbody><geom type="mesh" mesh="t" pos="1 1 1"/></worldbody>)");
  const auto& mesh = std::get<TriangleMeshShape>(scene.shapes[0].geometry);
  ASSERT_EQ(mesh.positions.size(), 4U);
  // mujoco 4.0: mesh_vert under geom_xmat and geom_xpos.
  const glm::dvec3 expected[] = {{0.89999999, 0.6, 0.10000012},
                                 {1.48730158, -0.60634919, 1.7190476},
                                 {2.36031747, 3.33015864, -0.09047628},
                                 {-0.14761902, 3.07619046, 7.67142845}};
  for (std::size_t i = 0; i < 4; ++i)
    expect_near(at(scene.shapes[0], mesh.positions[i]), expected[i], 1e-6);
}

TEST(Mjcf, MeshFilesAreSoughtInTheirFolder) {
  const std::filesystem::path folder = test::temporary_folder();
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
  };
  write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nmtllib none.mtl\n");
  std::string msh(16 + 9 * 4 + 6 * 4 + 3 * 4, '\0');
  const std::int32_t counts[] = {3, 0, 3, 1}, face[] = {0, 1, 2};
  const float positions[] = {0, 0, 5, 1, 0, 5, 0, 1, 5}, uvs[] = {0, 0.25F, 1, 0, 0, 1};
  std::memcpy(msh.data(), counts, 16);
  std::memcpy(msh.data() + 16, positions, 36);
  std::memcpy(msh.data() + 52, uvs, 24);
  std::memcpy(msh.data() + 76, face, 12);
  write("u.msh", msh);
  const std::string assets =
      "<compiler meshdir='" + folder.string() +
      "'/><asset><mesh file='t.obj' scale='2 2 2'/><mesh name='u' file='u.msh'/></asset>";
  const Scene scene = scene_of_text(
      assets + "<worldbody><geom type='mesh' mesh='t'/><geom type='mesh' mesh='u'/></worldbody>");
  expect_near(at(scene.shapes[0], {1, 0, 0}), {2, 0, 0});
  const auto& mesh = std::get<TriangleMeshShape>(scene.shapes[1].geometry);
  EXPECT_EQ(mesh.positions[2], glm::vec3(0, 1, 5));
  EXPECT_EQ(mesh.uvs[0], glm::vec2(0, 0.75F));  // there v counts from the top
  EXPECT_THAT(complaint([&] {
                scene_of_text(assets + "<worldbody><geom type='mesh' mesh='v'/></worldbody>");
              }),
              HasSubstr("no mesh 'v'"));
  EXPECT_NE(complaint([&] {
              scene_of_text(
                  "<asset><mesh file='w.stl'/></asset><worldbody><geom type='mesh' "
                  "mesh='w'/></worldbody>");
            }),
            "");
  write("u.msh", msh.substr(0, 80));
  EXPECT_THAT(complaint([&] {
                scene_of_text(assets + "<worldbody><geom type='mesh' mesh='u'/></worldbody>");
              }),
              HasSubstr("need 88 bytes"));
}

TEST(Mjcf, HeightFieldsAreSolid) {
  const Scene scene = scene_of_text(
      R"(<asset><hfield name="h" nrow="2" ncol="3" size="1 2 3 .1" elevation="0 1 2 3 4 5"/></asset>
<worldbody><geom type="hfield" hfield="h"/></worldbody>)");
  const auto& mesh = std::get<TriangleMeshShape>(scene.shapes[0].geometry);
  ASSERT_EQ(mesh.positions.size(), 12U);
  // mujoco 4.0's hfield_data: 0.6 0.8 1 0 0.2 0.4, rows from the least y.
  expect_near(mesh.positions[0], {-1, -2, 1.8}, 1e-6);
  expect_near(mesh.positions[5], {1, 2, 1.2}, 1e-6);
  EXPECT_FLOAT_EQ(mesh.positions[6].z, -0.1F);
  EXPECT_EQ(open_edges(scene.shapes[0]),
            0);  // four triangles above and below, two for each of six sides
  EXPECT_EQ(mesh.triangles.size(), 4U + 4U + 12U);
}

// MuJoCo's own files: two whole numbers, then the heights as hfield_data has them, rows from the
// least y.
TEST(Mjcf, HeightFieldsOfBinaryFiles) {
  const std::int32_t counts[] = {2, 3};
  const float heights[] = {5, 6, 7, 8, 9, 10};
  std::string bytes(reinterpret_cast<const char*>(counts), sizeof counts);
  bytes.append(reinterpret_cast<const char*>(heights), sizeof heights);
  const std::string path = test::write_file("h.hfield", bytes).string();
  const std::string text =
      "<asset><hfield name='h' file='" + path +
      "' size='1 2 3 .1'/></asset><worldbody><geom type='hfield' hfield='h'/></worldbody>";
  const Scene scene = scene_of_text(text);
  const auto& mesh = std::get<TriangleMeshShape>(scene.shapes[0].geometry);
  ASSERT_EQ(mesh.positions.size(), 12U);
  expect_near(mesh.positions[0], {-1, -2, 0}, 1e-6);
  expect_near(mesh.positions[1], {0, -2, 0.6}, 1e-6);
  expect_near(mesh.positions[5], {1, 2, 3}, 1e-6);
  for (const std::string& wrong : {bytes.substr(0, 28), bytes + "1234", bytes.substr(0, 7)}) {
    std::ofstream(path, std::ios::binary) << wrong;
    EXPECT_THAT(complaint([&] { scene_of_text(text); }), HasSubstr("h.hfield")) << wrong.size();
  }
}

TEST(Mjcf, GroupsAndAlphaSayWhatIsSeen) {
  const std::string text =
      R"(<geom size="1" name="a"/><geom size="1" name="b" group="3"/><geom size="1" name="c" group="2" contype="0" conaffinity="0"/>
<geom size="1" name="d" rgba="1 1 1 0"/><site name="s" size="1"/>)";
  const auto seen = [&](const char* groups) {
    ImportOptions options;
    if (groups) options.set("groups", groups);
    std::string out;
    for (const Shape& shape : world(text, options).shapes) out += shape.name;
    return out;
  };
  EXPECT_EQ(seen(nullptr), "ac");
  EXPECT_EQ(seen("collision"), "ab");
  EXPECT_EQ(seen("all"), "abc");
  EXPECT_EQ(seen("0,3"), "ab");
  EXPECT_THAT(complaint([&] { seen("0,6"); }), HasSubstr("--groups"));
}

TEST(Mjcf, TendonsFromSiteToSiteAreCapsules) {
  const Scene scene = scene_of_text(
      R"(<worldbody><geom size=".1"/><site name="a" pos="0 0 1"/><body pos="1 0 1"><site name="b"/><site name="c" pos="0 2 0"/></body></worldbody>
<tendon><spatial name="t" width=".01"><site site="a"/><site site="b"/><pulley divisor="2"/><site site="b"/><site site="c"/></spatial></tendon>)");
  ASSERT_EQ(scene.shapes.size(), 3U);
  expect_near(at(scene.shapes[1]), {0.5, 0, 1});
  expect_near(at(scene.shapes[2]), {1, 1, 1});
  EXPECT_EQ(std::get<CapsulesShape>(scene.shapes[2].geometry).p1[0].z, 1);
  EXPECT_EQ(std::get<CapsulesShape>(scene.shapes[2].geometry).radius0[0], 0.01F);
}

TEST(Mjcf, BadFilesAreRefusedWithTheirPlace) {
  const auto said = [](const std::string& text) { return complaint([&] { scene_of_text(text); }); };
  EXPECT_THAT(complaint([] { scene_of(test::write_file("robot.xml", "<robots/>")); }),
              HasSubstr("not <mujoco>"));
  EXPECT_THAT(said("\n<world/>"), HasSubstr("robot.xml:2:2: <mujoco> has no section 'world'"));
  EXPECT_THAT(said("\n<worldbody>\n  <geom szie='1'/></worldbody>"),
              HasSubstr("robot.xml:3:4: <geom> has no attribute 'szie'"));
  EXPECT_THAT(said("<worldbody><geom size='x'/></worldbody>"), HasSubstr("'x' is not a number"));
  EXPECT_THAT(said("<worldbody><geom type='box' size='1 1'/></worldbody>"),
              HasSubstr("3 positive numbers"));
  EXPECT_THAT(said("<worldbody><geom type='cube' size='1'/></worldbody>"),
              HasSubstr("none of: plane"));
  EXPECT_THAT(said("<worldbody><geom size='1' class='x'/></worldbody>"),
              HasSubstr("no default class 'x'"));
  EXPECT_THAT(said("<worldbody><ball/></worldbody>"), HasSubstr("a body has no 'ball'"));
  EXPECT_THAT(said("<worldbody/>"), HasSubstr("holds no geoms"));
  EXPECT_THAT(said("<option/>"), HasSubstr("robot.xml:1:2: holds no geoms"));
  EXPECT_THAT(said("<compiler coordinate='global'/>"), HasSubstr("only 'local'"));
  EXPECT_THAT(said("<default class='x'/>"), HasSubstr("'main'"));
  EXPECT_THAT(said("<default><default class='x'/><default class='x'/></default>"),
              HasSubstr("was there before"));
  EXPECT_THAT(said("<worldbody><geom size='1' material='m'/></worldbody>"),
              HasSubstr("no material 'm'"));
  EXPECT_THAT(said("<worldbody><geom size='1' fromto='0 0 0 1 1 1'/></worldbody>"),
              HasSubstr("only capsules"));
  std::string fields, geoms;
  for (const char name : {'a', 'b', 'c', 'd'}) {
    fields += fmt::format("<hfield name='{}' nrow='2048' ncol='2048' size='1 1 1 1'/>", name);
    geoms += fmt::format("<geom type='hfield' hfield='{}'/>", name);
  }
  EXPECT_THAT(said("<asset>" + fields + "</asset><worldbody>" + geoms + "</worldbody>"),
              HasSubstr("1073741824 bytes"));
  EXPECT_THAT(said("<worldbody><geom size='1' group='1e12'/></worldbody>"),
              HasSubstr("no geometry of the groups"));
  const std::string million =
      "<replicate count='1000'><replicate count='1000'><replicate count='1000'><geom "
      "size='1'/></replicate></replicate></replicate>";
  EXPECT_THAT(said("<worldbody>" + million + "</worldbody>"), HasSubstr("more than"));
  std::string deep;
  for (int i = 0; i < 600; ++i) deep += "<body>";
  EXPECT_THAT(said("<worldbody>" + deep), HasSubstr("robot.xml:"));
  std::string closed = deep + "<geom size='1'/>";
  for (int i = 0; i < 600; ++i) closed += "</body>";
  EXPECT_THAT(said("<worldbody>" + closed + "</worldbody>"), HasSubstr("nested"));
  std::string classes = "<default>";
  for (int i = 0; i < 600; ++i) classes += fmt::format("<default class='c{}'>", i);
  for (int i = 0; i < 601; ++i) classes += "</default>";
  EXPECT_THAT(said(classes), HasSubstr("default classes are nested too deep"));
}

/// An L of height 1/2, as a mesh in the file.
std::string prism(const std::string& mesh, const std::string& compiler, const std::string& geoms) {
  return "<compiler " + compiler + "/><asset><mesh name='m' " + mesh +
         " vertex='0 0 0 3 0 0 3 1 0 1 1 0 1 2 0 0 2 0 0 0 .5 3 0 .5 3 1 .5 1 1 .5 1 2 .5 0 2 .5' "
         "face='0 2 1 0 3 2 0 4 3 0 5 4 6 7 8 6 8 9 6 9 10 6 10 11 0 1 7 0 7 6 1 2 8 1 8 7 2 3 9 2 "
         "9 8 3 4 10 3 10 9 4 5 11 4 11 "
         "10 5 0 6 "
         "5 6 11'/></asset><worldbody>" +
         geoms + "</worldbody>";
}

// Sizes and places by mujoco 4.0.0 (geom_size, geom_xpos, and the longest axis, the last column of
// geom_xmat), to its nine digits.
TEST(Mjcf, SolidsAreFittedToMeshes) {
  const std::string geoms =
      "<geom type='sphere' mesh='m'/><geom type='capsule' mesh='m'/><geom type='cylinder' "
      "mesh='m'/><geom type='ellipsoid' "
      "mesh='m'/><geom type='box' mesh='m'/>";
  struct Fitted {
    std::string mesh, compiler;
    double sphere, radius, capsule, cylinder;
    glm::dvec3 box, place, longest;
  };
  const Fitted all[] = {{"",
                         "",
                         0.86637113,
                         0.52185792,
                         1.29446859,
                         1.55539755,
                         {0.24805275, 0.7956631, 1.55539755},
                         {1.24215432, 0.77436291, 0.25},
                         {0.9447, -0.328, 0}},
                        {"inertia='exact'",
                         "",
                         0.87390275,
                         0.52028471,
                         1.32099648,
                         1.58113883,
                         {0.25, 0.79056942, 1.58113883},
                         {1.25, 0.75, 0.25},
                         {0.9487, -0.3162, 0}},
                        {"inertia='shell'",
                         "",
                         1.00299304,
                         0.65082651,
                         1.38191285,
                         1.7073261,
                         {0.373394, 0.92825902, 1.7073261},
                         {1.26923077, 0.76923077, 0.25},
                         {0.9477, -0.3193, 0}},
                        {"",
                         "fitaabb='true'",
                         1.74503071,
                         1.10868223,
                         0.63634848,
                         1.74503071,
                         {0.25, 1.10868223, 1.74503071},
                         {1.39239666, 0.69012122, 0.25},
                         {0.9447, -0.328, 0}}};
  for (const Fitted& one : all) {
    const Scene scene = scene_of_text(prism(one.mesh, one.compiler, geoms));
    ASSERT_EQ(scene.shapes.size(), 5U);
    constexpr double digits = 1e-8;
    EXPECT_NEAR(std::get<SphereShape>(scene.shapes[0].geometry).radius, one.sphere, digits);
    const auto capsule = std::get<CapsulesShape>(scene.shapes[1].geometry);
    EXPECT_NEAR(static_cast<double>(capsule.radius0[0]), one.radius, 1e-7);  // a float
    EXPECT_NEAR(static_cast<double>(capsule.p1[0].z), one.capsule, 2e-7);
    EXPECT_NEAR(std::get<CylinderShape>(scene.shapes[2].geometry).p1.z, one.cylinder, digits);
    expect_near(std::get<BoxShape>(scene.shapes[4].geometry).p1, one.box, digits);
    for (const Shape& shape : scene.shapes) {
      expect_near(at(shape), one.place, digits);
      EXPECT_NEAR(std::abs(glm::dot(glm::normalize(way(shape, {0, 0, 1})), one.longest)), 1,
                  1e-4);  // of either sign
    }
    EXPECT_NEAR(glm::length(way(scene.shapes[3], {1, 0, 0})), one.box.x, digits);
  }
  // Mirrored.
  const Scene mirrored =
      scene_of_text(prism("inertia='exact' scale='-1 1 1'", "", "<geom type='box' mesh='m'/>"));
  expect_near(at(mirrored.shapes.at(0)), {-1.25, 0.75, 0.25}, 1e-8);
  expect_near(std::get<BoxShape>(mirrored.shapes[0].geometry).p1, {0.25, 0.79056942, 1.58113883},
              1e-8);
  // Scaled, moved and turned.
  const Scene scene = scene_of_text(prism("scale='1 2 1' refpos='1 0 0'", "",
                                          "<body pos='.5 0 0'><geom type='capsule' mesh='m' "
                                          "fitscale='.5' pos='1 2 3' euler='0 0 90'/></body>"));
  const auto capsule = std::get<CapsulesShape>(scene.shapes.at(0).geometry);
  EXPECT_NEAR(static_cast<double>(capsule.radius0[0]), 0.37160654, 1e-7);
  EXPECT_NEAR(static_cast<double>(capsule.p1[0].z), 0.81346982, 1e-7);
  expect_near(at(scene.shapes[0]), {-0.04374337, 2.24270944, 3.25}, 1e-8);
  // What is named and left out.
  for (const char* left_out : {"<geom type='box' mesh='m'/>", "<composite type='cable'/>",
                               "<flexcomp name='f' type='grid'/>"}) {
    const Scene rest =
        scene_of_text(prism("inertia='convex'", "", std::string("<geom size='1'/>") + left_out));
    EXPECT_EQ(rest.shapes.size(), 1U) << left_out;
  }
  // A square has no volume.
  const std::string flat =
      "<asset><mesh name='f' vertex='0 0 0 1 0 0 1 1 0 0 1 0' face='0 1 2 0 2 3'/></asset>";
  EXPECT_EQ(
      scene_of_text(flat + "<worldbody><geom size='1'/><geom type='box' mesh='f'/></worldbody>")
          .shapes.size(),
      1U);
  EXPECT_THAT(
      complaint([&] { scene_of_text(prism("", "", "<geom type='box' mesh='m' fitscale='0'/>")); }),
      HasSubstr("fitscale"));
}

// A block of half sizes 1/2, 1 and 2 about (3, 0, 0), half of its faces in another group: it is
// fitted as itself.
TEST(Mjcf, SolidsAreFittedToAllPartsOfAFile) {
  const std::filesystem::path file =
      test::write_file("block.obj",
                       "v 2.5 -1 -2\nv 3.5 -1 -2\nv 3.5 1 -2\nv 2.5 1 -2\nv 2.5 -1 2\nv 3.5 -1 "
                       "2\nv 3.5 1 2\nv 2.5 1 2\n"
                       "g one\nusemtl a\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\ng two\nusemtl b\nf 2 3 7 "
                       "6\nf 3 4 8 7\nf 4 1 5 8\n");
  for (const char* compiler : {"", "fitaabb='true'"}) {
    const Scene scene = scene_of_text(std::string("<compiler ") + compiler +
                                      "/><asset><mesh name='m' file='" + file.string() +
                                      "' inertia='exact'/></asset><worldbody>"
                                      "<geom type='box' mesh='m'/></worldbody>");
    ASSERT_EQ(scene.shapes.size(), 1U) << compiler;
    expect_near(std::get<BoxShape>(scene.shapes[0].geometry).p1, {0.5, 1, 2}, 1e-6);
    expect_near(at(scene.shapes[0]), {3, 0, 0}, 1e-6);
  }
}

TEST(Mjcf, SharedFilesHaveTheirGeoms) {
  CAPLET_NEEDS_DATA();
  // mujoco 4.0's ngeom: 100 and 22 humanoids of 19 geoms, on a floor. The arm's muscles wrap around
  // geoms and are left out.
  struct Counts {
    const char* name;
    std::size_t geoms;
  };
  for (const Counts& file :
       {Counts{"dm_control_suite/humanoid.xml", 20}, Counts{"gymnasium/ant.xml", 14},
        Counts{"mujoco/humanoid/humanoid.xml", 20}, Counts{"mujoco/humanoid/22_humanoids.xml", 419},
        Counts{"mujoco/humanoid/100_humanoids.xml", 1901},
        Counts{"mujoco/replicate/helix.xml", 101}, Counts{"mujoco/tendon_arm/arm26.xml", 5}}) {
    EXPECT_EQ(
        scene_of(test::data_folder() / "mjcf" / file.name, {{{"groups", "all"}}}).shapes.size(),
        file.geoms)
        << file.name;
  }
}

}  // namespace
}  // namespace caplet::mjcf_test
