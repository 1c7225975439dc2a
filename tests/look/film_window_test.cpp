// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Another size or crop of a picture, and what turns with a turntable.
#include "present/film_window.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <random>

#include "import/picture_options.h"
#include "present/lights.h"
#include "present/picture_options.h"
#include "present/present.h"
#include "present/turntable.h"
#include "support/import_files.h"

namespace caplet {
namespace {

using test::complaint;
using testing::HasSubstr;
using Crop = std::array<int, 4>;  // x0, x1, y0, y1

std::optional<Crop> crop_after(int width, int height, const Crop& crop, int wide, int tall) {
  Scene scene;
  scene.view.film.width = width;
  scene.view.film.height = height;
  scene.view.film.crop = crop;
  set_film_size(scene, wide, tall);
  EXPECT_EQ(scene.view.film.width, wide);
  EXPECT_EQ(scene.view.film.height, tall);
  return scene.view.film.crop;
}

// A crop keeps its place: its edges go with the width and the height of the picture, to the nearest
// pixel, and it keeps a pixel.
TEST(FilmWindow, ACropGoesWithThePicturesSize) {
  EXPECT_EQ(crop_after(100, 60, {10, 30, 15, 45}, 200, 120), (Crop{20, 60, 30, 90}));
  EXPECT_EQ(crop_after(100, 60, {10, 30, 15, 45}, 50, 120), (Crop{5, 15, 30, 90}));
  EXPECT_EQ(crop_after(100, 60, {10, 30, 15, 45}, 300, 20), (Crop{30, 90, 5, 15}));
  EXPECT_EQ(crop_after(100, 60, {0, 100, 0, 60}, 37, 11), (Crop{0, 37, 0, 11}));
  EXPECT_EQ(crop_after(10, 10, {1, 9, 2, 5}, 25, 15), (Crop{3, 23, 3, 8}));  // 2.5, 22.5, 3, 7.5
  EXPECT_EQ(crop_after(1000, 1000, {500, 501, 998, 999}, 10, 10), (Crop{5, 6, 9, 10}));
  EXPECT_EQ(crop_after(1000, 1000, {999, 1000, 0, 1}, 1, 3), (Crop{0, 1, 0, 1}));
}

TEST(FilmWindow, CropsAndPixelsAreWithinThePicture) {
  Scene scene;
  scene.view.film.width = 20;
  scene.view.film.height = 10;
  const auto said = [&](const Crop& corners) {
    return complaint([&] { set_crop(scene, corners); });
  };  // x0, y0, x1, y1
  EXPECT_EQ(said({0, 0, 20, 10}), "");
  EXPECT_EQ(said({3, 4, 18, 5}), "");
  EXPECT_EQ(scene.view.film.crop, (Crop{3, 18, 4, 5}));
  for (const Crop& wrong : {Crop{3, 4, 21, 5}, {3, 4, 18, 11}, {-1, 4, 18, 5}, {3, -1, 18, 5}})
    EXPECT_THAT(said(wrong), HasSubstr("not within the image of 20x10"));
  for (const Crop& empty : {Crop{3, 4, 3, 5}, {3, 4, 18, 4}, {4, 4, 3, 5}, {3, 5, 18, 4}})
    EXPECT_THAT(said(empty), HasSubstr("is empty"));
  const auto pixel = [&](int x, int y) {
    return complaint([&] { check_pixel({x, y}, scene.view.film); });
  };
  EXPECT_EQ(pixel(3, 4), "");
  EXPECT_EQ(pixel(17, 4), "");
  for (const auto& [x, y] : {std::array{2, 4}, {18, 4}, {3, 3}, {3, 5}})
    EXPECT_THAT(pixel(x, y), HasSubstr("outside of the crop 3,4,18,5"));
  for (const auto& [x, y] : {std::array{-1, 4}, {20, 4}, {3, -1}, {3, 10}})
    EXPECT_THAT(pixel(x, y), HasSubstr("outside of the image"));
}

// --- Turntables ---

constexpr std::uint32_t kFrames = 40;

Scene scene_of(std::vector<Shape> shapes, std::map<std::string, std::string> look = {},
               bool has_no_up = false) {
  Scene scene;
  scene.materials.push_back({DiffuseMaterial{}, "m", {}});
  scene.shapes = std::move(shapes);
  scene.view.film.width = 300;
  scene.view.film.height = 200;
  scene.has_no_up = has_no_up;
  add_presentation(scene);
  if (!look.empty())
    apply_picture_options(scene, test::NoImages(), ImportOptions(std::move(look)), false);
  return scene;
}

Shape capsules(const std::vector<glm::vec4>& from, const std::vector<glm::vec4>& to) {
  CapsulesShape of;
  for (std::size_t i = 0; i < from.size(); ++i) {
    of.p0.emplace_back(from[i]);
    of.p1.emplace_back(to[i]);
    of.radius0.push_back(from[i].w);
    of.radius1.push_back(to[i].w);
  }
  Shape shape;
  shape.geometry = of;
  return shape;
}

/// How far towards the film's edges points of a ball are seen, 1 at the edge.
double reach(const Camera& camera, const FilmSettings& film, const glm::dvec4& ball) {
  const glm::dmat4 camera_from_world = glm::inverse(camera.world_from_camera);
  const double shorter = std::min(film.width, film.height), tangent = std::tan(fov_of(camera) / 2);
  double most = 0;
  for (int i = 0; i < 800; ++i) {  // the golden spiral
    const double h = 1 - (2 * i + 1) / 800.0, phi = i * 2.399963229728653, r = std::sqrt(1 - h * h);
    const glm::dvec4 q =
        camera_from_world *
        glm::dvec4(glm::dvec3(ball) + ball.w * glm::dvec3(r * std::cos(phi), h, r * std::sin(phi)),
                   1);
    if (!(q.z > 0)) return 1e9;
    most = std::max({most, std::abs(q.x / q.z) / (tangent * film.width / shorter),
                     std::abs(q.y / q.z) / (tangent * film.height / shorter)});
  }
  return most;
}

/// Returns the reach of balls over all frames of a turn.
double reach_of_turn(const Scene& scene, const std::vector<glm::dvec4>& balls) {
  const Turntable table(scene);
  double most = 0;
  for (std::uint32_t i = 0; i < kFrames; ++i)
    for (const glm::dvec4& ball : balls)
      most = std::max(most, reach(table.camera(i, kFrames), scene.view.film, ball));
  return most;
}

// Clubs whose thick end is low or high, near or far from the axis, seen from above and from below:
// each frame has all of it.
TEST(Turntable, HoldsBothEndsOfWhatTurns) {
  for (const char* view : {"1,0.8,1", "1,-0.8,1", "1,0,0.2", "0.3,3,1", "0.3,-3,1"})
    for (const double thick : {0.3, 2.0})
      for (const double up : {1.0, -1.0}) {
        SCOPED_TRACE(std::string(view) + " " + std::to_string(thick) + " " + std::to_string(up));
        const glm::vec4 low(5, -4 * up, 2, thick), high(6, 3 * up, 2, 0.2);
        for (const Shape& club : {capsules({low}, {high}), capsules({high}, {low})}) {
          const double most = reach_of_turn(scene_of({club}, {{"view", view}}), {low, high});
          EXPECT_LE(most, 0.951);
          EXPECT_GE(most, 0.5) << "the camera is not much further than it needs to be";
        }
      }
}

// Balls that touch both rims and the side of the cylinder that is framed: the nearest is seen
// nearly to the margin of 0.95 in some frame. The rims are held by polygons of 64 sides, which are
// a thousandth wider.
TEST(Turntable, IsNoFurtherThanItsCylinder) {
  for (const char* view : {"1,0.8,1", "1,-0.8,1", "0,0.2,-1"})
    for (const float radius : {0.05F, 0.4F}) {
      SCOPED_TRACE(std::string(view) + " " + std::to_string(radius));
      std::vector<glm::vec4> ends;
      for (const float y : {-3.0F, 4.0F})
        for (const float x : {-5.0F, 5.0F}) ends.emplace_back(x, y, 0, radius);
      const Scene scene = scene_of({capsules(ends, ends)}, {{"view", view}});
      std::vector<glm::dvec4> balls(ends.begin(), ends.end());
      const double most = reach_of_turn(scene, balls);
      EXPECT_LE(most, 0.951);
      // A cylinder has corners, which balls have not: of 0.41 of their radius beyond them, at most.
      EXPECT_GE(most, 0.945 - 0.08 * radius);
    }
}

// Shapes that are no capsules, capsules that are stretched, and instances are held by their bounds.
TEST(Turntable, HoldsShapesOfAllKinds) {
  Shape ball;
  ball.geometry = SphereShape{1};
  ball.world_from_object[3] = glm::dvec4(4, -3, 1, 1);
  Shape stretched = capsules({glm::vec4(0, 0, 0, 0.5F)}, {glm::vec4(0, 1, 0, 0.5F)});
  stretched.world_from_object[1] *= 3;
  Scene scene = scene_of({ball, stretched}, {{"view", "1,0.5,0.3"}});
  Object object;
  object.shapes.push_back(capsules({glm::vec4(0, 0, 0, 0.25F)}, {glm::vec4(1, 0, 0, 0.25F)}));
  scene.objects.push_back(object);
  glm::dmat4 there(1);
  there[3] = glm::dvec4(-6, 9, 0, 1);
  scene.instances.push_back({0, there, {}});
  frame_camera(scene);
  EXPECT_LE(
      reach_of_turn(
          scene,
          {{4, -3, 1, 1}, {0, 0, 0, 0.5}, {0, 3, 0, 0.5}, {-6, 9, 0, 0.25}, {-5, 9, 0, 0.25}}),
      0.951);
}

// The automatic light stays where it is for who looks: with the camera, by the same turn. Others
// stay where they are.
TEST(Turntable, TurnsTheAutomaticLightWithTheCamera) {
  Scene scene = scene_of({capsules({glm::vec4(1, 0, 0, 0.5F)}, {glm::vec4(3, 2, 1, 0.25F)})});
  ASSERT_EQ(scene.lights.size(), 1U);
  Light own;
  InfiniteLight plain;
  own.model = plain;
  const Turntable table(scene);
  const Light& light = scene.lights[0];
  EXPECT_TRUE(table.turns(light));
  EXPECT_FALSE(table.turns(own));
  const auto from_camera = [&](std::uint32_t number) {
    const Light turned = table.turned(light, number, kFrames);
    return glm::transpose(glm::dmat3(table.camera(number, kFrames).world_from_camera)) *
           std::get<InfiniteLight>(turned.model).world_from_light;
  };
  const glm::dmat3 first = from_camera(0);
  // Toward the viewer, to his right, up: as presentation.md says of lights.
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 expected[] = {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_LT(glm::length(first[k] - expected[k]), 1e-12) << k;
  }
  for (std::uint32_t i = 1; i < kFrames; ++i)
    for (int k = 0; k < 3; ++k)
      EXPECT_LT(glm::length(from_camera(i)[k] - first[k]), 1e-12) << i << " " << k;
  EXPECT_EQ(std::get<InfiniteLight>(table.turned(light, 0, kFrames).model).world_from_light,
            std::get<InfiniteLight>(light.model).world_from_light);
  // A file's own camera goes round its scene; its light stays.
  scene.automatic_camera = false;
  EXPECT_FALSE(Turntable(scene).turns(light));
}

// Around the axis of the world that is nearest to the camera's up; where a scene has no up, around
// the camera's own.
TEST(Turntable, AxisIsUp) {
  for (const auto& [up, view] : {std::pair{"y", "1,0.7,2"}, {"z", "1,2,0.7"}, {"-x", "-0.7,1,2"}})
    for (const bool has_no_up : {false, true}) {
      const Scene scene =
          scene_of({capsules({glm::vec4(1, 0, 0, 0.5F)}, {glm::vec4(3, 2, 1, 0.25F)})},
                   {{"view", view}, {"up", up}}, has_no_up);
      const Turntable table(scene);
      const glm::dmat3 before(table.camera(0, 4).world_from_camera),
          after(table.camera(1, 4).world_from_camera);
      const glm::dmat3 turn = after * glm::transpose(before);
      const glm::dvec3 axis = has_no_up ? before[1] : parse_axis(up, "");
      EXPECT_LT(glm::length(turn * axis - axis), 1e-9) << up << has_no_up;
      // To the camera's right: a quarter of a turn takes its back to where its right was.
      const glm::dvec3 level = glm::normalize(before[0] - axis * glm::dot(axis, before[0]));
      EXPECT_LT(glm::length(turn * glm::cross(level, axis) - level), 1e-9) << up << has_no_up;
    }
}

// --- Scenes without an up ---

// A plate in the plane z = 0, seen from nearly straight on: its longer side goes along the
// picture's longer side where it then is seen at less than 0.8 of the distance, and stays as it is
// elsewhere or where there is an up.
TEST(FramingWithoutUp, TheLongerSideGoesAlongThePicture) {
  struct Row {
    float x, y;  // half its sides
    int width, height;
    bool is_turned;
  };
  for (const Row& row :
       {Row{1, 4, 300, 200, true}, Row{4, 1, 300, 200, false}, Row{4, 1, 200, 300, true},
        Row{1, 4, 200, 300, false}, Row{3, 3.5F, 300, 200, false}, Row{1, 4, 200, 200, false}})
    for (const bool has_no_up : {false, true}) {
      CapsulesShape plate;
      for (const float x : {-row.x, row.x})
        for (const float y : {-row.y, row.y}) plate.p0.emplace_back(x, y, 0);
      plate.p1 = plate.p0;
      plate.radius0.assign(4, 0.1F);
      Scene scene;
      scene.materials.push_back({DiffuseMaterial{}, "m", {}});
      scene.shapes.emplace_back().geometry = plate;
      scene.view.film.width = row.width;
      scene.view.film.height = row.height;
      scene.has_no_up = has_no_up;
      frame_camera(scene);
      const glm::dvec3 right(scene.view.camera.world_from_camera[0]);
      SCOPED_TRACE(testing::Message() << row.x << " " << row.y << ", " << row.width << " "
                                      << row.height << " " << has_no_up);
      // 10 and 6 degrees aside.
      EXPECT_GT(std::abs(row.is_turned && has_no_up ? right.y : right.x), 0.97);
    }
}

// --- Automatic cameras ---

// An orthographic camera stands as far before the nearest point as the picture's content is long,
// along each axis that it may be longest along: for the depth layer. With a margin of 5 % of the
// half picture.
TEST(Framing, OrthographicCamerasStandOneExtentAway) {
  for (const glm::vec3& half : {glm::vec3(5, 1, 1), glm::vec3(1, 5, 1), glm::vec3(1, 1, 5)}) {
    Shape box;
    box.geometry = BoxShape{-glm::dvec3(half), glm::dvec3(half)};
    const Scene scene = scene_of({box}, {{"view", "front"}, {"projection", "orthographic"}});
    const glm::dvec3 eye(scene.view.camera.world_from_camera[3]);
    EXPECT_NEAR(eye.z - double{half.z}, 2 * 5 / 0.95, 1e-9) << half.x << " " << half.y;
  }
}

// A capsule is framed by the balls of both its ends.
TEST(Framing, TaperedCapsulesAreWithinByBothRadii) {
  for (const auto& [r0, r1] : {std::pair{0.1F, 1.0F}, std::pair{1.0F, 0.1F}}) {
    Shape tapered;
    tapered.geometry = CapsulesShape{{glm::vec3(0)}, {glm::vec3(4, 0, 0)}, {r0}, {r1}, {}};
    const Scene scene = scene_of({tapered}, {{"view", "front"}, {"projection", "orthographic"}});
    const Camera& camera = scene.view.camera;
    EXPECT_NEAR(camera.world_from_camera[3].x, 0.5 * (4 + double{r1} - double{r0}), 1e-6);
    EXPECT_NEAR(camera.screen_window.value()[1], 0.5 * (4 + 0.1 + 1) / 0.95, 1e-6);
  }
}

// A tower is seen across its wider level side, three-quarter: 30 degrees to its right and 18 above.
TEST(Framing, TowersAreSeenAcrossTheirWiderSide) {
  const double azimuth = std::numbers::pi / 6, elevation = std::numbers::pi / 10;
  for (const bool is_wide_in_x : {true, false}) {
    std::vector<glm::vec4> corners;
    for (const float x : {-1.0F, 1.0F})
      for (const float y : {-6.0F, 6.0F})
        for (const float z : {-1.0F, 1.0F})
          corners.emplace_back(is_wide_in_x ? 2 * x : x, y, is_wide_in_x ? z : 2 * z, 0.2F);
    const Scene scene = scene_of({capsules(corners, corners)});
    const glm::dvec3 forward(scene.view.camera.world_from_camera[2]),
        right(scene.view.camera.world_from_camera[0]);
    EXPECT_NEAR(forward.y, -std::sin(elevation), 1e-6);
    EXPECT_NEAR(right.y, 0, 1e-6);
    // From the front where it is wide from left to right, and from the right where it is wide from
    // front to back.
    EXPECT_NEAR(-(is_wide_in_x ? forward.z : forward.x), std::cos(azimuth) * std::cos(elevation),
                1e-6);
  }
}

}  // namespace
}  // namespace caplet
