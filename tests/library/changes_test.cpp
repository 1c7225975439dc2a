// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Changes of scenes through the public headers, by what pictures and hits must be of them in closed
// form or of the same scene made anew.
#include <caplet/import.h>
#include <caplet/pick.h>
#include <caplet/render.h>
#include <caplet/session.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "library_device.h"

namespace {

namespace fs = std::filesystem;

class LibraryChanges : public testing::Test {
 protected:
  LibraryChanges()
      : folder_(fs::temp_directory_path() / ("caplet-changes-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~LibraryChanges() override { fs::remove_all(folder_); }

  /// A white square in the plane z = 0 from -1 to 1 that fills the picture, and a lamp beside it,
  /// out of the picture.
  static caplet::Scene square() {
    caplet::Scene scene;
    scene.add_material("white", caplet::Diffuse{caplet::Rgb{1, 1, 1}});
    scene.add_material("black", caplet::Diffuse{caplet::Rgb{0, 0, 0}});
    caplet::MeshArrays mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    scene.add_mesh(mesh, {.name = "square", .materials = {0}});
    scene.add_light("distant", {{"from", std::array<double, 3>{0, 0, 1}},
                                {"to", std::array<double, 3>{0, 0, 0}},
                                {"L", caplet::Rgb{1, 1, 1}}});
    scene.look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0});
    scene.set_fov(10);
    scene.set_size(8, 8);
    scene.set_samples_per_pixel(4);
    scene.set_max_depth(1);
    return scene;
  }
  static double green(const caplet::Film& film) {
    double sum = 0;
    for (const float value : film.values("G")) sum += double{value};
    return sum / 64;
  }
  static double green(const caplet::Scene& scene) {
    return green(caplet::render(scene, test_device()));
  }
  static bool same(const caplet::Film& a, const caplet::Film& b) {
    return std::ranges::all_of(a.channels(), [&](const std::string& channel) {
      return channel.ends_with(".id") ? a.ids(channel) == b.ids(channel)
                                      : a.values(channel) == b.values(channel);
    });
  }

  fs::path folder_;
};

// --- Many rays ---

// Rays along -z from z = 5, spread over the disk of radius 1.2 around a ball of radius 1 by the
// golden angle: where they hit is known of each by its number. More than a call of the device
// takes.
TEST_F(LibraryChanges, HitsOfManyRaysAreThoseOfTheirNumbers) {
  constexpr std::size_t count = 300'000;
  caplet::Scene scene;
  scene.add_shape("sphere", {{"radius", 1.0}}, {.name = "ball"});
  std::vector<caplet::Ray> rays(count);
  std::vector<double> across(count);  // squared
  for (std::size_t i = 0; i < count; ++i) {
    const double r = 1.2 * std::sqrt((static_cast<double>(i) + 0.5) / count),
                 phi = 2.399963229728653 * static_cast<double>(i);
    rays[i] = {{static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)), 5},
               {0, 0, -1}};
    across[i] = std::pow(double{rays[i].origin[0]}, 2) + std::pow(double{rays[i].origin[1]}, 2);
  }
  caplet::Picker picker(scene, test_device());
  std::vector<caplet::Crossing> nearest(count);
  picker.nearest(rays, nearest);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    ASSERT_EQ(nearest[i].ray, i);
    if (std::abs(across[i] - 1) < 1e-5) continue;
    ASSERT_EQ(nearest[i].shape != caplet::Crossing::none, across[i] < 1) << i;
    if (across[i] < 1) {
      ASSERT_NEAR(nearest[i].t, 5 - std::sqrt(1 - across[i]), 1e-3) << i;
      ++hits;
    }
  }
  EXPECT_NEAR(static_cast<double>(hits), count / 1.44, 100);
  // All crossings: of each ray the first and then the second.
  std::size_t at = 0, all = 0;
  const std::vector<caplet::Crossing> crossings = picker.crossings(rays, 2);
  for (std::size_t i = 0; i < count; ++i)
    for (const double side : {-1.0, 1.0}) {
      if (!(at < crossings.size() && crossings[at].ray == i)) {
        ASSERT_GT(across[i], 1 - 1e-5) << i;
        continue;
      }
      if (across[i] < 1 - 1e-5) {
        ASSERT_NEAR(crossings[at].t, 5 + side * std::sqrt(1 - across[i]), 1e-3) << i;
      }
      ++at;
      ++all;
    }
  EXPECT_EQ(at, crossings.size());
  EXPECT_NEAR(static_cast<double>(all), 2 * count / 1.44, 200);
}

