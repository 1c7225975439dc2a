// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scenes that are built through the public headers are those that files of the same statements
// hold.
#include <caplet/import.h>
#include <caplet/pick.h>
#include <caplet/render.h>
#include <caplet/session.h>
#include <caplet/write.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "library_device.h"

namespace {

namespace fs = std::filesystem;
using caplet::Statement;
using testing::Contains;
using testing::HasSubstr;
using testing::IsSupersetOf;

class LibraryBuild : public testing::Test {
 protected:
  LibraryBuild()
      : folder_(fs::temp_directory_path() / ("caplet-build-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~LibraryBuild() override { fs::remove_all(folder_); }

  static bool same_pictures(caplet::Scene a, caplet::Scene b) {
    for (caplet::Scene* scene : {&a, &b}) {
      scene->set_size(24, 16);
      scene->set_samples_per_pixel(2);
    }
    const caplet::Film one = caplet::render(a, test_device()),
                       other = caplet::render(b, test_device());
    if (one.channels() != other.channels()) return false;
    for (const std::string& channel : one.channels()) {
      if (channel.ends_with(".id") ? one.ids(channel) != other.ids(channel)
                                   : one.values(channel) != other.values(channel))
        return false;
    }
    return true;
  }
  static caplet::Scene three_balls() {
    caplet::Scene scene;
    caplet::CapsuleArrays balls;
    balls.p0 = balls.p1 = {{0, 0, 0}, {3, 0, 0}, {6, 0, 0}};
    balls.radius0 = {1, 0.5F, 0.25F};
    scene.add_capsules(balls, {.name = "balls"});
    return scene;
  }
  template <class Make>
  static std::string said(Make make) {
    try {
      make();
    } catch (const caplet::InputError& error) {
      return error.messages().at(0);
    }
    return {};
  }

  fs::path folder_;
};

TEST_F(LibraryBuild, WhatStatementsSayIsWhatTextSays) {
  std::ofstream(folder_ / "scene.pbrt") << R"(LookAt 3 2 6  0 0.5 0  0 1 0
Camera "perspective" "float fov" 30 "float readout" 0.25 "string readoutorder" "up" "integer blades" 5
PixelFilter "triangle" "float xradius" 1
Integrator "path" "integer maxdepth" 7
WorldBegin
LightSource "spot" "point3 from" [1 5 2] "point3 to" [0 0 0] "rgb I" [90 80 70]
LightSource "infinite" "blackbody L" 5000
Texture "squares" "float" "checkerboard" "float uscale" 4
Material "hair" "rgb reflectance" [0.5 0.3 0.1]
Shape "capsules" "point3 p0" [0 0 0 1 0 0] "point3 p1" [0 1 0 1 1 0] "float radius" [0.5 0.25]
Material "dielectric" "float eta" 1.4
MakeNamedMedium "fog" "string type" "homogeneous" "float sigma_a" 0.5 "float sigma_s" 2
AttributeBegin
Translate 2 0 0
MediumInterface "fog" ""
Shape "cylinder" "point3 p0" [0 0 0] "point3 p1" [0 1 0] "float radius" 0.5 "string caps" ["round" "flat"]
AttributeEnd
Material "diffuse"
AttributeBegin
AreaLightSource "diffuse" "rgb L" [2 1 1]
Shape "disk" "texture alpha" "squares"
AttributeEnd
ObjectBegin "leaf"
Shape "trianglemesh" "point3 P" [0 0 1 1 0 1 0 1 1] "integer indices" [0 1 2]
ObjectEnd
ObjectInstance "leaf"
)";
  caplet::Scene scene;
  scene.set_option(Statement::filter, "triangle", {{"xradius", 1.0}});
  scene.set_option(Statement::integrator, "path", {{"maxdepth", 7.0}});
  scene.set_camera("perspective",
                   {{"fov", 30.0}, {"readout", 0.25}, {"readoutorder", "up"}, {"blades", 5.0}},
                   caplet::identity);
  scene.look_at({3, 2, 6}, {0, 0.5, 0}, {0, 1, 0});
  using Point = std::array<double, 3>;
  scene.add_light("spot",
                  {{"from", Point{1, 5, 2}}, {"to", Point{0, 0, 0}}, {"I", Point{90, 80, 70}}});
  scene.add_light("infinite", {{"L", caplet::Blackbody{5000}}});
  const caplet::TextureNumber squares =
      scene.add_texture({"checkerboard", true, {{"uscale", 4.0}}});
  const std::uint32_t hair = scene.add_material(
      "", caplet::NamedMaterial{"hair", {{"reflectance", caplet::Rgb{0.5, 0.3, 0.1}}}});
  const std::uint32_t glass =
      scene.add_material("", caplet::NamedMaterial{"dielectric", {{"eta", 1.4}}});
  const std::uint32_t grey = scene.add_material("", caplet::Diffuse{});
  caplet::CapsuleArrays two;
  two.p0 = {{0, 0, 0}, {1, 0, 0}};
  two.p1 = {{0, 1, 0}, {1, 1, 0}};
  two.radius0 = {0.5F, 0.25F};
  EXPECT_EQ(scene.add_capsules(two, {.materials = {hair}}), 0U);
  const std::uint32_t fog =
      scene.add_medium("fog", "homogeneous", {{"sigma_a", 0.5}, {"sigma_s", 2.0}});
  caplet::ShapeOptions in_fog{.materials = {glass}, .inside = fog};
  in_fog.transform[3] = 2;
  scene.add_shape("cylinder",
                  {{"p0", Point{0, 0, 0}},
                   {"p1", Point{0, 1, 0}},
                   {"radius", 0.5},
                   {"caps", std::vector<std::string>{"round", "flat"}}},
                  in_fog);
  scene.add_shape("disk", {{"alpha", squares}},
                  {.materials = {grey}, .emission = caplet::Parameters{{"L", Point{2, 1, 1}}}});
  caplet::MeshArrays mesh;
  mesh.positions = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_EQ(scene.add_mesh(mesh, {.materials = {grey}, .object = "leaf"}), 3U);
  EXPECT_EQ(scene.place(3), (std::pair<std::string, std::size_t>{"leaf", 0}));
  EXPECT_EQ(scene.add_instances("leaf", std::vector{caplet::identity}), 0U);
  scene.present();
  EXPECT_TRUE(same_pictures(scene, caplet::import_scene(folder_ / "scene.pbrt")));
  caplet::write_scene(scene, folder_ / "written.pbrt");
  EXPECT_TRUE(same_pictures(scene, caplet::import_scene(folder_ / "written.pbrt")));
}

TEST_F(LibraryBuild, MolecularSurfacesAreThoseOfTheFile) {
  std::ofstream(folder_ / "scene.pbrt")
      << "WorldBegin\n"
         "MakeNamedMaterial \"red\" \"string type\" \"diffuse\" \"rgb reflectance\" [1 0 0]\n"
         "MakeNamedMaterial \"blue\" \"string type\" \"diffuse\" \"rgb reflectance\" [0 0 1]\n"
         "NamedMaterial \"red\"\n"
         "Shape \"molecularsurface\" \"point3 P\" [0 0 0 2 0 0] \"float radius\" [1 0.5]\n"
         "\"float probe\" 0.75 \"string ballmaterials\" [\"red\" \"blue\"] \"integer "
         "materialindices\" [0 1]\n";
  caplet::Scene scene;
  const std::uint32_t red = scene.add_material(
      "red", caplet::NamedMaterial{"diffuse", {{"reflectance", caplet::Rgb{1, 0, 0}}}});
  const std::uint32_t blue = scene.add_material(
      "blue", caplet::NamedMaterial{"diffuse", {{"reflectance", caplet::Rgb{0, 0, 1}}}});
  const caplet::BallArrays balls{{{0, 0, 0}, {2, 0, 0}}, {1, 0.5F}, {red, blue}};
  EXPECT_EQ(scene.add_molecular_surface(balls, 0.75, {.materials = {red}}), 0U);
  scene.present();
  EXPECT_TRUE(same_pictures(scene, caplet::import_scene(folder_ / "scene.pbrt")));
  EXPECT_THROW(scene.add_molecular_surface({}, 0.75), caplet::InputError);
  EXPECT_THROW(scene.add_molecular_surface({{{0, 0, 0}}, {-1}, {}}, 0.75), caplet::InputError);
  EXPECT_THROW(scene.add_molecular_surface({{{0, 0, 0}}, {1}, {7}}, 0.75), caplet::InputError);
  EXPECT_THROW(scene.add_molecular_surface(balls, 0), caplet::InputError);
}

TEST_F(LibraryBuild, TypesAndParametersAreThoseOfTheLists) {
  EXPECT_THAT(caplet::statement_types(Statement::light),
              IsSupersetOf({"point", "spot", "ies", "infinite"}));
  EXPECT_THAT(caplet::statement_types(Statement::medium), IsSupersetOf({"homogeneous", "nanovdb"}));
  EXPECT_THAT(caplet::statement_types(Statement::shape), IsSupersetOf({"box", "csg", "sphere"}));
  const auto names = [](Statement statement, const std::string& type) {
    std::vector<std::string> out;
    for (const caplet::KnownParameter& one : caplet::statement_parameters(statement, type))
      out.push_back(one.name);
    return out;
  };
  EXPECT_THAT(names(Statement::light, "spot"),
              testing::UnorderedElementsAre("scale", "power", "I", "from", "to", "coneangle",
                                            "conedeltaangle"));
  // Those of both kinds of cylinder, which no statement has at once.
  EXPECT_THAT(names(Statement::shape, "cylinder"),
              IsSupersetOf({"p0", "p1", "caps", "zmin", "phimax"}));
  for (const auto& one : caplet::statement_parameters(Statement::light, "spot")) {
    if (one.name == "I") continue;
    EXPECT_EQ(one.types,
              std::vector<std::string>{one.name == "from" || one.name == "to" ? "point3" : "float"})
        << one.name;
  }
  for (const Statement statement : {Statement::shape, Statement::light, Statement::emission,
                                    Statement::medium, Statement::camera, Statement::film,
                                    Statement::filter, Statement::sampler, Statement::integrator})
    for (const std::string& type : caplet::statement_types(statement))
      EXPECT_NO_THROW(names(statement, type)) << type;
  EXPECT_THROW(names(Statement::light, "sun"), caplet::InputError);
}

TEST_F(LibraryBuild, WhatIsWrongIsToldAndChangesNothing) {
  caplet::Scene scene = three_balls();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto capsules = [&](auto change) {
    caplet::CapsuleArrays one{{{0, 0, 0}}, {{1, 0, 0}}, {1}, {}, {}};
    change(one);
    return said([&] { scene.add_capsules(one); });
  };
  EXPECT_THAT(capsules([](auto& one) { one.p0.clear(); }), HasSubstr("has 1 entries, and p0 0"));
  EXPECT_THAT(capsules([](auto& one) { one.radius1 = {1, 2}; }), HasSubstr("radius1 has 2"));
  EXPECT_THAT(capsules([&](auto& one) { one.p1[0][2] = nan; }), HasSubstr("finite"));
  EXPECT_THAT(capsules([](auto& one) { one.materials = {9}; }), HasSubstr("no material 9"));
  const auto moving = [&](std::vector<double> times, std::size_t ends, auto change) {
    return capsules([&](auto& one) {
      one.p0.resize(ends);
      one.p1.resize(ends, {1, 0, 0});
      one.radius0.resize(ends, 1);
      one.times = std::move(times);
      change(one);
    });
  };
  const auto as_is = [](auto&) {};
  EXPECT_THAT(moving({0, 1}, 3, as_is), HasSubstr("as many points at each of its times"));
  EXPECT_THAT(moving({0, 1}, 1, [](auto& one) { one.radius0 = {-1}; }),
              HasSubstr("as many points"));
  EXPECT_THAT(moving({0}, 1, as_is), HasSubstr("two times or more"));
  const std::vector<std::vector<double>> falling{{1, 0}, {0, 0}, {0, INFINITY}, {nan, 1}};
  for (const auto& times : falling)
    EXPECT_THAT(moving(times, 2, as_is),
                HasSubstr("the times of a shape that moves must be finite and rise"));
  EXPECT_THAT(moving({0, 1}, 4, [](auto& one) { one.radius0[3] = -1; }),
              HasSubstr("capsule 1 has a negative radius"));
  EXPECT_THAT(moving({0, 1}, 4, [](auto& one) { one.u.resize(4); }),
              HasSubstr("u has 4 entries, and p0 4 at 2 times"));
  EXPECT_THAT(said([&] { scene.add_shape("sphre", {}); }),
              AllOf(HasSubstr("sphre"), HasSubstr("'sphere'")));
  EXPECT_THAT(said([&] {
                scene.add_shape("sphere", {{"raduis", 1.0}});
              }),
              AllOf(HasSubstr("raduis"), HasSubstr("radius")));
  EXPECT_THAT(said([&] {
                scene.add_shape("sphere", {{"radius", std::string("one")}});
              }),
              HasSubstr("must be of type float, not \"one\""));
  EXPECT_THAT(said([&] {
                scene.add_shape("sphere", {{"radius", std::vector<double>{}}});
              }),
              HasSubstr("has no value"));
  EXPECT_THAT(said([&] {
                scene.add_shape("sphere", {{"radius", double{nan}}});
              }),
              HasSubstr("not finite"));
  EXPECT_THAT(said([&] { scene.add_shape("sphere", {}, {.inside = 4U}); }),
              HasSubstr("no medium 4"));
  caplet::ShapeOptions flat;
  flat.transform[0] = 0;
  EXPECT_THAT(said([&] { scene.add_shape("sphere", {}, flat); }), HasSubstr("singular"));
  EXPECT_THAT(said([&] {
                scene.add_light("spot", {{"from", std::vector<double>{1, 2}}});
              }),
              HasSubstr("point3, not 2 numbers"));
  EXPECT_THAT(said([&] {
                scene.add_light("infinite", {{"L", std::vector<double>{1, 2, 3, 4, 5}}});
              }),
              HasSubstr("takes 1 value, not 5"));
  EXPECT_THAT(said([&] {
                scene.add_medium("m", "homogeneous", {{"g", 2.0}});
              }),
              HasSubstr("\"g\""));
  EXPECT_THAT(said([&] { scene.add_instances("leaf", std::vector{caplet::identity}); }),
              HasSubstr("no object 'leaf'"));
  EXPECT_THAT(said([&] { scene.set_option(Statement::light, "spot", {}); }),
              HasSubstr("an option is"));
  EXPECT_THAT(said([&] {
                scene.add_shapes("box", 2, {}, {{"p0", std::vector<double>{1, 2, 3}}}, {});
              }),
              HasSubstr("3 values for 2"));
  EXPECT_THAT(said([&] { caplet::Scene().present(); }), HasSubstr("empty"));
  EXPECT_EQ(scene.shapes(), std::vector<std::string>{"balls"});
  EXPECT_EQ(scene.lights(), 0U);
  EXPECT_TRUE(scene.media().empty());
}

TEST_F(LibraryBuild, ShapesInBulkHaveTheirOwnValues) {
  caplet::Scene scene = three_balls();
  const std::uint32_t red = scene.add_material("red", caplet::Diffuse{caplet::Rgb{1, 0, 0}});
  caplet::Transform up = caplet::identity;
  up[11] = 5;
  const std::uint32_t first =
      scene.add_shapes("sphere", 2, {{"zmax", 9.0}}, {{"radius", std::vector<double>{1, 2}}},
                       std::vector{caplet::identity, up}, std::vector<std::uint32_t>{0, red});
  EXPECT_EQ(first, 1U);
  EXPECT_EQ(scene.primitives(),
            (std::map<std::string, std::uint64_t>{{"capsule", 3}, {"sphere", 2}}));
  scene.present();
  caplet::Picker picker(scene, test_device());
  const auto hit = picker.nearest(caplet::Ray{{0, 0, 20}, {0, 0, -1}, 0, 100});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->object_id, 2U);
  EXPECT_EQ(hit->material, "red");
  EXPECT_FLOAT_EQ(hit->t, 13);
}

TEST_F(LibraryBuild, PickersCarryPointsWithInstances) {
  caplet::Scene scene = three_balls();
  const auto add_box = [&](double low, double high) {
    scene.add_shape("box",
                    {{"p0", std::array{low, low, low}}, {"p1", std::array{high, high, high}}},
                    {.object = "crate"});
  };
  add_box(-1, 1);
  add_box(2, 3);
  caplet::Transform away = caplet::identity, farther = caplet::identity;
  away[3] = 20;
  farther[3] = 24;
  scene.add_instances("crate", std::vector{caplet::identity, away});
  scene.set_instance_motion(1, {0, 2}, std::vector{away, farther});
  scene.set_shutter(0, 2);
  scene.present();
  caplet::Picker picker(scene, test_device());
  const std::vector<caplet::Ray> rays = {{{22.5F, 2.5F, 9}, {0, 0, -1}, 0, 100},
                                         {{2.5F, 2.5F, 9}, {0, 0, -1}, 0, 100},
                                         {{0, 0, 90}, {0, 0, 1}, 0, 100}};
  std::vector<caplet::Crossing> hits(3);
  picker.nearest(rays, hits);
  using Points = std::vector<std::array<double, 3>>;
  Points points = {{22.5, 2.5, 3}, {2.5, 2.5, 3}, {7, 8, 9}};
  picker.carry(hits, 0, 1, points);
  EXPECT_EQ(points, (Points{{24.5, 2.5, 3}, {2.5, 2.5, 3}, {7, 8, 9}}));
  EXPECT_THROW(picker.carry(hits, 0, NAN, points), caplet::InputError);
  EXPECT_THROW(picker.carry(std::span(hits).first(2), 0, 1, points), caplet::InputError);
  for (const auto number :
       {&caplet::Crossing::shape, &caplet::Crossing::instance, &caplet::Crossing::primitive}) {
    std::vector<caplet::Crossing> wrong = hits;
    wrong[0].*number = 40;
    EXPECT_THROW(picker.carry(wrong, 0, 1, points), caplet::InputError);
  }
  hits[0].shape = 0;  // is of the world, not of the object
  EXPECT_THROW(picker.carry(hits, 0, 1, points), caplet::InputError);
}

TEST_F(LibraryBuild, OperandsOfCsgMove) {
  caplet::Scene scene;
  scene.add_shape("sphere", {{"radius", 2.0}}, {.object = "ball"});
  scene.add_shape("sphere", {{"radius", 1.0}}, {.object = "hole"});
  const std::uint32_t csg =
      scene.add_shape("csg", {{"operation", std::string("difference")},
                              {"operands", std::vector<std::string>{"ball", "hole"}}});
  caplet::Transform aside = caplet::identity, above = caplet::identity;
  aside[3] = 9;   // x
  above[11] = 2;  // z
  scene.set_operand_motion(csg, 1, {0, 1}, std::vector{above, aside});
  scene.present();
  const auto first_t = [&](double time) {
    caplet::Picker picker(scene, test_device());
    const auto hit = picker.nearest(caplet::Ray{{0, 0, 9}, {0, 0, -1}, 0, 100, time});
    return hit ? hit->t : 0;
  };
  EXPECT_FLOAT_EQ(first_t(0), 8);
  EXPECT_FLOAT_EQ(first_t(1), 7);
  scene.set_operand_motion(csg, 1, {}, {});
  EXPECT_FLOAT_EQ(first_t(1), 8);  // it rests where it was at first
  EXPECT_THROW(scene.set_operand_motion(csg, 2, {}, {}), caplet::InputError);
  EXPECT_THROW(scene.set_operand_motion(csg, 0, {0, 1}, std::vector{aside}), caplet::InputError);
  EXPECT_THROW(scene.set_operand_motion(csg, 0, {1, 0}, std::vector{aside, above}),
               caplet::InputError);
  EXPECT_THROW(scene.set_operand_motion(scene.shape_in("ball", 0), 0, {}, {}), caplet::InputError);
}

TEST_F(LibraryBuild, CrossingsInNumbersAreTheHits) {
  caplet::Scene scene = three_balls();
  scene.add_shape(
      "box", {{"p0", std::array<double, 3>{-1, -1, -1}}, {"p1", std::array<double, 3>{1, 1, 1}}},
      {.object = "crate"});
  caplet::Transform away = caplet::identity;
  away[3] = 20;
  scene.add_instances("crate", std::vector{caplet::identity, away});
  scene.present();
  caplet::Picker picker(scene, test_device());
  std::vector<caplet::Ray> rays;
  for (int i = 0; i < 300; ++i)
    rays.push_back({{static_cast<float>(i) * 0.1F - 2, 0.05F, 9}, {0, 0, -1}, 0, 100});
  std::vector<caplet::Crossing> numbers(rays.size());
  picker.nearest(rays, numbers);
  const auto hits = picker.nearest(rays);
  std::size_t found = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(numbers[i].ray, i);
    ASSERT_EQ(std::isfinite(numbers[i].t), hits[i].has_value());
    if (!hits[i]) {
      EXPECT_EQ(numbers[i].shape, caplet::Crossing::none);
      continue;
    }
    ++found;
    EXPECT_EQ(numbers[i].t, hits[i]->t);
    EXPECT_EQ(numbers[i].point, hits[i]->point);
    EXPECT_EQ(numbers[i].normal, hits[i]->normal);
    EXPECT_EQ(numbers[i].primitive, hits[i]->primitive);
    EXPECT_EQ(numbers[i].object_id, hits[i]->object_id);
    EXPECT_EQ(numbers[i].instance, hits[i]->instance.value_or(caplet::Crossing::none));
    EXPECT_EQ(numbers[i].shape, hits[i]->instance ? 1U : 0U);
    EXPECT_EQ(numbers[i].leaving == 0, hits[i]->entering);
  }
  EXPECT_GT(found, 50U);
  const auto lists = picker.all(rays);
  const std::vector<caplet::Crossing> every = picker.crossings(rays);
  std::size_t at = 0;
  for (std::size_t i = 0; i < rays.size(); ++i)
    for (const caplet::Hit& hit : lists[i]) {
      ASSERT_LT(at, every.size());
      EXPECT_EQ(every[at].ray, i);
      EXPECT_EQ(every[at++].t, hit.t);
    }
  EXPECT_EQ(at, every.size());
  EXPECT_THROW(picker.nearest(rays, std::span(numbers).first(3)), caplet::InputError);
}

