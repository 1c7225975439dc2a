// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Points that surfaces carry along, by closed forms.
#include "scene/carried.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace caplet::test {
namespace {

using glm::dmat4;
using glm::dvec3;
using glm::vec3;

void expect_near(const dvec3& found, const dvec3& wanted, double within = 1e-12) {
  EXPECT_LE(glm::length(found - wanted), within)
      << found.x << " " << found.y << " " << found.z << ", not " << wanted.x << " " << wanted.y
      << " " << wanted.z;
}

Scene scene_of(Geometry geometry) {
  Scene scene;
  scene.materials.resize(1);
  scene.shapes.emplace_back().geometry = std::move(geometry);
  scene.view.film.shutter_open = 1;
  scene.view.film.exposure_time = 2;
  return scene;
}

/// Two capsules. The second one goes from the z axis to the x axis, twice as thick.
CapsulesShape bending(const vec3& p0, const vec3& p1) {
  CapsulesShape out;
  out.p0 = {vec3(9), vec3(0), vec3(9), p0};
  out.p1 = {vec3(8), vec3(0, 0, 2), vec3(8), p1};
  out.radius0 = {1, 0.5f, 1, 1};
  out.times = {1, 3};
  return out;
}

TEST(Carried, PointsOfACapsuleKeepTheirPlaceOnIt) {
  const Scene scene = scene_of(bending(vec3(1, 0, 0), vec3(7, 0, 0)));
  const Carrier carrier(scene, 1, 3);
  const SurfacePlace second{{}, 0, 1};
  // A quarter turn about y takes z to x and x to -z.
  expect_near(carrier.carried(second, {0.5, 0, 0.5}), {2.5, 0, -1});
  expect_near(carrier.carried(second, {0, 0.5, 1}), {4, 1, 0});
  expect_near(carrier.carried(second, {0, 0, 2.5}), {8, 0, 0});
  expect_near(carrier.carried(second, {0.3, 0, -0.4}), {1 - 0.8, 0, -0.6});
  // The first one rests.
  expect_near(carrier.carried({{}, 0, 0}, {9, 9, 10}), {9, 9, 10});
  // The way back.
  expect_near(Carrier(scene, 3, 1).carried(second, {2.5, 0, -1}), {0.5, 0, 0.5});
  // Halfway the ends are (0.5 0 0) and (3.5 0 1), and the radius is 0.75.
  const dvec3 half = Carrier(scene, 1, 2).carried(second, {0, 0.5, 1});
  expect_near(half, {2, 0.75, 0.5}, 1e-7);
  // Nothing moves before the shutter opens and after it closes.
  Scene shorter = scene;
  shorter.view.film.exposure_time = 1;
  expect_near(Carrier(shorter, -5, 9).carried(second, {0, 0.5, 1}), half);
}

TEST(Carried, PointsOfTaperedCapsulesFollowTheRadius) {
  CapsulesShape cone = bending(vec3(0), vec3(0, 0, 2));
  cone.radius1 = {1, 0.5f, 1, 0};
  // Halfway along the axis the radius is 0.5 at first, and 0.5 in the end as well; at the thick end
  // it doubles.
  const Carrier carrier(scene_of(cone), 1, 3);
  expect_near(carrier.carried({{}, 0, 1}, {0.5, 0, 1}), {0.5, 0, 1});
  expect_near(carrier.carried({{}, 0, 1}, {0.5, 0, 0}), {1, 0, 0});
}

TEST(Carried, CapsulesMayTurnAround) {
  const Carrier carrier(scene_of(bending(vec3(0), vec3(0, 0, -4))), 1, 3);
  expect_near(carrier.carried({{}, 0, 1}, {0, 0, 2.5}), {0, 0, -5});
  const dvec3 side = carrier.carried({{}, 0, 1}, {0.5, 0, 0.5});
  EXPECT_NEAR(side.z, -1, 1e-12);
  EXPECT_NEAR(std::hypot(side.x, side.y), 1, 1e-12);
}

TEST(Carried, BallsGrowAboutTheirCenters) {
  CapsulesShape balls = bending(vec3(1, 2, 3), vec3(1, 2, 3));
  balls.p1[1] = vec3(0);
  const Carrier carrier(scene_of(balls), 1, 3);
  expect_near(carrier.carried({{}, 0, 1}, {0.3, 0.4, 0}), {1.6, 2.8, 3});
}

TEST(Carried, PointsOfATriangleKeepTheirBarycentricCoordinates) {
  TriangleMeshShape mesh;
  mesh.triangles = {{0, 1, 2}, {3, 2, 1}};
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                    {0, 0, 1}, {2, 0, 1}, {0, 3, 1}, {2, 3, 2}};
  mesh.times = {1, 3};
  Scene scene = scene_of(mesh);
  scene.shapes[0].world_from_object = glm::translate(dmat4(1), dvec3(10, 0, 0));
  const Carrier carrier(scene, 1, 3);
  expect_near(carrier.carried({{}, 0, 0}, {10.25, 0.5, 0}), {10.5, 1.5, 1});
  // Of corner 3 the share is 0.5.
  expect_near(carrier.carried({{}, 0, 1}, {10.75, 0.75, 0}), {11.5, 2.25, 1.5});
}

TEST(Carried, PointsOfInstancesMoveWithThem) {
  Scene scene;
  scene.materials.resize(1);
  Object& object = scene.objects.emplace_back();
  object.shapes.resize(2);
  object.shapes[1].geometry = SphereShape{1};
  object.shapes[1].world_from_object = glm::translate(dmat4(1), dvec3(2, 0, 0));
  const dmat4 turn = glm::rotate(dmat4(1), std::numbers::pi / 2, dvec3(0, 0, 1));
  scene.instances.resize(2);
  scene.instances[1].motion = {{0, dmat4(1)}, {1, turn}};
  const SurfacePlace place{1, 1, 0};
  expect_near(Carrier(scene, 0, 1).carried(place, {3, 0, 0}), {0, 3, 0});
  const double c = std::sqrt(0.5);
  expect_near(Carrier(scene, 0, 0.5).carried(place, {3, 0, 0}), {3 * c, 3 * c, 0});
  expect_near(Carrier(scene, 0, 1).carried({0, 1, 0}, {3, 0, 0}), {3, 0, 0});
}

}  // namespace
}  // namespace caplet::test
