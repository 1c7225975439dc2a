// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Robots: the conventions of docs/formats/robots.md by hand, counts of the shared files, and bad
// input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "import/import.h"
#include "support/data.h"
#include "support/import_files.h"

namespace caplet::robots_test {
namespace {

using test::complaint;
using testing::HasSubstr;

Scene scene_of(const std::filesystem::path& path, const ImportOptions& options = {}) {
  return import_scene(path, test::NoImages(), options);
}
Scene scene_of_text(const std::string& text, const ImportOptions& options = {}) {
  return scene_of(test::write_file("robot.urdf", text), options);
}
glm::dvec3 at(const Shape& shape, glm::dvec3 p) {
  return glm::dvec3(shape.world_from_object * glm::dvec4(p, 1));
}
void expect_near(glm::dvec3 a, glm::dvec3 b) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 1e-9) << k;
}

const std::string arm =
    R"(<robot name="r"><link name="a"><visual><geometry><box size="2 4 6"/></geometry></visual></link>
<link name="b"><visual><origin xyz="1 0 0"/><geometry><sphere radius="0.5"/></geometry></visual>
<collision><geometry><capsule radius="0.1" length="2"/></geometry></collision></link>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0 0 3" rpy="1.5707963267948966 0 1.5707963267948966"/>
<axis xyz="0 0 2"/></joint></robot>)";

TEST(Urdf, LinksLieWhereJointsPutThem) {
  const Scene scene = scene_of_text(arm, {{{"up", "y"}}});
  ASSERT_EQ(scene.shapes.size(), 2U);
  const auto box = std::get<BoxShape>(scene.shapes[0].geometry);
  expect_near(box.p1, {1, 2, 3});
  // Fixed x, then z: the child's x is the parent's y, its y the parent's z, its z the parent's x.
  expect_near(at(scene.shapes[1], {0, 0, 0}), {0, 1, 3});
  expect_near(at(scene.shapes[1], {0, 0, 1}), {1, 1, 3});
}

TEST(Urdf, JointsTurnAboutTheirAxis) {
  const Scene scene = scene_of_text(arm, {{{"up", "y"}, {"pose", "j=1.5707963267948966"}}});
  expect_near(at(scene.shapes[1], {0, 0, 0}), {0, 0, 4});
  EXPECT_THAT(complaint([] {
                scene_of_text(arm, {{{"pose", "k=1"}}});
              }),
              HasSubstr("no joint 'k'"));
  EXPECT_THAT(complaint([] { scene_of_text(arm, {{{"pose", "j"}}}); }), HasSubstr("JOINT=VALUE"));
}

// A chain of slides along x: b is moved itself, c follows b, and d follows c
// (wiki.ros.org/urdf/XML/joint: multiplier times the other's value plus offset).
TEST(Urdf, MimicJointsFollowOthers) {
  const auto slide = [](const std::string& name, const std::string& child, const std::string& mimic,
                        const std::string& type = "prismatic") {
    return "<joint name='" + name + "' type='" + type + "'><parent link='a'/><child link='" +
           child + "'/>" + mimic + "</joint>";
  };
  const auto robot = [&](const std::string& of_c, const std::string& of_d,
                         const std::string& type = "prismatic") {
    std::string text =
        "<robot><link name='a'><visual><geometry><box size='1 1 1'/></geometry></visual></link>";
    for (const char* name : {"b", "c", "d"})
      text += std::string("<link name='") + name +
              "'><visual><geometry><sphere radius='.1'/></geometry></visual></link>";
    return text + slide("jb", "b", "") + slide("jc", "c", of_c) + slide("jd", "d", of_d, type) +
           "</robot>";
  };
  const auto places = [&](const std::string& text, const std::string& pose) {
    ImportOptions options{{{"up", "y"}}};
    if (!pose.empty()) options.set("pose", pose);
    std::vector<double> out;
    const Scene scene = scene_of_text(text, options);
    for (const char* name : {"b", "c", "d"})
      for (const Shape& shape : scene.shapes)
        if (shape.name == name) out.push_back(at(shape, {0, 0, 0}).x);
    return out;
  };
  const std::string half = "<mimic joint='jb' multiplier='-0.5' offset='0.25'/>",
                    same = "<mimic joint='jc'/>";
  using Places = std::vector<double>;
  EXPECT_EQ(places(robot(half, same), "jb=3"), (Places{3, -1.25, -1.25}));
  // The joint that is followed stands at 0, but the offset is there.
  EXPECT_EQ(places(robot(half, same), ""), (Places{0, 0.25, 0.25}));
  EXPECT_EQ(places(robot(half, same), "jc=2"),
            (Places{0, 2, 2}));  // posed itself: it follows no more
  EXPECT_EQ(places(robot("<mimic joint='jb'/>", "<mimic joint='jc' multiplier='3'/>"), "jb=1"),
            (Places{1, 1, 3}));
  const auto said = [&](const std::string& text) { return complaint([&] { places(text, ""); }); };
  EXPECT_THAT(said(robot("<mimic joint='nobody'/>", same)),
              testing::AllOf(HasSubstr("robot.urdf:1:"), HasSubstr("follows 'nobody'")));
  EXPECT_THAT(said(robot("<mimic joint='jd'/>", same)), HasSubstr("in a circle"));
  EXPECT_THAT(said(robot(half, same, "fixed")), HasSubstr("of type 'fixed' is not moved"));
}

