// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Transforms over time against closed forms, and what kernels read of them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>

#include "lower/motion.h"
#include "render_scene.h"
#include "scene/frozen.h"
#include "scene/motion.h"
#include "scene/scene.h"

namespace caplet::test {
namespace {

using glm::dmat4;
using glm::dvec3;

constexpr double degree = std::numbers::pi / 180;

dmat4 turned(double degrees, const dvec3& axis) {
  return glm::rotate(dmat4(1), degrees * degree, glm::normalize(axis));
}
dmat4 shifted(const dvec3& by) { return glm::translate(dmat4(1), by); }
dmat4 scaled(const dvec3& by) { return glm::scale(dmat4(1), by); }

double difference(const dmat4& a, const dmat4& b) {
  double out = 0;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) out = std::max(out, std::abs(a[c][r] - b[c][r]));
  return out;
}

TEST(AnimatedTransform, ShiftsTurnsAndGrowsEvenly) {
  const dvec3 axis(1, 2, -2), from(1, 2, 3), to(-2, 5, 4);
  const AnimatedTransform one(
      {{2, shifted(from)}, {4, shifted(to) * turned(150, axis) * scaled({3, 3, 3})}});
  for (const double u : {0.0, 0.1, 0.5, 0.9, 1.0}) {
    const double grown = 1 + 2 * u;
    EXPECT_LT(
        difference(one.at(2 + 2 * u), shifted(from + u * (to - from)) * turned(150 * u, axis) *
                                          scaled({grown, grown, grown})),
        1e-14)
        << u;
  }
  EXPECT_EQ(difference(one.at(0), one.at(2)), 0);
  EXPECT_EQ(difference(one.at(9), one.at(4)), 0);
}

// The polar decomposition leaves a stretch along axes of its own, which is interpolated entry by
// entry.
TEST(AnimatedTransform, StretchesAlongObliqueAxes) {
  const dmat4 oblique = turned(30, {0, 0, 1}) * scaled({2, 1, 0.5}) * turned(-30, {0, 0, 1});
  const AnimatedTransform one({{0, dmat4(1)}, {1, turned(60, {1, 0, 0}) * oblique}});
  const dmat4 half = turned(30, {1, 0, 0}) * (0.5 * dmat4(1) + 0.5 * oblique);
  EXPECT_LT(difference(one.at(0.5), half), 1e-14);
}

TEST(AnimatedTransform, TakesTheShorterWay) {
  const AnimatedTransform one({{0, dmat4(1)}, {1, turned(200, {0, 0, 1})}});
  EXPECT_LT(difference(one.at(0.5), turned(-80, {0, 0, 1})), 1e-14);
}

TEST(MotionSpan, IsFromTheFirstKeyToTheLast) {
  EXPECT_FALSE(motion_span(scene_of_text("WorldBegin\nShape \"sphere\"\n")));
  const auto span = motion_span(
      scene_of_text("TransformTimes 0.5 2\nWorldBegin\nActiveTransform EndTime\nTranslate 1 0 0\n"
                    "ActiveTransform All\nShape \"sphere\"\n"
                    "Shape \"capsules\" \"float times\" [-1 1] \"point3 p0\" [0 0 0 0 0 0]"
                    " \"point3 p1\" [1 0 0 0 1 0] \"float radius\" [0.1 0.1]\n"));
  ASSERT_TRUE(span);
  EXPECT_EQ((*span)[0], -1);
  EXPECT_EQ((*span)[1], 2);
  // The camera's keys count, and capsules of objects.
  const auto of_camera =
      motion_span(scene_of_text("TransformTimes 3 4\nActiveTransform EndTime\nTranslate 1 0 0\n"
                                "Camera \"perspective\"\nWorldBegin\nShape \"sphere\"\n"));
  ASSERT_TRUE(of_camera);
  EXPECT_EQ(*of_camera, (std::array<double, 2>{3, 4}));
  const auto of_object = motion_span(scene_of_text(
      "WorldBegin\nObjectBegin \"o\"\nShape \"capsules\" \"float times\" [5 7]"
      " \"point3 p0\" [0 0 0 0 0 0] \"point3 p1\" [1 0 0 0 1 0] \"float radius\" [0.1 0.1]\n"
      "ObjectEnd\nObjectInstance \"o\"\n"));
  ASSERT_TRUE(of_object);
  EXPECT_EQ(*of_object, (std::array<double, 2>{5, 7}));
}

TEST(AnimatedTransform, GoesFromKeyToKey) {
  const AnimatedTransform one({{0, dmat4(1)},
                               {1, turned(120, {0, 0, 1})},
                               {3, turned(240, {0, 0, 1})},
                               {4, turned(240, {0, 0, 1}) * shifted({0, 0, 2})}});
  EXPECT_LT(difference(one.at(0.5), turned(60, {0, 0, 1})), 1e-14);
  EXPECT_LT(difference(one.at(2), turned(180, {0, 0, 1})), 1e-14);
  EXPECT_LT(difference(one.at(3.25), turned(240, {0, 0, 1}) * shifted({0, 0, 0.5})), 1e-14);
}

// pbrt-v4 cannot interpolate a mirrored camera.
TEST(AnimatedTransform, TurnsMirroredThings) {
  const dmat4 mirror = scaled({-1, 1, 1});
  const AnimatedTransform one({{0, mirror}, {1, turned(90, {0, 1, 0}) * mirror}});
  EXPECT_LT(difference(one.at(0.5), turned(45, {0, 1, 0}) * mirror), 1e-14);
}

TEST(AnimatedTransform, IsExactForSmallTurns) {
  const AnimatedTransform one({{0, dmat4(1)}, {1, turned(1e-6, {0, 0, 1})}});
  EXPECT_NEAR(one.at(0.25)[0][1], 0.25e-6 * degree, 1e-20);
}

// The pivot goes straight on, and the rest turns about it.
TEST(AnimatedTransform, TurnsAboutItsPivot) {
  const dvec3 pivot(1, -2, 3), to(4, 0, 1);
  const dmat4 end = shifted(to) * turned(90, {0, 0, 1}) * scaled({2, 2, 2});
  const AnimatedTransform one({{0, dmat4(1)}, {1, end}}, pivot);
  const dvec3 there(end * glm::dvec4(pivot, 1));
  for (const double u : {0.0, 0.25, 0.5, 1.0})
    EXPECT_LT(
        difference(one.at(u), shifted(pivot + u * (there - pivot)) * turned(90 * u, {0, 0, 1}) *
                                  scaled(dvec3(1 + u)) * shifted(-pivot)),
        1e-14);
}

TEST(FrozenAt, TakesAllMotionAway) {
  Scene scene;
  scene.instances.push_back({0, dmat4(1), {}, {{0, dmat4(1)}, {2, shifted({4, 0, 0})}}});
  scene.view.camera.motion = {{1, dmat4(1)}, {3, shifted({0, 4, 0})}};
  const Scene frozen = frozen_at(scene, 1.5);
  EXPECT_TRUE(frozen.instances[0].motion.empty());
  EXPECT_TRUE(frozen.view.camera.motion.empty());
  EXPECT_EQ(frozen.instances[0].world_from_object[3].x, 3);
  EXPECT_EQ(frozen.view.camera.world_from_camera[3].y, 1);
}

FilmSettings shutter(double open, double close) {
  FilmSettings film;
  film.shutter_open = open;
  film.exposure_time = close - open;
  return film;
}

/// Motions of all kinds, with the shutter that sees them.
struct Seen {
  TransformKeys keys;
  FilmSettings film;
};
std::vector<Seen> many_motions() {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] { return dvec3(unit(random), unit(random), unit(random)); };
  std::vector<Seen> out;
  for (int i = 0; i < 40; ++i) {
    TransformKeys keys;
    double time = -0.25 + 0.35 * unit(random);
    for (int k = 0; k < 2 + i % 3; ++k) {
      keys.push_back({time, shifted(10.0 * vector()) * turned(170 * unit(random), vector()) *
                                scaled(dvec3(1.5) + vector())});
      time += 0.2 + std::abs(unit(random));
    }
    // The shutter may open before the first key, and close after the last one.
    out.push_back({keys, shutter(-0.5, i % 4 == 0 ? 3.5 : 0.75)});
  }
  return out;
}