TEST_F(LibraryBuild, CapsulesThatMoveAreTakenAndGivenInBulk) {
  caplet::Scene scene;
  const caplet::CapsuleArrays moving{{{0, 0, 0}, {5, 0, 0}, {0, 0, 1}, {5, 0, 0}},
                                     {{1, 0, 0}, {6, 0, 0}, {1, 0, 1}, {6, 0, 0}},
                                     {1, 2, 3, 2},
                                     {1, 2, 0, 2},
                                     {},
                                     {{0, 0.5f}, {0.5f, 1}},
                                     {0, 0.5}};
  scene.add_capsules(moving);
  EXPECT_EQ(scene.capsules(0), 2u);
  EXPECT_EQ(scene.capsule(0, 1).p0, (std::array<float, 3>{5, 0, 0}));
  EXPECT_THAT(said([&] {
                scene.set_capsule(0, 0, {{0, 0, 0}, {1, 0, 0}, 1, 1});
              }),
              HasSubstr("capsules that move cannot be edited"));
  EXPECT_THROW(scene.capsule(0, 2), caplet::InputError);
  const caplet::CapsuleArrays given = scene.capsule_arrays(0);
  EXPECT_EQ(given.p0, moving.p0);
  EXPECT_EQ(given.p1, moving.p1);
  EXPECT_EQ(given.radius0, moving.radius0);
  EXPECT_EQ(given.radius1, moving.radius1);
  EXPECT_EQ(given.u, moving.u);
  EXPECT_EQ(given.times, moving.times);
}