TEST(Urdf, GroupsAreOnChoice) {
  const Scene scene = scene_of_text(arm, {{{"groups", "collision"}}});
  ASSERT_EQ(scene.shapes.size(), 1U);
  EXPECT_EQ(std::get<CapsulesShape>(scene.shapes[0].geometry).p1[0], glm::vec3(0, 0, 1));
  EXPECT_EQ(scene_of_text(arm, {{{"groups", "all"}}}).shapes.size(), 3U);
}

TEST(Urdf, BadFilesAreRefusedWithTheirPlace) {
  const auto said = [](const std::string& text) { return complaint([&] { scene_of_text(text); }); };
  EXPECT_THAT(said("<robot>\n<link"), HasSubstr("robot.urdf:2:"));
  EXPECT_THAT(said("<mujoco/>"), HasSubstr("not <robot>"));
  EXPECT_THAT(said("<robot>\n\n<joint name='j'><parent link='a'/></joint><link name='b'/></robot>"),
              HasSubstr("robot.urdf:3:2: "));
  EXPECT_THAT(said("<robot><link name='a'/><link name='b'/><joint><parent link='a'/><child "
                   "link='b'/></joint>"
                   "<joint><parent link='b'/><child link='a'/></joint></robot>"),
              HasSubstr("cycle"));
  EXPECT_THAT(said("<robot><link name='a'><visual><geometry><sphere "
                   "radius='nan'/></geometry></visual></link></robot>"),
              HasSubstr("not finite"));
  EXPECT_EQ(said(arm + std::string(1, '\0')), "");
}

TEST(Urdf, WhatCollidesIsDrawnWhereNothingIsToBeSeen) {
  const std::string solid = "<collision><geometry><sphere radius='0.5'/></geometry></collision>";
  const std::string begin = "<robot><link name='a'>", end = "</link></robot>";
  EXPECT_EQ(scene_of_text(begin + solid + end).shapes.size(), 1U);
  EXPECT_THAT(complaint([&] {
                scene_of_text(begin + solid + end, {{{"groups", "visual"}}});
              }),
              HasSubstr("no geometry of the groups"));
  // Where one thing is to be seen it alone is; a ball of no size is nothing, and one of less an
  // error.
  const std::string seen = "<visual><geometry><box size='1 1 1'/></geometry></visual>";
  EXPECT_EQ(scene_of_text(begin + solid + seen + end).shapes.size(), 1U);
  const std::string point = "<visual><geometry><sphere radius='0'/></geometry></visual>";
  EXPECT_EQ(scene_of_text(begin + point + seen + end).shapes.size(), 1U);
  EXPECT_THAT(
      complaint([&] {
        scene_of_text(begin + "<visual><geometry><sphere radius='-1'/></geometry></visual>" + end);
      }),
      HasSubstr("radius is not positive"));
}

/// A COLLADA file of two triangles in centimetres, with z up: a blue one at x = 100, which a node
/// moves there, and one without a material.
constexpr const char* two_colors = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Y_UP</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><lambert>
<diffuse><color>0 0 1 1</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m" name="blue"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 100 0 0 0 100 0</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1" material="s"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry><geometry id="h"><mesh>
<source id="q"><float_array id="qa" count="9">0 0 50 100 0 50 0 100 50</float_array>
<technique_common><accessor source="#qa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="w"><input semantic="POSITION" source="#q"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#w" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><translate>100 0 0</translate>
<instance_geometry url="#g"><bind_material><technique_common><instance_material symbol="s" target="#m"/></technique_common></bind_material></instance_geometry></node>
<node><instance_geometry url="#h"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>)";

glm::dvec3 color_of(const Scene& scene, const Shape& shape) {
  const Material& material = scene.materials.at(shape.material);
  const auto* diffuse = std::get_if<DiffuseMaterial>(&material.model);
  const auto* rgb = diffuse ? std::get_if<RgbSpectrum>(&diffuse->reflectance) : nullptr;
  return rgb ? glm::dvec3(rgb->rgb[0], rgb->rgb[1], rgb->rgb[2]) : glm::dvec3(-1);
}

