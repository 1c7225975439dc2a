// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Least widths: radii by hand from the camera's numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/ext/matrix_transform.hpp>

#include "present/least_width.h"
#include "support/import_files.h"

namespace caplet {
namespace {

/// A camera at the origin along z: 90 degrees over 100 rows, so that a pixel covers 2 z / 100.
Scene before_camera() {
  Scene scene;
  scene.materials.push_back({DiffuseMaterial{}, "m", {}});
  scene.view.film.width = 200;
  scene.view.film.height = 100;
  scene.view.camera.projection = PerspectiveProjection{std::acos(-1.0) / 2};
  CapsulesShape capsules;
  capsules.p0 = {{0, 0, 10}, {0, 0, 10}, {0, 0, -10}};
  capsules.p1 = {{0, 0, 20}, {0, 0, 20}, {0, 0, -10}};
  capsules.radius0 = {0.01F, 5, 0.01F};
  Shape shape;
  shape.geometry = capsules;
  scene.shapes.push_back(shape);
  shape.geometry = SphereShape{0.001};
  shape.world_from_object =
      glm::scale(glm::translate(glm::dmat4(1), glm::dvec3(0, 0, 50)), glm::dvec3(4));
  scene.shapes.push_back(shape);
  return scene;
}

TEST(LeastWidth, ThinEndsGrowToTheirPixelsAndNoOthers) {
  Scene scene = before_camera();
  scene.view.film.least_width = 3;
  EXPECT_EQ(widen_to_least(scene), 3U);
  const CapsulesShape capsules = test::capsules_of(scene);
  EXPECT_FLOAT_EQ(capsules.radius0[0], 1.5F * 0.2F);  // a pixel covers 0.2 at 10 and 0.4 at 20
  EXPECT_FLOAT_EQ(capsules.radius1[0], 1.5F * 0.4F);
  EXPECT_EQ(capsules.radius0[1], 5);
  EXPECT_EQ(capsules.radius1[1], 5);
  EXPECT_EQ(capsules.radius0[2], 0.01F) << "behind the camera";
  // 1 at 50, of a sphere that is drawn four times as large.
  EXPECT_NEAR(std::get<SphereShape>(scene.shapes[1].geometry).radius, 1.5 * 1 / 4, 1e-9);
}

TEST(LeastWidth, NothingIsAskedNothingGrows) {
  Scene scene = before_camera();
  EXPECT_EQ(widen_to_least(scene), 0U);
  EXPECT_TRUE(test::capsules_of(scene).radius1.empty());
  EXPECT_EQ(test::capsules_of(scene).radius0[0], 0.01F);
}

TEST(LeastWidth, OrthographicPixelsAreOfOneSize) {
  Scene scene = before_camera();
  scene.view.camera.projection = OrthographicProjection{};
  scene.view.camera.screen_window = {-10, 10, -5, 5};
  scene.view.film.least_width = 2;
  EXPECT_DOUBLE_EQ(pixel_footprint(scene.view.camera, scene.view.film, {0, 0, 1000}), 0.1);
  widen_to_least(scene);
  EXPECT_FLOAT_EQ(test::capsules_of(scene).radius0[0], 0.1F);
  EXPECT_FLOAT_EQ(test::capsules_of(scene).radius0[2], 0.1F);
}

// A sphere of radius 10 has an area of 400 pi.
TEST(LeastWidth, PixelsOfSphericalCamerasDivideTheSphere) {
  const double pi = std::acos(-1.0);
  Scene scene = before_camera();
  const auto footprint = [&](const glm::dvec3& p) {
    return pixel_footprint(scene.view.camera, scene.view.film, p);
  };
  using Mapping = SphericalProjection::Mapping;
  scene.view.camera.projection = SphericalProjection{Mapping::equal_area};
  for (const glm::dvec3& p : {glm::dvec3(10, 0, 0), glm::dvec3(0, -6, -8)})
    EXPECT_NEAR(footprint(p) * footprint(p) * 200 * 100, 400 * pi, 1e-9);
  scene.view.camera.projection = SphericalProjection{Mapping::equirectangular};
  EXPECT_NEAR(footprint({6, 0, -8}), 10 * pi / 100, 1e-12) << "on the horizon";
  scene.view.film.width = 100;
  EXPECT_NEAR(footprint({6, 0, -8}), 10 * pi / 100, 1e-12) << "pixels are wider than high";
  EXPECT_NEAR(footprint({0, 9.6, 2.8}), 2.8 * 2 * pi / 100, 1e-12) << "a circle of radius 2.8";
  scene.view.camera.world_from_camera[3] = {0, 0, 5, 1};
  EXPECT_NEAR(footprint({0, 9.6, 7.8}), 2.8 * 2 * pi / 100, 1e-12) << "from the camera";
}

TEST(LeastWidth, ObjectsGrowForTheInstanceThatNeedsMost) {
  Scene scene = before_camera();
  Object object;
  object.shapes.push_back(scene.shapes[0]);
  scene.objects.push_back(object);
  scene.instances.push_back({0, glm::dmat4(1), {}});
  scene.instances.push_back({0, glm::translate(glm::dmat4(1), glm::dvec3(0, 0, 30)), {}});
  scene.shapes.clear();
  scene.view.film.least_width = 1;
  widen_to_least(scene);
  EXPECT_FLOAT_EQ(std::get<CapsulesShape>(scene.objects[0].shapes[0].geometry).radius0[0],
                  0.5F * 0.8F);  // at 40
}

TEST(LeastWidth, StretchesCountByTheLeast) {
  Scene scene = before_camera();
  scene.shapes[0].world_from_object = glm::scale(glm::dmat4(1), glm::dvec3(0.5, 2, 1));
  scene.view.film.least_width = 1;
  widen_to_least(scene);
  EXPECT_NEAR(test::capsules_of(scene).radius0[0], 0.5 * 0.2 / 0.5, 1e-6);
}

}  // namespace
}  // namespace caplet