TEST_F(LibraryBuild, RaysMeetWhatMovesAtTheirTimes) {
  caplet::Scene scene;
  // A ball whose middle is at y = 4 t, from 0 to 1 second.
  scene.add_capsules({{{0, 0, 0}, {0, 4, 0}}, {{0, 0, 0}, {0, 4, 0}}, {1, 1}, {}, {}, {}, {0, 1}});
  scene.present();
  caplet::Picker picker(scene, test_device());
  caplet::Session session(scene, test_device());
  std::vector<caplet::Ray> rays;
  for (const double time : {0.0, 0.25, 1.0, -2.0, 3.0})
    rays.push_back({{0, -10, 0}, {0, 1, 0}, 0, 100, time});
  const std::vector<float> expected = {9, 10, 13, 9, 13};
  const auto hits = picker.nearest(rays);
  const auto lists = session.all(rays);
  const auto every = picker.crossings(rays);
  std::vector<caplet::Crossing> numbers(rays.size());
  session.nearest(rays, numbers);
  ASSERT_EQ(every.size(), 2 * rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_TRUE(hits[i].has_value());
    EXPECT_NEAR(hits[i]->t, expected[i], 1e-5F);
    EXPECT_EQ(numbers[i].t, hits[i]->t);
    ASSERT_EQ(lists[i].size(), 2U);
    EXPECT_EQ(lists[i][0].t, hits[i]->t);
    EXPECT_NEAR(lists[i][1].t, expected[i] + 2, 1e-5F);
    EXPECT_EQ(every[2 * i].t, hits[i]->t);
  }
}

