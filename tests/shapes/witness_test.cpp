// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The witness on cases whose answer is known without it.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "reference/scene_witness.h"
#include "reference/solver.h"

namespace {

using namespace caplet;
using namespace caplet::reference;
using glm::dvec3;

// Bisection ends at neighbouring doubles of an offset from the foot; t is then off by a few roundings of |t| and of the scene's
// size.
constexpr double rounding = 1e-13;

dvec3 random_vector(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return {normal(random), normal(random), normal(random)};
}

void expect_crossings(const Primitive& primitive, const Ray& ray, std::initializer_list<double> expected) {
  const auto found = crossings(primitive, ray);
  ASSERT_EQ(found.size(), expected.size());
  std::size_t i = 0;
  for (const double t : expected) {
    EXPECT_NEAR(found[i].t, t, rounding * (1 + std::abs(t)) * 10);
    EXPECT_EQ(found[i].leaving, is_solid(primitive) && i == 1);
    ++i;
  }
}

TEST(Witness, SphereOnItsAxes) {
  expect_crossings(Sphere{{1, 2, 3}, 2}, {{1, 2, -7}, {0, 0, 1}}, {8, 12});
  expect_crossings(Sphere{{1, 2, 3}, 2}, {{1, 2, -7}, {0, 0, 4}}, {2, 3});
  expect_crossings(Sphere{{1, 2, 3}, 2}, {{1, 2, -7}, {0, 0, -0.5}}, {-24, -16});
  expect_crossings(Sphere{{1, 2, 3}, 2}, {{3.0001, 2, -7}, {0, 0, 1}}, {});
}

TEST(Witness, CapsuleAlongAndAcross) {
  const Capsule capsule{{0, 0, 0}, {0, 0, 4}, 0.5, 0.5};
  expect_crossings(capsule, {{0, 0, -3}, {0, 0, 1}}, {2.5, 7.5});
  expect_crossings(capsule, {{3, 0, 2}, {-1, 0, 0}}, {2.5, 3.5});
  expect_crossings(capsule, {{0.3, 0, 10}, {0, 0, -2}}, {2.8, 5.2});
  expect_crossings(capsule, {{0.5001, 0, 10}, {0, 0, -2}}, {});
}

// The silhouette of the tangent cone in the xz plane: half angle a with sin a = (r0 - r1) / L; at x = q + r n on the generator.
TEST(Witness, TaperedCapsuleIsTheTangentHull) {
  const Capsule capsule{{0, 0, 0}, {0, 0, 4}, 2, 1};
  const double k = 1.0 / 4, c = std::sqrt(1 - k * k);
  for (const double s : {0.1, 0.5, 0.9}) {
    const double r = 2 - s;
    const dvec3 n{c, 0, k}, p = dvec3{0, 0, 4 * s} + r * n;
    EXPECT_NEAR(value(capsule, p), 0, rounding);
    const auto found = closest(capsule, {p + 3.0 * n, -n});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->t, 3, 10 * rounding);
    EXPECT_FALSE(found->leaving);
    EXPECT_LT(glm::length(normal_at(capsule, p, 1e-5) - n), 1e-9);
  }
  // A ball inside the other adds nothing.
  expect_crossings(Capsule{{0, 0, 0}, {0, 0, 0.5}, 2, 1}, {{0, 0, -5}, {0, 0, 1}}, {3, 7});
  // A point at one end: a cone with a rounded base.
  expect_crossings(Capsule{{0, 0, 0}, {0, 0, 4}, 2, 0}, {{0, 0, -5}, {0, 0, 1}}, {3, 9});
}