// An entry may be off by half a rounding of the cubic's fit, and some of the cubic's evaluation, of
// its row's largest entry: 4 units of 2^-24 in all.
TEST(MotionPath, IsTheMotionUpToRoundings) {
  for (const Seen& seen : many_motions()) {
    const auto path = MotionPath::of(seen.keys, seen.film);
    ASSERT_TRUE(path);
    std::vector<float> floats;
    path->append(true, floats);
    ASSERT_EQ(floats.size(), path->segments() * (2 + 2 * std::size_t{CAPLET_MOTION_FLOATS}));
    EXPECT_LE(path->segments(), 400u);
    const AnimatedTransform animated(seen.keys);
    for (int i = 0; i <= 1000; ++i) {
      const float time = static_cast<float>(i) / 1000;
      const dmat4 exact =
          animated.at(seen.film.shutter_open + double{time} * seen.film.exposure_time);
      // A time that is rounded to a float moves things too.
      const dmat4 later =
          animated.at(seen.film.shutter_open + (double{time} + 0x1p-22) * seen.film.exposure_time);
      for (const std::uint32_t which : {0u, 1u}) {
        const dmat4 expected = which == 0 ? glm::inverse(exact) : exact;
        const double moved = difference(expected, which == 0 ? glm::inverse(later) : later);
        const auto found = motion_at(floats, path->segments(), 2, which, time);
        double shift = 0;
        for (int r = 0; r < 3; ++r) shift = std::max(shift, std::abs(expected[3][r]));
        for (int r = 0; r < 3; ++r) {
          double row = 0;
          for (int c = 0; c < 3; ++c) row = std::max(row, std::abs(expected[c][r]));
          for (int c = 0; c < 4; ++c)
            EXPECT_NEAR(found[static_cast<std::size_t>(4 * r + c)], expected[c][r],
                        4 * 0x1p-24 * (c == 3 ? row + shift : row) + moved)
                << which << " " << time;
        }
      }
    }
  }
}