TEST_F(LibraryBuild, CapsulesAreTakenAndGivenInBulk) {
  caplet::Scene scene = three_balls();
  scene.present();
  caplet::Session session(scene, test_device());
  caplet::CapsuleArrays balls = scene.capsule_arrays(0);
  EXPECT_EQ(balls.p0[2], (std::array<float, 3>{6, 0, 0}));
  for (auto& p : balls.p1) p[1] += 1;
  balls.radius0.pop_back();
  EXPECT_THROW(scene.set_capsules(0, balls), caplet::InputError);
  balls.p0.pop_back();
  balls.p1.pop_back();
  scene.set_capsules(0, balls);
  EXPECT_EQ(scene.capsules(0), 2U);
  session.update(scene);
  const auto hit = session.nearest(caplet::Ray{{0, 9, 0}, {0, -1, 0}, 0, 100});
  ASSERT_TRUE(hit);
  EXPECT_FLOAT_EQ(hit->t, 7);
  // With u at their ends: a quarter up the tube from y = 0 to 1. Scenes that come to have chains
  // get kernels that know of them.
  balls.u = {{0, 2}};
  EXPECT_THROW(scene.set_capsules(0, balls), caplet::InputError);
  balls.u.push_back({2, 3});
  scene.set_capsules(0, balls);
  EXPECT_EQ(scene.capsule_arrays(0).u, balls.u);
  session.update(scene);
  const auto side = session.nearest(caplet::Ray{{0, 0.25, 9}, {0, 0, -1}, 0, 100});
  ASSERT_TRUE(side);
  EXPECT_FLOAT_EQ(side->uv[0], 0.5F);
  caplet::Scene box;
  box.add_shape("box",
                {{"p0", std::array<double, 3>{0, 0, 0}}, {"p1", std::array<double, 3>{1, 1, 1}}});
  EXPECT_THROW(box.capsule_arrays(0), caplet::InputError);
}