// --- Sessions ---

// A plane whose normal map says (0.6, 0, 0.8) reflects 0.8 of the light that comes straight on; of
// (0, 0.28, 0.96) 0.96.
TEST_F(LibraryChanges, ANewNormalMapIsSent) {
  caplet::Scene scene = square();
  const auto map = [&](float x, float y, float z) {
    caplet::Pixels pixels;
    pixels.width = pixels.height = 1;
    pixels.channels = 3;
    pixels.values = {(x + 1) / 2, (y + 1) / 2, (z + 1) / 2};
    return scene.add_texture(
        {"normalmap", false, {{"pixels", std::make_shared<const caplet::Pixels>(pixels)}}});
  };
  const caplet::TextureNumber first = map(0.6F, 0, 0.8F), second = map(0, 0.28F, 0.96F);
  const caplet::TextureNumber rising =
      scene.add_texture({"bilerp",
                         true,
                         {{"v00", 0.0},
                          {"v01", 0.0},
                          {"v10", 1.5},
                          {"v11", 1.5}}});  // 3 in 4: the normal has 0.8 of z
  const double flat = green(scene);
  caplet::Session session(scene, test_device());
  const auto seen = [&](const caplet::Parameters& more) {
    caplet::Parameters all = more;
    all["reflectance"] = caplet::Rgb{1, 1, 1};
    scene.set_material(0, caplet::NamedMaterial{"diffuse", all});
    session.update(scene);
    session.render(4);
    return green(session.film()) / flat;
  };
  EXPECT_NEAR(seen({{"normalmap", first}}), 0.8, 1e-4);
  EXPECT_NEAR(seen({{"normalmap", second}}), 0.96, 1e-4);
  EXPECT_NEAR(seen({{"normalmap", second}}), 0.96, 1e-4);
  EXPECT_NEAR(seen({}), 1, 1e-4);
  EXPECT_NEAR(seen({{"displacement", rising}}), 0.8, 2e-3);
  EXPECT_NEAR(seen({{"normalmap", first}}), 0.8, 1e-4);
  EXPECT_NEAR(seen({}), 1, 1e-4);
  // What says nothing of bumps leaves them.
  seen({{"normalmap", first}});
  scene.set_material(0, caplet::Diffuse{caplet::Rgb{0.5, 0.5, 0.5}});
  session.update(scene);
  session.render(4);
  EXPECT_NEAR(green(session.film()) / flat, 0.5 * 0.8, 1e-4);
}

// A session that has been shown another scene shows the first again with all its changes, and goes
// on with either's.
TEST_F(LibraryChanges, ASessionGoesBetweenScenes) {
  const caplet::Device device = test_device();
  caplet::Scene a = square(), b = square();
  b.set_transform(b.shape("square"), {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0});
  b.set_light(0, caplet::Rgb{0.2, 0.2, 0.2}, 1);
  caplet::Session session(a, device);
  const auto follows = [&](const caplet::Scene& scene, const char* what) {
    session.update(scene);
    session.render(4);
    EXPECT_TRUE(same(session.film(), caplet::render(scene, device))) << what;
  };
  follows(b, "another");
  a.set_material(0, caplet::Diffuse{caplet::Rgb{0.5, 0.5, 0.5}});
  follows(a, "the first, changed meanwhile");
  b.set_light(0, caplet::Rgb{0.7, 0.7, 0.7}, 2);
  follows(b, "the other again");
  b.set_transform(b.shape("square"), {1, 0, 0, -0.5, 0, 1, 0, 0.25, 0, 0, 1, 0});
  follows(b, "and its next change");
  const caplet::Scene copy = b;
  b.set_light(0, caplet::Rgb{0.1, 0.1, 0.1}, 2);
  follows(b, "a change");
  follows(copy, "from before it");
  b.add_shape("sphere", {{"radius", 0.1}});
  follows(b, "one more shape");
  follows(a, "the first");
}

// --- Ranges ---

