// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Views that the page asks for: parallel rays, and two eyes, against cameras by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "export/export.h"
#include "lower/camera.h"
#include "lower/lower.h"
#include "render/renderer.h"
#include "render_scene.h"
#include "support/test_device.h"
#include "view/detail/shown_view.h"

namespace caplet::view {
namespace {

constexpr const char* text = R"(
LookAt 0 -6 0  0 0 0  0 0 1
Camera "perspective" "float fov" [ 40 ]
PixelFilter "box"
Film "rgb" "integer xresolution" [ 64 ] "integer yresolution" [ 48 ]
WorldBegin
LightSource "infinite"
Translate -1 0 0
Shape "sphere" "float radius" [ 0.75 ]
Translate 2 9 0
Shape "sphere" "float radius" [ 0.75 ]
)";

ShowView look_at(int width, int height) {
  ShowView look = look_of_scene(test::scene_of_text(text));
  look.width = width;
  look.height = height;
  return look;
}

Film film_of(const Scene& scene) {
  DeviceScene on_device(test::test_device(), lower(scene));
  Renderer renderer(on_device, lower_view(scene), {.layers = Layers::usual().with(Layer::object)});
  renderer.pass(renderer.layout().window, 0, 4, {});
  return renderer.film().read();
}

std::vector<std::uint64_t> words_of(const Scene& scene) {
  const Film film = film_of(scene);
  return {film.words().begin(), film.words().end()};
}

Scene looked_at(const ShowView& look, int scale, int eye) {
  Scene scene = test::scene_of_text(text);
  const View view = shown_view(scene.view, look, scale, eye);
  scene.view.camera = view.camera;
  scene.view.film = view.film;
  return scene;
}

// With parallel rays, 3 units of the world are 48 pixels: balls of radius 0.75 are disks of 12
// pixels, the near and the far one.
TEST(Orthographic, ShowsBallsAsDisksWhateverTheirDistance) {
  ShowView look = look_at(64, 48);
  look.orthographic = 1.5;
  const Scene scene = looked_at(look, 1, 0);
  const Film film = film_of(scene);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x)
      for (const std::uint32_t ball : {0u, 1u}) {
        const double far = std::hypot(x + 0.5 - (ball == 0 ? 48 : 16), y + 0.5 - 24);
        const bool is_seen =
            film.number(Layer::object, static_cast<std::size_t>(64 * y + x)) == ball;
        if (far < 11) {
          EXPECT_TRUE(is_seen) << x << ' ' << y << ' ' << ball;
        }
        if (far > 13) {
          EXPECT_FALSE(is_seen) << x << ' ' << y << ' ' << ball;
        }
      }
  // A pixel's ray: to the right, which is -x, by 16.5 pixels of 1/16.
  const RayRecord ray = ray_of_pixel(scene, 48, 24);
  EXPECT_NEAR(ray.ox, -16.5 / 16, 1e-6);
  EXPECT_NEAR(ray.oz, -0.5 / 16, 1e-6);
  EXPECT_NEAR(ray.oy, -6, 1e-6);
  EXPECT_NEAR(ray.dy, 1, 1e-6);
}

// What is at the distance where a perspective camera frames the same is at the same pixel.
TEST(Orthographic, KeepsTheFraming) {
  ShowView look = look_at(64, 48);
  const RayRecord before = ray_of_pixel(looked_at(look, 1, 0), 5, 40);
  look.orthographic = 6 * std::tan(look.fov / 2);
  const RayRecord after = ray_of_pixel(looked_at(look, 1, 0), 5, 40);
  const double t = 6 / before.dy;
  EXPECT_NEAR(before.ox + t * before.dx, after.ox, 1e-5);
  EXPECT_NEAR(before.oz + t * before.dz, after.oz, 1e-5);
}

