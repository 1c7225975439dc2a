// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What a viewer's pages are told: names in any bytes, looks that are refused, pairs of eyes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "export/export.h"
#include "film/image.h"
#include "guests.h"
#include "import/import.h"
#include "live_pictures.h"
#include "support/broken_utf8.h"
#include "support/data.h"

namespace caplet::view {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::Guest;
using test::options_of;
using test::Place;
using testing::HasSubstr;

/// A pbrt file in which all that has a name has this one.
std::string text_named(const std::string& name) {
  return fmt::format(R"(
LookAt 0 -9 2  0 0 0  0 0 1
Camera "perspective" "float fov" [ 40 ]
Film "rgb" "integer xresolution" [ 32 ] "integer yresolution" [ 24 ]
MakeNamedMedium "{0}" "string type" "homogeneous"
WorldBegin
LightSource "infinite" "rgb L" [ 0.2 0.25 0.3 ]
Texture "{0}" "spectrum" "checkerboard" "rgb tex1" [ 0.5 0.4 0.3 ] "rgb tex2" [ 0.4 0.4 0.4 ]
MakeNamedMaterial "{0}" "string type" "diffuse" "texture reflectance" "{0}"
NamedMaterial "{0}"
Shape "sphere" "float radius" [ 1 ] "string name" "{0}"
AttributeBegin
  MediumInterface "{0}" ""
  Translate 3 0 0
  Shape "sphere" "float radius" [ 0.6 ] "string name" "{0}"
AttributeEnd
ObjectBegin "{0}"
  Shape "capsule" "point3 p0" [ 0 0 0 ] "point3 p1" [ 0 0 1 ] "float radius" [ 0.2 ] "string name" "{0}"
ObjectEnd
Translate -3 0 0
ObjectInstance "{0}"
)",
                     name);
}

/// A guest's JSON is parsed strictly: one broken byte in anything that is told ends the test, as a
/// server that throws does.
void expect_names(const Scene& scene, std::unique_ptr<Keeper> keeper, const std::string& valid,
                  const std::string& what) {
  const bool keeps = keeper != nullptr;
  const Viewer viewer(LiveScene(Scene(scene)), test::test_device(), options_of(1),
                      std::move(keeper));
  Guest guest(Place(viewer.address()));
  const json hello = json::parse(guest.until("scene"));
  for (const json& thing : hello.at("things")) EXPECT_EQ(thing.at("name"), valid) << what;
  EXPECT_EQ(hello.at("materials").at(0), valid) << what;
  EXPECT_EQ(hello.at("parts").at("materials").at(0).at("name"), valid) << what;
  EXPECT_EQ(hello.at("parts").at("textures").at(0).at("name"), valid) << what;
  EXPECT_EQ(hello.at("name"), valid + ".pbrt") << what;
  guest.look(scene);
  guest.until_samples(1);
  guest.say(
      {{"type", "ask"}, {"number", 1}, {"x", 48}, {"y", 32}, {"all", true}, {"reference", true}});
  const json pick = json::parse(guest.until("answer")).at("pick");
  ASSERT_GE(pick.at("crossings").size(), 1u) << what;
  for (const char* list : {"crossings", "reference"})
    for (const json& one : pick.at(list)) {
      EXPECT_EQ(one.at("object"), valid) << what;
      EXPECT_EQ(one.at("material"), valid) << what;
    }
  guest.say({{"type", "describe"}, {"number", 2}, {"id", 0}, {"primitive", 0}});
  EXPECT_TRUE(json::parse(guest.until("answer")).at("thing").is_object()) << what;
  for (const char* kind : {"material", "texture", "light", "shape", "film"}) {
    guest.say({{"type", "form"}, {"number", 3}, {"of", kind}, {"part", 0}});
    EXPECT_TRUE(json::parse(guest.until("answer")).at("form").is_object()) << what << ", " << kind;
  }
  guest.say({{"type", "edit"},
             {"what", "hide"},
             {"goes_on", false},
             {"ids", {0}},
             {"others", false},
             {"number", 4}});
  EXPECT_EQ(json::parse(guest.until("edited")).at("parts").at("hidden").at(0), valid) << what;
  guest.until("made");
  if (!keeps) return;
  guest.say({{"type", "save"}, {"name", nullptr}, {"camera", false}, {"replace", false}});
  EXPECT_THAT(json::parse(guest.until("save_asks")).at("why").get<std::string>(), HasSubstr(valid))
      << what;
  // The name that the page shows is that of the scene's own file.
  guest.say({{"type", "save"}, {"name", valid + ".pbrt"}, {"camera", false}, {"replace", true}});
  EXPECT_EQ(json::parse(guest.until("saved")).at("name"), valid + ".pbrt") << what;
}

TEST(Pages, HaveNamesInEveryBrokenEncoding) {
  for (const test::Broken& broken : test::broken_utf8) {
    const fs::path folder = test::temporary_folder(),
                   file = folder / (std::string(broken.bytes) + ".pbrt");
    std::ofstream(file, std::ios::binary) << text_named(broken.bytes);
    auto keeper = std::make_unique<Keeper>(file);
    const Scene scene = import_scene(keeper->base(), FileImageReader());
    keeper->has_read({file.string()});
    expect_names(scene, std::move(keeper), broken.valid, broken.what);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1)
        << broken.what;
    EXPECT_EQ(import_scene(file, FileImageReader()).shapes.at(0).name, broken.valid) << broken.what;
  }
}