// Whole numbers may be the least and the greatest of their range, and no others beyond.
TEST_F(LibraryChanges, RangesHaveTheirEnds) {
  caplet::Scene scene = square();
  const auto texture = [&](const char* type, const char* name, double value) {
    scene.add_texture({type, true, {{name, value}}});
  };
  for (const double dimension : {2.0, 3.0})
    EXPECT_NO_THROW(texture("checkerboard", "dimension", dimension)) << dimension;
  for (const double wrong : {1.0, 4.0, 2.5})
    EXPECT_THROW(texture("checkerboard", "dimension", wrong), caplet::InputError) << wrong;
  for (const double octaves : {0.0, 64.0})
    EXPECT_NO_THROW(texture("fbm", "octaves", octaves)) << octaves;
  for (const double wrong : {-1.0, 65.0})
    EXPECT_THROW(texture("fbm", "octaves", wrong), caplet::InputError) << wrong;
  const auto material = [&](const char* name, double value) {
    scene.set_material(0, caplet::NamedMaterial{"coateddiffuse", {{name, value}}});
  };
  EXPECT_NO_THROW(material("maxdepth", 0.0));
  EXPECT_NO_THROW(material("nsamples", 1.0));
  EXPECT_THROW(material("nsamples", 0.0), caplet::InputError);
}

// --- Lights ---

TEST_F(LibraryChanges, ScalesOfLightsAreWhatIsSaid) {
  caplet::Scene scene = square();
  const double once = green(scene);
  for (const auto& [value, scale] :
       {std::pair{1.0, 3.0}, {1.0, 3.0}, {2.0, 0.5}, {2.0, 0.0}, {0.5, 4.0}}) {
    scene.set_light(0, caplet::Rgb{value, value, value}, scale);
    EXPECT_EQ(scene.light_scale(0), scale);
    EXPECT_NEAR(green(scene), value * scale * once, 1e-5 * once);
  }
  // A square that shines is as bright as it says, and no brighter for saying it twice.
  caplet::Scene shining;
  caplet::MeshArrays mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  shining.add_material("black", caplet::Diffuse{caplet::Rgb{0, 0, 0}});
  const std::uint32_t lamp = shining.add_mesh(
      mesh, {.materials = {0},
             .emission = caplet::Parameters{{"L", caplet::Rgb{1, 1, 1}}, {"scale", 7.0}}});
  shining.look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0});
  shining.set_fov(10);
  shining.set_size(8, 8);
  shining.set_samples_per_pixel(4);
  const double seven = green(shining);
  EXPECT_GT(seven, 1);
  for (const auto& [value, scale] : {std::pair{2.0, 3.0}, {2.0, 3.0}, {1.0, 0.5}}) {
    shining.set_emission(lamp, caplet::Rgb{value, value, value}, scale);
    EXPECT_NEAR(green(shining), value * scale / 7 * seven, 1e-5 * seven);
  }
}

// --- Cameras ---

// A camera that was set stays when the picture's size, its shapes or its film change; one that was
// not is framed anew.
TEST_F(LibraryChanges, ACameraThatWasSetStays) {
  std::ofstream(folder_ / "cell.swc") << "1 2 0 0 0 0.5 -1\n2 2 4 1 0 0.5 1\n";
  const auto sees_anew = [](caplet::Scene scene) {
    const caplet::Transform before = scene.camera();
    scene.set_size(40, 200);
    if (scene.camera() != before) return true;
    scene.set_option(caplet::Statement::film, "rgb",
                     {{"xresolution", 300.0}, {"yresolution", 30.0}});
    return scene.camera() != before;
  };
  caplet::Scene automatic = caplet::import_scene(folder_ / "cell.swc");
  EXPECT_TRUE(sees_anew(automatic));
  caplet::Scene looked = automatic, zoomed = automatic, placed = automatic;
  looked.look_at({3, 4, 50}, {0, 0, 0}, {0, 1, 0});
  EXPECT_FALSE(sees_anew(looked));
  zoomed.set_fov(20);
  EXPECT_FALSE(sees_anew(zoomed));
  EXPECT_NEAR(zoomed.fov(), 20, 1e-12);
  EXPECT_EQ(zoomed.camera(), automatic.camera());
  placed.set_camera("perspective", {{"fov", 30.0}}, caplet::identity);
  EXPECT_FALSE(sees_anew(placed));
  // A scene that is built keeps its camera when shapes are added, too.
  caplet::Scene built;
  built.add_shape("sphere", {{"radius", 1.0}});
  built.look_at({3, 4, 50}, {0, 0, 0}, {0, 1, 0});
  const caplet::Transform camera = built.camera();
  built.add_shape("sphere", {{"radius", 9.0}});
  built.present();
  EXPECT_EQ(built.camera(), camera);
  EXPECT_FALSE(sees_anew(built));
}

