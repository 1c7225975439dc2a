// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Many worlds, by the public headers alone. Hits are compared in query_tests and in Python's tests.
#include <caplet/batch.h>
#include <caplet/pick.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "library_device.h"

namespace caplet_batch_test {
namespace {

using caplet::Transform;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::uint32_t none = caplet::Crossing::none;

Transform at_depth(double z) { return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, z}; }

caplet::Scene ball_and_wall() {
  caplet::Scene scene;
  caplet::ShapeOptions options;
  options.name = "ball";
  scene.add_shape("sphere", {{"radius", {1.0}}}, options);
  options.name = "wall";
  options.transform = at_depth(20);
  scene.add_shape("disk", {{"radius", {3.0}}}, options);
  return scene;
}

// Two worlds, two cameras each, of which one looks to the side; a ray through the ball, one past
// the farther ones to the wall, one that misses.
TEST(Batch, WritesWorldsThenCamerasThenRays) {
  const std::vector<std::uint32_t> moving = {0};
  caplet::Batch batch(ball_and_wall(), moving, test_device());
  const std::vector<Transform> balls = {at_depth(5), at_depth(9)};
  const Transform aside = {0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0};
  const std::vector<Transform> cameras = {at_depth(0), aside, at_depth(1), at_depth(-1)};
  const std::vector<std::array<float, 3>> ways = {{0, 0, 2}, {0, 0.14F, 1}, {0, 1, 0}};
  std::vector<float> t(12);
  std::vector<std::uint32_t> shape(12), instance(12);
  std::vector<std::array<float, 3>> normal(12);
  caplet::BatchHits out;
  out.t = t;
  out.shape = shape;
  out.instance = instance;
  out.normal = normal;
  batch.nearest(2, balls, cameras, ways, out);
  EXPECT_THAT(shape, ElementsAre(0, 0, none, none, none, none, 0, 1, none, 0, 1, none));
  EXPECT_THAT(instance, testing::Each(none));
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(std::isinf(t[i]), shape[i] == none) << i;
  // 16 eps of the distances, which are at most 20.
  EXPECT_NEAR(t[0], 4.0 / 2, 16 * 0x1p-24 * 20);
  EXPECT_NEAR(t[6], 7.0 / 2, 16 * 0x1p-24 * 20);
  EXPECT_NEAR(t[9], 9.0 / 2, 16 * 0x1p-24 * 20);
  EXPECT_NEAR(normal[0][2], -1, 1e-6);
  EXPECT_THAT(normal[2], ElementsAre(0, 0, 0));
}

// A rod across the view and a ball behind it, whose places and radii are of each world: the rays
// along z meet the rod, or what it leaves of the ball, at the depths minus the radii.
TEST(Batch, CapsulesHaveEndsOfEachWorld) {
  caplet::Scene scene;
  caplet::CapsuleArrays rod{{{-1, 0, 3}}, {{1, 0, 3}}, {0.5F}, {}, {}},
      balls{{{0, 0, 6}, {3, 0, 6}}, {{0, 0, 6}, {3, 0, 6}}, {1, 1}, {}, {}};
  scene.add_capsules(rod);
  scene.add_capsules(balls);
  const std::vector<std::uint32_t> moving = {1}, deforming = {1, 0};
  caplet::Batch batch(scene, moving, test_device(), deforming);
  const std::vector<Transform> places = {at_depth(0), at_depth(2)};
  const std::vector<caplet::Capsule> ends = {
      {{0, 0, 6}, {0, 0, 6}, 1, 1},          {{3, 0, 5}, {3, 0, 5}, 0.5F, 0.5F},
      {{-1, 0, 3}, {1, 0, 3}, 0.25F, 0.25F},  // the second world:
      {{0, 0, 7}, {0, 0, 7}, 2, 2},          {{3, 0, 5}, {3, 2, 5}, 0.5F, 0.5F},
      {{-1, 2, 3}, {1, 2, 3}, 0.25F, 0.125F}};
  const std::vector<Transform> cameras(2, at_depth(0));
  const std::vector<std::array<float, 3>> ways = {{0, 0, 1}, {0.6F, 0, 1}, {1.0F / 64, 2, 3}};
  std::vector<float> t(6);
  std::vector<std::uint32_t> shape(6), primitive(6);
  caplet::BatchHits out;
  out.t = t;
  out.shape = shape;
  out.primitive = primitive;
  batch.nearest(2, places, cameras, ways, out, ends);
  EXPECT_THAT(shape, ElementsAre(0, 1, none, 1, none, 0));
  EXPECT_THAT(primitive, ElementsAre(0, 1, none, 0, none, 0));
  EXPECT_NEAR(t[0], 2.75, 1e-5);
  EXPECT_NEAR(t[3], 7, 1e-5);
  const auto message = [&](std::size_t count) -> std::string {
    try {
      batch.nearest(2, places, cameras, ways, out, std::span(ends).first(count));
    } catch (const caplet::InputError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_EQ(message(6), "taken");
  EXPECT_EQ(message(5), "2 worlds of 3 capsules that change, and ends of 5");
  const std::vector<std::uint32_t> twice = {0, 0}, beyond = {2};
  EXPECT_THROW(caplet::Batch(scene, moving, test_device(), twice), caplet::InputError);
  EXPECT_THROW(caplet::Batch(scene, moving, test_device(), beyond), caplet::InputError);
}

TEST(Batch, RefusesWhatDoesNotGoTogether) {
  const std::vector<std::uint32_t> moving = {0}, twice = {1, 1}, beyond = {2};
  const caplet::Scene scene = ball_and_wall();
  const auto message = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const caplet::InputError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_THAT(message([&] { caplet::Batch(scene, twice, test_device()); }),
              HasSubstr("shape 1 is there twice"));
  EXPECT_THAT(message([&] { caplet::Batch(scene, beyond, test_device()); }),
              HasSubstr("there is no shape 2 in the world, which has 2"));
  caplet::Batch batch(scene, moving, test_device());
  const std::vector<Transform> three(3, at_depth(5));
  const std::span<const Transform> places = three;
  const std::vector<std::array<float, 3>> ways = {{0, 0, 1}};
  std::vector<float> t(3);
  caplet::BatchHits out;
  out.t = t;
  EXPECT_EQ(message([&] { batch.nearest(3, places, places, ways, out); }), "taken");
  EXPECT_EQ(message([&] { batch.nearest(2, places, places.first(2), ways, out); }),
            "2 worlds of 1 moving shapes, and 3 transforms");
  EXPECT_EQ(message([&] { batch.nearest(2, places.first(2), places, ways, out); }),
            "2 worlds and 3 cameras, not equally many for each");
  EXPECT_EQ(message([&] { batch.nearest(2, places.first(2), places.first(2), ways, out); }),
            "t: 2 rays and room for 3 hits");
  Transform flat = at_depth(5);
  flat[0] = 0;
  const std::vector<Transform> last_is_flat = {places[0], places[0], flat};
  EXPECT_THAT(message([&] { batch.nearest(3, last_is_flat, places, ways, out); }),
              HasSubstr("world 2: the transform of moving shape 0 is not affine"));
}

}  // namespace
}  // namespace caplet_batch_test