// A picture is as bright for any time that the shutter is open, and shows what is there then.
TEST_F(LibraryBuild, AShutterKeepsTheBrightness) {
  caplet::Scene scene = three_balls();
  scene.present();
  scene.set_size(32, 24);
  scene.set_samples_per_pixel(4);
  const auto mean = [&] {
    double sum = 0;
    for (const float value : caplet::render(scene, test_device()).values("G"))
      sum += static_cast<double>(value);
    return sum;
  };
  const double before = mean();
  scene.set_shutter(2, 2.125);
  EXPECT_NEAR(mean() / before, 1, 1e-6);
  for (const auto& [open, close] : {std::pair(1.0, 1.0), std::pair(2.0, 1.0),
                                    std::pair(0.0, std::numeric_limits<double>::quiet_NaN())})
    EXPECT_THROW(scene.set_shutter(open, close), caplet::InputError);
}

TEST_F(LibraryBuild, MeshesAreTakenGivenAndMoved) {
  caplet::Scene scene;
  const caplet::MeshArrays sheet{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
                                 {{0, 1, 2}},
                                 {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
                                 {{0, 0}, {1, 0}, {0, 1}}};
  const std::uint32_t shape = scene.add_mesh(sheet);
  caplet::MeshArrays moving = scene.mesh_arrays(shape);
  EXPECT_EQ(moving.positions, sheet.positions);
  EXPECT_EQ(moving.triangles, sheet.triangles);
  EXPECT_EQ(moving.normals, sheet.normals);
  EXPECT_EQ(moving.uvs, sheet.uvs);
  // It rises by 2 in 4 seconds.
  moving.times = {-1, 3};
  EXPECT_THROW(scene.set_mesh(shape, moving), caplet::InputError);
  EXPECT_TRUE(scene.mesh_arrays(shape).times.empty());
  for (std::size_t i = 0; i < 3; ++i) {
    moving.positions.push_back(sheet.positions[i]);
    moving.positions.back()[2] = 2;
    moving.normals.push_back(sheet.normals[i]);
  }
  scene.set_mesh(shape, moving);
  EXPECT_EQ(scene.mesh_arrays(shape).times, moving.times);
  scene.present();
  caplet::Session session(scene, test_device());
  // Rays see it as the shutter opens, after a quarter of its way.
  const caplet::Ray ray{{1, 1, 9}, {0, 0, -1}, 0, 100};
  const auto hit = session.nearest(ray);
  ASSERT_TRUE(hit);
  EXPECT_FLOAT_EQ(hit->t, 8.5F);
  EXPECT_EQ(hit->uv, (std::array<float, 2>{0.25F, 0.25F}));
  scene.set_mesh(shape, sheet);
  session.update(scene);
  const auto still = session.nearest(ray);
  ASSERT_TRUE(still);
  EXPECT_FLOAT_EQ(still->t, 9);
  EXPECT_THROW(three_balls().mesh_arrays(0), caplet::InputError);
  EXPECT_THROW(three_balls().set_mesh(0, sheet), caplet::InputError);
}

// A shape that is checked again still has its textures and media.
TEST_F(LibraryBuild, ShapesWithTexturesAndMediaAreMoved) {
  caplet::Scene scene = three_balls();
  const caplet::TextureNumber squares = scene.add_texture({"checkerboard", true, {}});
  const std::uint32_t paint =
      scene.add_material("", caplet::NamedMaterial{"principled", {{"metallic", squares}}});
  const std::uint32_t fog = scene.add_medium("fog", "homogeneous", {});
  const std::uint32_t ball =
      scene.add_shape("sphere", {{"alpha", squares}}, {.materials = {paint}, .inside = fog});
  const std::uint32_t lamp =
      scene.add_shape("disk", {}, {.materials = {paint}, .emission = caplet::Parameters{}});
  caplet::Transform up = caplet::identity;
  up[11] = 3;
  EXPECT_NO_THROW(scene.set_transform(ball, up));
  EXPECT_EQ(scene.transform(ball), up);
  EXPECT_NO_THROW(scene.set_emission(lamp, 2.0, 1));
}

TEST_F(LibraryBuild, TheOpenCameraFollowsUntilOneIsGiven) {
  caplet::Scene scene = three_balls();
  scene.present();
  EXPECT_EQ(scene.lights(), 1U);  // the studio's
  const caplet::Transform before = scene.camera();
  scene.present();
  EXPECT_EQ(scene.camera(), before);
  caplet::ShapeOptions far;
  far.transform[3] = 100;
  scene.add_shape("sphere", {}, far);
  EXPECT_EQ(scene.camera(), before);
  scene.present();
  EXPECT_NE(scene.camera(), before);
  scene.look_at({0, 0, 9}, {0, 0, 0}, {0, 1, 0});
  const caplet::Transform given = scene.camera();
  scene.add_shape("sphere", {}, far);
  scene.present();
  EXPECT_EQ(scene.camera(), given);
  scene.add_light("point", {});
  EXPECT_EQ(scene.lights(), 1U);
  scene.present();
  EXPECT_EQ(scene.lights(), 1U);
  scene.remove_lights();
  scene.present();
  EXPECT_EQ(scene.lights(), 0U);
  // Moving what is there leaves the view as it is.
  caplet::Scene other = three_balls();
  other.present();
  const caplet::Transform view = other.camera();
  caplet::CapsuleArrays balls = other.capsule_arrays(0);
  balls.p0[0][1] = 7;
  other.set_capsules(0, balls);
  other.present();
  EXPECT_EQ(other.camera(), view);
}

}  // namespace