/// A program that uses the rooms may have made them itself.
TEST(Pages, HaveNamesThatNoImporterHasSeen) {
  Scene scene = test::scene_of_text(text_named("x"));
  for (const char* name : {"K\xfcgel", "a\xed\xa0\x80"}) {
    for (Shape& shape : scene.shapes) shape.name = name;
    scene.objects[0].name = scene.objects[0].shapes[0].name = scene.materials[0].name =
        scene.textures[0].name = name;
    scene.media[0].name = name;
    scene.source = std::string("/somewhere/") + name + ".pbrt";
    expect_names(scene, nullptr,
                 name[0] == 'K' ? "K\xef\xbf\xbdgel" : "a\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd",
                 name);
  }
}

/// JSON has escapes for all of them; pages show names as text.
TEST(Pages, HaveZerosAndControlCharactersInNames) {
  Scene scene = test::scene_of_text(text_named("x"));
  std::string name = "<b>&\"'";
  for (char c = 0; c < 32; ++c) name += c;
  name += "\x7f\xc2\x9b";
  for (Shape& shape : scene.shapes) shape.name = name;
  scene.objects[0].name = scene.objects[0].shapes[0].name = scene.materials[0].name =
      scene.textures[0].name = name;
  scene.source = "/somewhere/" + name + ".pbrt";
  expect_names(scene, nullptr, name, "control characters");
}

TEST(Pages, AreToldWhatIsWrongWithTextThatIsNoUtf8) {
  const Viewer viewer(LiveScene(test::some_scene()), test::test_device(), options_of(1));
  Guest guest(Place(viewer.address()));
  // A websocket refuses it itself: the page is put out, and the next one has all as before.
  boost::beast::error_code error;
  guest.stream().write(boost::asio::buffer(std::string("{\"type\":\"K\xfcgel\"}")), error);
  EXPECT_ANY_THROW(for (;;) guest.until("none"));
  Guest next(Place(viewer.address()));
  EXPECT_EQ(json::parse(next.until("scene")).at("type"), "scene");
  next.say({{"type", "edit"}, {"what", "\xed\x9f\xbf\x07"}, {"goes_on", false}});
  EXPECT_THAT(next.until("error"), HasSubstr("what"));
}

TEST(Pages, NeverSeeALookThatWasRefused) {
  const Scene scene = test::some_scene();
  const Viewer viewer(LiveScene(Scene(scene)), test::test_device(), options_of(1));
  Guest guest(Place(viewer.address())), other(Place(viewer.address()));
  guest.look(scene, 0.25);
  const json looked = json::parse(other.until("looked"));
  const std::uint32_t view = guest.until_samples(1).view;
  json bad{{"type", "look"}, {"width", 64},      {"height", 48},
           {"fov", 0.7},     {"lens_radius", 0}, {"focal_distance", 1}};
  bad["world_from_camera"] = std::vector<double>(16, 0.0);
  guest.say(bad);
  EXPECT_THAT(guest.until("error"), HasSubstr("singular"));
  bad["world_from_camera"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};  // all at one depth
  guest.say(bad);
  EXPECT_THAT(guest.until("error"), HasSubstr("singular"));
  Guest late(Place(viewer.address()));
  EXPECT_EQ(json::parse(late.until("scene")).at("camera").at("world_from_camera"),
            looked.at("world_from_camera"));
  // The first that the other page hears of again is a look that was taken.
  guest.look(scene, 0.5);
  EXPECT_EQ(json::parse(other.until("looked")).at("world_from_camera")[3],
            scene.view.camera.world_from_camera[3].x + 0.5);
  EXPECT_GT(guest.until_samples(1, view).view, view);
}

// A click finds what is drawn, lists of crossings the scene as it is.
TEST(Pages, PickLinesOfTheLeastWidth) {
  const Scene scene = test::thin_scene();
  const Viewer viewer(LiveScene(Scene(scene)), test::test_device(), options_of(1));
  Guest guest(Place(viewer.address()));
  guest.look(scene);
  guest.until_samples(1);
  const auto crossings = [&](bool all, bool reference) {
    guest.say({{"type", "ask"},
               {"number", 1},
               {"x", 48},
               {"y", 31},
               {"all", all},
               {"reference", reference}});
    return json::parse(guest.until("answer")).at("pick").at("crossings");
  };
  const json near = crossings(false, false), list = crossings(true, true);
  ASSERT_EQ(near.size(), 1u);
  EXPECT_EQ(near[0].at("object_id"), 1);
  ASSERT_EQ(list.size(), 2u);
  for (const json& one : list) EXPECT_EQ(one.at("object_id"), 0);
  EXPECT_EQ(crossings(false, true).at(0).at("object_id"), 0) << "as the reference has it";
}

TEST(Pages, PickWithTheEyeThatTheyAskFor) {
  const Scene scene = test::some_scene();
  const Viewer viewer(LiveScene(Scene(scene)), test::test_device(), options_of(1));
  Guest guest(Place(viewer.address()));
  constexpr double separation = 0.8;
  guest.look(scene, 0, separation);
  guest.until_samples(1);
  const glm::dmat4& at = scene.view.camera.world_from_camera;
  const glm::dvec3 right = glm::normalize(glm::dvec3(at[0]));
  for (const int eye : {0, 1, -1}) {  // the last says nothing of it
    json ask{{"type", "ask"}, {"number", eye + 2}, {"x", 40},
             {"y", 30},       {"all", false},      {"reference", false}};
    if (eye >= 0) ask["eye"] = eye;
    guest.say(ask);
    const json ray = json::parse(guest.until("answer")).at("pick").at("ray");
    const glm::dvec3 from = glm::dvec3(at[3]) + (eye == 1 ? 0.5 : -0.5) * separation * right;
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(ray.at("origin").at(static_cast<std::size_t>(k)).get<double>(), from[k], 1e-6)
          << eye;
  }
}

}  // namespace
}  // namespace caplet::view