TEST(MotionPath, SweepsTheBoxThroughAllItsPlaces) {
  const Bounds box{dvec3(-1, -0.5, 0), dvec3(2, 0.25, 1)};
  double empty_share = 0;
  for (const Seen& seen : many_motions()) {
    const auto path = MotionPath::of(seen.keys, seen.film);
    ASSERT_TRUE(path);
    const Bounds swept = path->swept(box);
    const AnimatedTransform animated(seen.keys);
    Bounds met;
    for (int i = 0; i <= 1000; ++i) {
      const dmat4 m = animated.at(seen.film.shutter_open + i / 1000.0 * seen.film.exposure_time);
      for (int corner = 0; corner < 8; ++corner)
        met.extend(dvec3(m * glm::dvec4(corner & 1 ? box.max.x : box.min.x,
                                        corner & 2 ? box.max.y : box.min.y,
                                        corner & 4 ? box.max.z : box.min.z, 1)));
    }
    for (int k = 0; k < 3; ++k) {
      const double slack = 1e-5 * (met.max[k] - met.min[k]);
      EXPECT_LE(swept.min[k], met.min[k] + slack);
      EXPECT_GE(swept.max[k], met.max[k] - slack);
      empty_share = std::max(empty_share, (met.min[k] - swept.min[k] + swept.max[k] - met.max[k]) /
                                              (met.max[k] - met.min[k]));
    }
  }
  EXPECT_LT(empty_share, 0.01);  // and hardly more
}

TEST(MotionPath, SweepsABoxThroughItsPlacesOfAWhile) {
  std::vector<Seen> motions = many_motions();
  // This one is a single cubic, and its box about a point, so that all four coefficients matter.
  motions.push_back({{{0, dmat4(1)}, {1, turned(4, {0, 0, 1})}}, shutter(0, 1)});
  for (const Seen& seen : motions) {
    const Bounds box = &seen == &motions.back() ? Bounds{dvec3(2, 0, 0), dvec3(2, 0, 0)}
                                                : Bounds{dvec3(-1, -0.5, 0), dvec3(2, 0.25, 1)};
    const auto path = MotionPath::of(seen.keys, seen.film);
    ASSERT_TRUE(path);
    const AnimatedTransform animated(seen.keys);
    for (const auto& [begin, end] :
         {std::pair(0.0f, 0.0625f), std::pair(0.3125f, 0.375f), std::pair(0.5f, 0.625f),
          std::pair(0.9375f, 1.0f), std::pair(0.5f, 1.0f)}) {
      const Bounds swept = path->swept(box, begin, end);
      Bounds met;
      for (int i = 0; i <= 200; ++i) {
        const double time = begin + i / 200.0 * double{end - begin};
        const dmat4 m = animated.at(seen.film.shutter_open + time * seen.film.exposure_time);
        for (int corner = 0; corner < 8; ++corner)
          met.extend(dvec3(m * glm::dvec4(corner & 1 ? box.max.x : box.min.x,
                                          corner & 2 ? box.max.y : box.min.y,
                                          corner & 4 ? box.max.z : box.min.z, 1)));
      }
      for (int k = 0; k < 3; ++k) {
        const double size = met.max[k] - met.min[k], slack = 1e-5 * size + 2e-7;
        EXPECT_LE(swept.min[k], met.min[k] + slack) << begin;
        EXPECT_GE(swept.max[k], met.max[k] - slack) << begin;
        EXPECT_LT(met.min[k] - swept.min[k] + swept.max[k] - met.max[k], 0.01 * size + 4e-7)
            << begin;
      }
    }
  }
}

TEST(MotionPath, IsNoneOfWhatRestsWhileTheShutterIsOpen) {
  const TransformKeys keys = {{0, dmat4(1)}, {1, shifted({1, 0, 0})}};
  EXPECT_FALSE(MotionPath::of({}, shutter(0, 1)));
  EXPECT_FALSE(MotionPath::of(keys, shutter(1, 2)));
  EXPECT_FALSE(MotionPath::of({{0, dmat4(1)}, {1, dmat4(1)}}, shutter(0, 1)));
  EXPECT_TRUE(MotionPath::of(keys, shutter(0.99, 2)));
}

TEST(MotionPath, OfAShiftIsOneSegment) {
  const auto path = MotionPath::of({{0, dmat4(1)}, {1, shifted({1, 2, 3})}}, shutter(0.25, 0.5));
  ASSERT_TRUE(path);
  EXPECT_EQ(path->segments(), 1u);
  EXPECT_NEAR(path->start()[3].y, 0.5, 1e-15);
}

}  // namespace
}  // namespace caplet::test
