// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Figures that pages ask for, against pictures rendered without a viewer.
#include "view/detail/figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "film/image.h"
#include "guests.h"
#include "live_pictures.h"
#include "render_scene.h"
#include "support/data.h"
#include "view/detail/shown_view.h"

namespace caplet::view {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::ThrowsMessage;

MakeFigure asked_of(const Scene& scene) {
  MakeFigure out;
  out.look = look_of_scene(scene);
  out.samples = 4;
  return out;
}

std::string figure_of(const Scene& scene, const MakeFigure& asked) {
  return figure_png(scene, scene.view, asked, test::test_device(), [](double) { return true; });
}

/// A picture from the bytes of a PNG file, linear.
TextureImage picture_of(const std::string& png) {
  const auto file = test::temporary_folder() / "figure.png";
  std::ofstream(file, std::ios::binary) << png;
  return FileImageReader().read_texture(file, {});
}

std::vector<std::uint8_t> bytes_of_preview(const LayeredImage& image) {
  const auto file = test::temporary_folder() / "preview.png";
  write_preview(file, image);
  return FileImageReader().read_texture(file, {}).bytes;
}

TEST(Figure, IsThePreviewOfARenderOfItsSize) {
  const Scene scene = test::some_scene();
  MakeFigure asked = asked_of(scene);
  asked.look.width = 50;
  asked.look.height = 20;
  const TextureImage figure = picture_of(figure_of(scene, asked));
  EXPECT_EQ(figure.width, 50);
  EXPECT_EQ(figure.height, 20);
  Scene same = scene;
  same.view.film.width = 50;
  same.view.film.height = 20;
  RenderOptions options;
  options.layers = Layers::none();
  EXPECT_EQ(figure.bytes, bytes_of_preview(test::render_model(same, 4, options).image));
}

TEST(Figure, HasItsOwnBackground) {
  const Scene scene = test::scene_of_text(
      "Film \"rgb\" \"integer xresolution\" 40 \"integer yresolution\" 30 LookAt 0 -6 0 0 0 0 0 0 "
      "1 "
      "Camera \"perspective\" WorldBegin LightSource \"infinite\" Shape \"sphere\"");
  MakeFigure asked = asked_of(scene);
  asked.background = "#ff8000";
  const TextureImage orange = picture_of(figure_of(scene, asked));
  EXPECT_THAT(std::vector(orange.bytes.begin(), orange.bytes.begin() + 3),
              testing::ElementsAre(255, 128, 0));
  asked.background = "transparent";
  const TextureImage clear = picture_of(figure_of(scene, asked));
  ASSERT_EQ(clear.channels, 4);
  EXPECT_EQ(clear.bytes[3], 0);
  EXPECT_EQ(clear.bytes[4 * (15 * 40 + 20) + 3], 255);
}

TEST(Figure, HasTheExposureThatIsAsked) {
  Scene scene = test::some_scene();
  MakeFigure asked = asked_of(scene);
  asked.look.width = 50;
  asked.look.height = 20;
  scene.view.film.exposure.stops = 1;
  const TextureImage of_scene = picture_of(figure_of(scene, asked));
  asked.exposure = "-2";
  const TextureImage darker = picture_of(figure_of(scene, asked));
  for (const double stops : {1.0, -2.0}) {
    Scene same = scene;
    same.view.film.width = 50;
    same.view.film.height = 20;
    same.view.film.exposure.stops = stops;
    RenderOptions options;
    options.layers = Layers::none();
    EXPECT_EQ((stops == 1 ? of_scene : darker).bytes,
              bytes_of_preview(test::render_model(same, 4, options).image));
  }
  EXPECT_NE(of_scene.bytes, darker.bytes);
  asked.exposure = "much";
  EXPECT_THAT([&] { figure_of(scene, asked); },
              ThrowsMessage<InputError>(HasSubstr("exposure: 'much'")));
}

TEST(Figure, DrawsWhatIsAsked) {
  Scene scene = test::some_scene();
  scene.unit = "mm";
  MakeFigure asked = asked_of(scene);
  asked.look.width = 400;
  asked.look.height = 300;
  std::vector<std::vector<std::uint8_t>> seen{picture_of(figure_of(scene, asked)).bytes};
  for (const std::pair<std::string, std::string>& drawn :
       {std::pair<std::string, std::string>("axes", ""),
        {"scale-bar", "5 mm"},
        {"outline", "3"},
        {"depth-cue", "0.5"}}) {
    asked.drawn = {drawn};
    seen.push_back(picture_of(figure_of(scene, asked)).bytes);
    for (std::size_t i = 0; i + 1 < seen.size(); ++i)
      EXPECT_NE(seen[i], seen.back()) << drawn.first << ' ' << i;
  }
  asked.drawn = {{"scale-bar", "2 mm"}};
  EXPECT_NE(picture_of(figure_of(scene, asked)).bytes, seen[2]);
}

// A branch of a hundredth of a pixel is drawn as wide as the film says, 3 pixels.
TEST(Figure, ThinBranchesHaveTheLeastWidth) {
  Scene scene = test::scene_of_text(
      "Film \"rgb\" \"integer xresolution\" 60 \"integer yresolution\" 60 \"float leastwidth\" 3 "
      "LookAt 0 -10 0 0 0 0 0 0 1 Camera \"perspective\" \"float fov\" 60 PixelFilter \"box\" "
      "WorldBegin LightSource \"infinite\" Shape \"capsule\" \"point3 p0\" [0 0 -9] \"point3 p1\" "
      "[0 0 9] \"float radius\" 0.001");
  MakeFigure asked = asked_of(scene);
  asked.samples = 64;
  asked.background = "transparent";
  const TextureImage figure = picture_of(figure_of(scene, asked));
  double covered = 0;
  for (std::size_t x = 0; x < 60; ++x) covered += figure.bytes[4 * (30 * 60 + x) + 3] / 255.0;
  EXPECT_NEAR(covered, 3, 0.1);  // 8 bits, and edges by 64 samples
}

TEST(Figure, IsDenoisedWhereThatIsAsked) {
  ::setenv("CAPLET_OIDN", CAPLET_FAKE_OIDN, 1);
  const Scene scene = test::some_scene();
  MakeFigure asked = asked_of(scene);
  asked.denoise = true;
  const std::vector<std::uint8_t> clean = picture_of(figure_of(scene, asked)).bytes;
  ::unsetenv("CAPLET_OIDN");
  Scene same = scene;
  RenderOptions options;
  options.layers = Layers::none().with(Layer::albedo).with(Layer::normal);
  LayeredImage image = test::render_model(same, 4, options).image;
  const auto at = [&](const char* name) { return image.find(name)->floats; };
  for (const auto& [color, albedo, normal] :
       {std::tuple("R", "albedo.R", "N.X"), {"G", "albedo.G", "N.Y"}, {"B", "albedo.B", "N.Z"}}) {
    std::vector<float> out = at(color);
    // What the library in place of Open Image Denoise makes (tests/support/oidn).
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = out[i] / 2 + 2 * at(albedo)[i] / 4 + 3 * at(normal)[i] / 8;
    for (Channel& channel : image.channels)
      if (channel.name == color) channel.floats = out;
  }
  EXPECT_EQ(clean, bytes_of_preview(image));
}

TEST(Figure, WhatCannotBeIsRefused) {
  const Scene scene = test::some_scene();
  const auto refused = [&](const auto& change, const std::string& why) {
    MakeFigure asked = asked_of(scene);
    change(asked);
    EXPECT_THAT([&] { figure_of(scene, asked); }, ThrowsMessage<InputError>(HasSubstr(why)));
  };
  refused([](MakeFigure& f) { f.background = "/etc/passwd"; }, "background: '/etc/passwd'");
  refused([](MakeFigure& f) { f.drawn = {{"frame", ""}}; }, "frame");
  refused([](MakeFigure& f) { f.drawn = {{"outline", "thick"}}; }, "outline: 'thick' is no number");
  refused([](MakeFigure& f) { f.drawn = {{"color-bar", ""}}; }, "color-bar");
  refused([](MakeFigure& f) { f.look.world_from_camera = glm::dmat4(0); }, "singular");
}

TEST(Figure, EndsWhenNobodyWaits) {
  const Scene scene = test::some_scene();
  MakeFigure asked = asked_of(scene);
  asked.samples = most_figure_samples;
  int told = 0;
  const std::string nothing =
      figure_png(scene, scene.view, asked, test::test_device(), [&](double) { return ++told < 2; });
  EXPECT_EQ(nothing, "");
  EXPECT_EQ(told, 2);
}

json message_of(const Scene& scene, int number, int samples) {
  json rows = json::array();
  for (int i = 0; i < 16; ++i) rows.push_back(scene.view.camera.world_from_camera[i % 4][i / 4]);
  return {{"type", "figure"},      {"number", number},        {"width", 48},
          {"height", 32},          {"samples", samples},      {"denoise", false},
          {"background", nullptr}, {"drawn", {{"axes", ""}}}, {"fov", 0.7},
          {"lens_radius", 0},      {"focal_distance", 10},    {"world_from_camera", rows}};
}

TEST(Figure, GoesToThePageThatAskedAndLeavesThePictureAsItIs) {
  const Scene scene = test::some_scene();
  const Viewer viewer(LiveScene(Scene(scene)), test::test_device(), test::options_of(4));
  test::Guest guest(test::Place(viewer.address()));
  guest.look(scene);
  const test::Shown before = guest.until_samples(4);
  guest.say(message_of(scene, 7, 4));
  const json told = json::parse(guest.until("figuring"));
  EXPECT_EQ(told["number"], 7);
  EXPECT_EQ(told["share"], 0);
  const std::string png = guest.until("");
  MakeFigure asked = asked_of(scene);
  asked.look.width = 48;
  asked.look.height = 32;
  asked.look.fov = 0.7;
  asked.look.focal_distance = 10;
  asked.drawn = {{"axes", ""}};
  EXPECT_EQ(png, figure_of(scene, asked));
  guest.say({{"type", "snapshot"}});
  EXPECT_EQ(guest.until("").substr(0, 4), "\x76\x2f\x31\x01");  // of an EXR file
  guest.look(scene, 0.5);
  EXPECT_GT(guest.until_samples(4, before.view).view, before.view);
}

TEST(Figure, IsEndedByItsPageAndTroubleIsTold) {
  const Scene scene = test::some_scene();
  const Viewer viewer(LiveScene(Scene(scene)), test::test_device(), test::options_of(1));
  test::Guest guest(test::Place(viewer.address()));
  guest.look(scene);
  guest.until_samples(1);
  json message = message_of(scene, 8, most_figure_samples);
  message["width"] = message["height"] = 1024;  // minutes
  guest.say(message);
  guest.until("figuring");
  guest.say({{"type", "end_figure"}});
  message = message_of(scene, 9, 1);
  message["drawn"] = {{"outline", "0"}};
  guest.say(message);
  const json error = json::parse(guest.until("error"));
  EXPECT_EQ(error["number"], 9);
  EXPECT_THAT(error["text"].get<std::string>(), HasSubstr("outline: '0' is no number from 0.1"));
}

}  // namespace
}  // namespace caplet::view