// RViz gives the link's material to parts of a mesh that have none of their own
// (rviz/robot/robot_link.cpp). ROS takes COLLADA's unit, but not its axis.
TEST(Urdf, MeshesHaveTheMaterialsOfTheirFiles) {
  const std::filesystem::path folder = test::temporary_folder();
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(folder / name) << text;
  };
  write("two.dae", two_colors);
  write("one.mtl", "newmtl green\nKd 0 0.25 0\nillum 1\n");
  write("one.obj", "mtllib one.mtl\nusemtl green\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto mesh = [](const std::string& kind, const std::string& file) {
    return "<" + kind + "><origin xyz='0 0 5'/><geometry><mesh filename='" + file +
           "' scale='2 2 2'/></geometry><material name='r'><color rgba='1 0 0 0.5'/></material></" +
           kind + ">";
  };
  write("robot.urdf", "<robot name='r'><link name='a'>" + mesh("visual", "two.dae") +
                          mesh("visual", "two.dae") + mesh("visual", "one.obj") +
                          mesh("visual", "plain.obj") + mesh("collision", "two.dae") +
                          "</link></robot>");
  const Scene scene = scene_of(folder / "robot.urdf", {{{"up", "y"}, {"groups", "all"}}});
  ASSERT_EQ(scene.shapes.size(), 8U);
  for (const std::size_t first : {0U, 2U}) {
    const Shape &blue = scene.shapes[first], &red = scene.shapes[first + 1];
    expect_near(color_of(scene, blue), {0, 0, 1});
    EXPECT_EQ(scene.materials.at(blue.material).name, "blue");
    EXPECT_FALSE(blue.alpha.has_value());
    EXPECT_EQ(blue.name, "a");
    expect_near(color_of(scene, red), {1, 0, 0});
    ASSERT_TRUE(red.alpha.has_value());
    // 100 and 200 centimetres twice as large; 50 upwards.
    const auto corner = [](const Shape& shape, std::size_t i) {
      return at(shape, std::get<TriangleMeshShape>(shape.geometry).positions.at(i));
    };
    expect_near(corner(blue, 0), {2, 0, 5});
    expect_near(corner(blue, 1), {4, 0, 5});
    expect_near(corner(red, 0), {0, 0, 6});
    expect_near(corner(red, 2), {0, 2, 6});
  }
  EXPECT_EQ(scene.shapes[0].material, scene.shapes[2].material);
  EXPECT_EQ(scene.materials.at(scene.shapes[4].material).name, "green");
  expect_near(color_of(scene, scene.shapes[5]), {1, 0, 0});
  // What collides has no materials of its own.
  expect_near(color_of(scene, scene.shapes[6]), {1, 0, 0});
  expect_near(color_of(scene, scene.shapes[7]), {1, 0, 0});
}

TEST(Urdf, SharedFilesHaveTheirGeometry) {
  CAPLET_NEEDS_DATA();
  // Boxes, cylinders and spheres within <visual> and <collision>, as Python's ElementTree counts
  // them; the DAE meshes are not there.
  struct Counts {
    const char* name;
    std::size_t visual, all;
  };
  for (const Counts& file :
       {Counts{"01-myfirst", 1, 1}, Counts{"02-multipleshapes", 2, 2}, Counts{"03-origins", 2, 2},
        Counts{"04-materials", 3, 3}, Counts{"05-visual", 12, 12}, Counts{"06-flexible", 12, 12},
        Counts{"07-physics", 12, 24}}) {
    const auto path =
        test::data_folder() / "urdf/ros_urdf_tutorial" / (std::string(file.name) + ".urdf");
    EXPECT_EQ(scene_of(path).shapes.size(), file.visual) << file.name;
    EXPECT_EQ(scene_of(path, {{{"groups", "all"}}}).shapes.size(), file.all) << file.name;
  }
}

TEST(Urdf, SharedFileLiesWhereMujocoPutsIt) {
  CAPLET_NEEDS_DATA();
  const Scene scene =
      scene_of(test::data_folder() / "urdf/ros_urdf_tutorial/04-materials.urdf", {{{"up", "y"}}});
  std::vector<glm::dvec3> legs;
  for (const Shape& shape : scene.shapes)
    if (const auto* box = std::get_if<BoxShape>(&shape.geometry)) {
      expect_near(box->p1, {0.3, 0.05, 0.1});
      legs.push_back(at(shape, {0, 0, 0}));
      const glm::dvec3 x = at(shape, {1, 0, 0}) - legs.back();
      EXPECT_NEAR(x.z, -1, 1e-8);
      EXPECT_NEAR(x.x, 4.6e-5, 1e-6);
    }
  // geom_xpos of MuJoCo 4.0 with fusestatic and discardvisual off.
  ASSERT_EQ(legs.size(), 2U);
  if (legs[0].y > legs[1].y) std::swap(legs[0], legs[1]);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(legs[0][k], (glm::dvec3{0, -0.22, -0.05}[k]), 1e-6);
    EXPECT_NEAR(legs[1][k], (glm::dvec3{0, 0.22, -0.05}[k]), 1e-6);
  }
}

}  // namespace
}  // namespace caplet::robots_test