TEST(Witness, TriangleAndDisk) {
  const Triangle triangle{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  expect_crossings(triangle, {{0.2, 0.3, 0}, {0, 0, 0.5}}, {2});
  expect_crossings(triangle, {{0.2, 0.3, 3}, {0, 0, -1}}, {2});
  expect_crossings(triangle, {{0.6, 0.5, 0}, {0, 0, 1}}, {});
  expect_crossings(triangle, {{0.2, 0.3, 1}, {1, 0, 0}}, {});
  EXPECT_NEAR(margin(triangle, {{0.2, 0.3, 0}, {0, 0, 1}}), 0.2, rounding);
  EXPECT_NEAR(margin(triangle, {{-0.2, 0.3, 0}, {0, 0, 1}}), -0.2, rounding);
  const Disk disk{{0, 0, 1}, {0, 0, -3}, 2};
  expect_crossings(disk, {{1, 1, 0}, {0, 0, 0.5}}, {2});
  expect_crossings(disk, {{1.5, 1.5, 0}, {0, 0, 0.5}}, {});
  EXPECT_NEAR(margin(disk, {{1, 0, 0}, {0, 0, 1}}), 1, 1e-9);
}

TEST(Witness, MarginIsTheDistanceToTangency) {
  const Capsule capsule{{0, 0, 0}, {0, 0, 4}, 0.5, 0.5};
  EXPECT_NEAR(margin(capsule, {{5, 0.3, 2}, {-1, 0, 0}}), 0.2, rounding);
  EXPECT_NEAR(margin(capsule, {{5, 0.7, 2}, {-1, 0, 0}}), -0.2, rounding);
}

// The solver uses convexity, the referee does not.
TEST(Witness, SolverAgreesWithReferee) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform;
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Capsule capsule{random_vector(random), random_vector(random), uniform(random), uniform(random)};
    const dvec3 origin = 4.0 * random_vector(random);
    const Ray ray{origin, 0.8 * random_vector(random) - origin};
    const auto found = crossings(capsule, ray);
    const double m = margin(capsule, ray);
    EXPECT_EQ(found.empty(), m < 0);
    if (std::abs(m) > 2e-5) {
      const Verdict verdict = referee(capsule, ray, 1e-5);
      EXPECT_EQ(verdict, found.empty() ? Verdict::miss : Verdict::hit);
    }
    for (const Crossing& crossing : found)
      EXPECT_NEAR(value(capsule, ray.origin + crossing.t * ray.direction), 0, 100 * rounding);
    hits += !found.empty();
  }
  EXPECT_GT(hits, 400);
  EXPECT_LT(hits, 1900);
}

TEST(Witness, UselessRaysMiss) {
  const double nan = std::nan(""), inf = HUGE_VAL;
  const Sphere sphere{{0, 0, 0}, 1};
  EXPECT_TRUE(crossings(sphere, {{nan, 0, 0}, {0, 0, 1}}).empty());
  EXPECT_TRUE(crossings(sphere, {{0, 0, 0}, {0, inf, 1}}).empty());
  EXPECT_TRUE(crossings(sphere, {{0, 0, 0}, {0, 0, 0}}).empty());
  EXPECT_FALSE(closest(sphere, {{0, 0, -3}, {0, 0, 1}, 4, inf}).has_value());
  EXPECT_TRUE(closest(sphere, {{0, 0, -3}, {0, 0, 1}, 2, inf})->leaving);
}

TEST(SceneWitness, InstancesKeepT) {
  Scene scene;
  Shape capsules;
  capsules.geometry = CapsulesShape{{{0, 0, 0}, {5, 0, 0}}, {{0, 0, 1}, {5, 0, 1}}, {0.5f, 0.5f}, {}, {}};
  scene.shapes.push_back(capsules);
  Shape sphere;
  sphere.geometry = SphereShape{1};
  sphere.world_from_object = glm::scale(glm::dmat4(1), {1, 1, 3});
  scene.objects.push_back({"ellipsoid", {sphere}, {}});
  scene.instances.push_back({0, glm::translate(glm::dmat4(1), {10, 0, 0}), {}});
  const SceneWitness witness(scene);
  EXPECT_EQ(witness.size(), 3u);
  const std::vector<Ray> rays = {
      {{5, 0, -9.5}, {0, 0, 2}}, {{10, 0, -13}, {0, 0, 2}}, {{-9, 0, 0}, {1, 0, 0}}, {{0, 0, 9}, {0, 1, 0}}};
  const auto hits = witness.closest(rays);
  ASSERT_TRUE(hits[0] && hits[1] && hits[2]);
  EXPECT_NEAR(hits[0]->t, 4.5, rounding);
  EXPECT_EQ(hits[0]->primitive, 1u);
  EXPECT_EQ(hits[0]->instance, no_instance);
  EXPECT_NEAR(hits[1]->t, 5, 10 * rounding);
  EXPECT_EQ(hits[1]->instance, 0u);
  EXPECT_NEAR(hits[2]->t, 8.5, 10 * rounding);
  EXPECT_FALSE(hits[3]);
}

}  // namespace