// --- Shapes ---

// Capsules that are put in the place of others stand where those stood and are of their materials,
// within objects too.
TEST_F(LibraryChanges, NewCapsulesStandInThePlaceOfTheOld) {
  caplet::Scene scene;
  scene.add_material("a", caplet::Diffuse{});
  const std::uint32_t other = scene.add_material("b", caplet::Diffuse{});
  caplet::CapsuleArrays one;
  one.p0 = {{0, 0, 0}};
  one.p1 = {{1, 0, 0}};
  one.radius0 = {0.25F};
  const caplet::Transform moved{0, -1, 0, 5, 1, 0,
                                0, 6,  0, 0, 1, 7};  // a quarter of a turn about z
  scene.add_capsules(one, {.name = "first"});
  scene.add_capsules(one, {.name = "second", .transform = moved, .materials = {other}});
  scene.add_capsules(one, {.name = "within", .object = "thing"});
  scene.add_capsules(one, {.name = "also", .transform = moved, .object = "thing"});
  scene.add_capsules(one, {.name = "beyond", .object = "other thing"});
  scene.add_instances("thing",
                      std::vector<caplet::Transform>{{1, 0, 0, 20, 0, 1, 0, 0, 0, 0, 1, 0}});
  caplet::CapsuleArrays two;
  two.p0 = {{0, 0, 0}, {10, 0, 0}};
  two.p1 = {{2, 0, 0}, {12, 0, 0}};
  two.radius0 = {0.5F, 0.25F};
  for (const char* name : {"second", "also"}) {
    const std::uint32_t shape = scene.shape(name);
    scene.set_capsules(shape, two);
    EXPECT_EQ(scene.transform(shape), moved) << name;
    EXPECT_EQ(scene.capsules(shape), 2U) << name;
    EXPECT_EQ(scene.shape(name), shape);
  }
  EXPECT_EQ(scene.capsules(scene.shape("first")), 1U);
  EXPECT_EQ(scene.capsules(scene.shape("within")), 1U);
  EXPECT_EQ(scene.place(scene.shape("first")), (std::pair<std::string, std::size_t>("", 0)));
  EXPECT_EQ(scene.place(scene.shape("second")), (std::pair<std::string, std::size_t>("", 1)));
  EXPECT_EQ(scene.place(scene.shape("within")), (std::pair<std::string, std::size_t>("thing", 0)));
  EXPECT_EQ(scene.place(scene.shape("also")), (std::pair<std::string, std::size_t>("thing", 1)));
  EXPECT_EQ(scene.place(scene.shape("beyond")),
            (std::pair<std::string, std::size_t>("other thing", 0)));
  EXPECT_EQ(scene.shape_in("other thing", 0), scene.shape("beyond"));
  EXPECT_EQ(scene.shape_in("", 1), scene.shape("second"));
  EXPECT_EQ(scene.shape_in("thing", 1), scene.shape("also"));
  // By rays along -z at the middles of what is to be there: (1, 0, 0) of theirs is (5, 7, 7), (11,
  // 0, 0) is (5, 17, 7).
  caplet::Picker picker(scene, test_device());
  const auto hit = [&](float x, float y) {
    return picker.nearest(caplet::Ray{{x, y, 50}, {0, 0, -1}});
  };
  for (const float right : {0.0F, 20.0F}) {
    const auto thick = hit(5 + right, 7), thin = hit(5 + right, 17);
    ASSERT_TRUE(thick && thin);
    EXPECT_NEAR(thick->t, 50 - 7.5, 1e-4);
    EXPECT_NEAR(thin->t, 50 - 7.25, 1e-4);
    EXPECT_EQ(thin->primitive, 1U);
    EXPECT_EQ(thick->object, right > 0 ? "also" : "second");
    EXPECT_EQ(thick->material, right > 0 ? "a" : "b");
    EXPECT_EQ(thick->instance.has_value(), right > 0);
  }
  EXPECT_FALSE(hit(5, 12));
  ASSERT_TRUE(hit(0.5F, 0));
  EXPECT_EQ(hit(0.5F, 0)->object, "first");
  EXPECT_EQ(hit(20.5F, 0)->object, "within");
}

}  // namespace
