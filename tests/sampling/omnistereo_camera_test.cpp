// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Eyes of a head that looks around, and lenses with blades, against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "camera_rays.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace caplet::test::omnistereo_camera_test {
namespace {

using sampling_test::camera_ray;
using sampling_test::camera_rays;
using sampling_test::camera_spread;
using sampling_test::WeighedRay;

glm::dvec3 direction_of(const RayRecord& ray) { return {ray.dx, ray.dy, ray.dz}; }

// Eyes look along the tangent of their circle. A point straight ahead at a distance D is seen
// asin(eye / D) to the left by the right eye, and as much to the right by the left one.
TEST(Omnistereo, EyesMoveOnACircle) {
  Scene scene;
  scene.view.film.width = 400;
  scene.view.film.height = 200;
  scene.view.camera.projection = OmnistereoProjection{0.25};
  const RayRecord ahead = camera_ray(scene, {200, 100}, {0.5f, 0.5f}),
                  right = camera_ray(scene, {300, 50}, {0.5f, 0.5f});
  EXPECT_LT(glm::length(direction_of(ahead) - glm::dvec3(0, 0, 1)), 1e-6);
  EXPECT_LT(glm::length(glm::dvec3(ahead.ox, ahead.oy, ahead.oz) - glm::dvec3(0.25, 0, 0)), 1e-6);
  const double half = std::sqrt(0.5);
  EXPECT_LT(glm::length(direction_of(right) - glm::dvec3(half, half, 0)), 1e-6);
  EXPECT_LT(glm::length(glm::dvec3(right.ox, right.oy, right.oz) - glm::dvec3(0, 0, -0.25)), 1e-6);
  for (const double eye : {0.25, -0.25}) {
    scene.view.camera.projection = OmnistereoProjection{eye};
    const auto seen = project(scene.view.camera, scene.view.film, {0, 0, 2});
    ASSERT_TRUE(seen);
    EXPECT_NEAR(seen->x, 200 - 400 * std::asin(eye / 2) / (2 * std::numbers::pi), 1e-9);
    EXPECT_NEAR(seen->y, 100, 1e-9);
  }
  EXPECT_NEAR(camera_spread(scene, {200, 100})[1], std::numbers::pi / 200, 1e-6);
  // Above, columns crowd: a pixel is sin(30 degrees) times as wide.
  EXPECT_NEAR(camera_spread(scene, {200, 200.0f / 6})[1], 0.75 * std::numbers::pi / 200, 1e-6);
  EXPECT_NEAR(pixel_footprint(scene.view.camera, scene.view.film, {0, 0, 2}),
              2 * std::numbers::pi / 200, 1e-9);
}

// The second moment of a regular polygon with corners at distance 1 is (2 + cos(2 pi / n)) / 6
// around its middle, per area.
TEST(Lens, BladesMakeAPolygon) {
  for (const int blades : {3, 5, 8}) {
    Scene scene;
    scene.view.camera.lens_radius = 2;
    scene.view.camera.focal_distance = 10;
    scene.view.camera.blades = blades;
    scene.view.camera.blade_rotation = 20;
    std::vector<glm::vec4> samples;
    for (int i = 0; i < 120; ++i)
      for (int j = 0; j < 120; ++j)
        samples.emplace_back(640, 360, (static_cast<float>(i) + 0.5f) / 120,
                             (static_cast<float>(j) + 0.5f) / 120);
    double moment = 0, farthest = 0;
    glm::dvec2 mean(0);
    const double step = 2 * std::numbers::pi / blades, turn = 20 * std::numbers::pi / 180;
    for (const WeighedRay& each : camera_rays(scene, samples)) {
      const glm::dvec2 at(each.ray.ox, each.ray.oy);
      EXPECT_EQ(each.weight, 1);
      moment += glm::dot(at, at) / 14400;
      mean += at / 14400.0;
      // Within every side.
      for (int side = 0; side < blades; ++side) {
        const double normal = turn + (side + 0.5) * step;
        EXPECT_LT(at.x * std::cos(normal) + at.y * std::sin(normal), 2 * std::cos(step / 2) + 1e-5);
      }
      // The first corner.
      farthest = std::max(farthest, at.x * std::cos(turn) + at.y * std::sin(turn));
    }
    EXPECT_NEAR(moment, 4 * (2 + std::cos(step)) / 6, 2e-3);
    EXPECT_LT(glm::length(mean), 1e-4);
    EXPECT_GT(farthest, 1.95);
  }
}

}  // namespace
}  // namespace caplet::test::omnistereo_camera_test