// A lens of parallel rays: what is in focus stays where it is.
TEST(Orthographic, FocusesAtOneDistance) {
  ShowView look = look_at(64, 48);
  look.orthographic = 1.5;
  look.focal_distance = 6;
  const Film sharp = film_of(looked_at(look, 1, 0));
  look.lens_radius = 0.4;
  const Film blurred = film_of(looked_at(look, 1, 0));
  int near = 0, far = 0;
  for (std::size_t pixel = 0; pixel < 64 * 48; ++pixel) {
    const std::uint32_t a = sharp.number(Layer::object, pixel),
                        b = blurred.number(Layer::object, pixel);
    near += (a == 0) != (b == 0);
    far += (a == 1) != (b == 1);
  }
  EXPECT_LT(near, 60);
  EXPECT_GT(far, 2 * near);
}

TEST(Orthographic, IsKeptInFiles) {
  ShowView look = look_at(64, 48);
  look.orthographic = 1.5;
  const Scene scene = looked_at(look, 1, 0);
  std::string written;
  write_pbrt(scene, std::filesystem::temp_directory_path(),
             [&](std::string_view piece) { written += piece; });
  EXPECT_NE(written.find("Camera \"orthographic\""), std::string::npos);
  const Scene again = test::scene_of_text(written);
  EXPECT_EQ(fov_of(again.view.camera), 0);
  EXPECT_EQ(words_of(again), words_of(scene));
  const ShowView looked = look_of_scene(again);
  EXPECT_EQ(looked.orthographic, 1.5);
  EXPECT_GT(looked.fov, 0);
}

TEST(Looks, CutScenes) {
  ShowView look = look_at(64, 48);
  look.clip = ClipPlane{{0, 1, 0}, -0.25};
  Scene scene = looked_at(look, 1, 0);
  scene.view.clip = shown_view(scene.view, look, 1, 0).clip;
  ASSERT_TRUE(scene.view.clip);
  EXPECT_EQ(scene.view.clip->offset, -0.25);
  EXPECT_EQ(look_of_scene(scene).clip->normal, glm::dvec3(0, 1, 0));
  look.clip.reset();
  EXPECT_FALSE(shown_view(scene.view, look, 1, 0).clip);
}

TEST(Orthographic, TakesWindowsInSceneUnits) {
  const Scene scene = test::scene_of_text(R"(
Camera "orthographic" "float screenwindow" [ -4 2 -1 3 ]
Film "rgb" "integer xresolution" [ 60 ] "integer yresolution" [ 40 ]
WorldBegin
Shape "sphere"
)");
  const RayRecord ray = ray_of_pixel(scene, 0, 0);
  EXPECT_NEAR(ray.ox, -3.95, 1e-6);
  EXPECT_NEAR(ray.oy, 2.95, 1e-6);
  EXPECT_EQ(ray.dz, 1);
}

TEST(Pairs, AreCamerasMovedByHand) {
  ShowView look = look_at(64, 48);
  look.separation = 0.5;
  for (const int eye : {0, 1}) {
    ShowView moved = look_at(64, 48);
    moved.world_from_camera[3].x += eye == 0 ? 0.25 : -0.25;  // right is -x
    EXPECT_EQ(words_of(looked_at(look, 1, eye)), words_of(looked_at(moved, 1, 0))) << eye;
    // With a window that is moved so that what is 6 away stays: 0.25 / (6 tan 20 degrees).
    look.convergence = 6;
    Scene by_hand = looked_at(moved, 1, 0);
    const double shift =
                     (eye == 0 ? -0.25 : 0.25) / (6 * std::tan(fov_of(by_hand.view.camera) / 2)),
                 x = 64.0 / 48;
    by_hand.view.camera.screen_window = {-x - shift, x - shift, -1, 1};
    const RayRecord hand = ray_of_pixel(by_hand, 3, 7),
                    ours = ray_of_pixel(looked_at(look, 1, eye), 3, 7);
    EXPECT_NEAR(hand.dx, ours.dx, 1e-6);
    EXPECT_NEAR(hand.dz, ours.dz, 1e-6);
    look.convergence = 0;
  }
}

}  // namespace
}  // namespace caplet::view
