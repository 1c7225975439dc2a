// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The reference on cases whose answer is known without it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <set>
#include <tuple>

#include "reference/scene_reference.h"
#include "reference/solver.h"

namespace {

using namespace caplet;
using namespace caplet::reference;
using caplet::reference::full_turn;
using glm::dvec3;

// Bisection ends at neighbouring doubles of an offset from the foot; t is then off by a few
// roundings of |t| and of the scene's size.
constexpr double rounding = 1e-13;

dvec3 random_vector(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return {normal(random), normal(random), normal(random)};
}

void expect_crossings(const Primitive& primitive, const Ray& ray,
                      std::initializer_list<double> expected) {
  const auto found = crossings(primitive, ray);
  ASSERT_EQ(found.size(), expected.size());
  std::size_t i = 0;
  for (const double t : expected) {
    EXPECT_NEAR(found[i].t, t, rounding * (1 + std::abs(t)) * 10);
    if (is_solid(primitive)) {
      EXPECT_EQ(found[i].leaving, i % 2 == 1);
    }
    ++i;
  }
}

struct Expected {
  double t;
  int surface;
  bool leaving;
};
void expect_surfaces(const Primitive& primitive, const Ray& ray,
                     std::initializer_list<Expected> expected) {
  const auto found = crossings(primitive, ray);
  ASSERT_EQ(found.size(), expected.size());
  std::size_t i = 0;
  for (const Expected& e : expected) {
    EXPECT_NEAR(found[i].t, e.t, rounding * (1 + std::abs(e.t)) * 10);
    EXPECT_EQ(found[i].surface, e.surface) << i;
    EXPECT_EQ(found[i].leaving, e.leaving) << i;
    ++i;
  }
}

TEST(Reference, SphereOnItsAxes) {
  expect_crossings(Sphere{{1, 2, 3}, 2}, {{1, 2, -7}, {0, 0, 1}}, {8, 12});
  expect_crossings(Sphere{{1, 2, 3}, 2}, {{1, 2, -7}, {0, 0, 4}}, {2, 3});
  expect_crossings(Sphere{{1, 2, 3}, 2}, {{1, 2, -7}, {0, 0, -0.5}}, {-24, -16});
  expect_crossings(Sphere{{1, 2, 3}, 2}, {{3.0001, 2, -7}, {0, 0, 1}}, {});
}

TEST(Reference, CapsuleAlongAndAcross) {
  const Capsule capsule{{0, 0, 0}, {0, 0, 4}, 0.5, 0.5};
  expect_crossings(capsule, {{0, 0, -3}, {0, 0, 1}}, {2.5, 7.5});
  expect_crossings(capsule, {{3, 0, 2}, {-1, 0, 0}}, {2.5, 3.5});
  expect_crossings(capsule, {{0.3, 0, 10}, {0, 0, -2}}, {2.8, 5.2});
  expect_crossings(capsule, {{0.5001, 0, 10}, {0, 0, -2}}, {});
}

// The silhouette of the tangent cone in the xz plane: half angle a with sin a = (r0 - r1) / L; at x
// = q + r n on the generator.
TEST(Reference, TaperedCapsuleIsTheTangentHull) {
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

TEST(Reference, TriangleAndDisk) {
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
  // Almost in the disk's plane and almost a tangent of its rim, 5.33e-6 from it at the crossing:
  // two minima close to each other.
  const Disk flat{{0x1.d5a414p-3, -0x1.0859dap+3, 0x1.f633e8p+3},
                  {0x1.46e11ep-2, -0x1.1177eap-2, 0x1.d18c5ep-1},
                  0x1.855672p+2};
  const Ray grazing{{-14.949357741319, 11.799509225158, 26.938185622453},
                    {19.115298806774, -15.422550404783, -11.264191443461}};
  const auto crossed = crossings(flat, grazing);
  ASSERT_EQ(crossed.size(), 1u);
  const double inside =
      flat.radius - glm::length(grazing.origin + crossed[0].t * grazing.direction - flat.center);
  EXPECT_NEAR(inside, 5.33e-6, 1e-8);
  EXPECT_LE(margin(flat, grazing), inside);
}

TEST(Reference, OpenShapesSayWhetherTheRayGoesAlongTheNormal) {
  const Triangle triangle{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  expect_surfaces(triangle, {{0.2, 0.3, 0}, {0, 0, 0.5}}, {{2, 0, true}});
  expect_surfaces(triangle, {{0.2, 0.3, 3}, {0, 0, -1}}, {{2, 0, false}});
  expect_surfaces(Disk{{0, 0, 1}, {0, 0, -3}, 2}, {{1, 1, 0}, {0, 0, 0.5}}, {{2, 0, false}});
  const PartialDisk ring{1, 2, 1, 2 * 1.5707963267948966};
  expect_surfaces(ring, {{0.5, 1.4, 0}, {0, 0, 1}}, {{1, 0, true}});
  expect_surfaces(ring, {{0.5, 1.4, 3}, {0, 0, -1}}, {{2, 0, false}});
  expect_surfaces(ring, {{0.5, 0.4, 0}, {0, 0, 1}}, {});
  expect_surfaces(ring, {{0.5, -1.4, 0}, {0, 0, 1}}, {});
  EXPECT_NEAR(margin(ring, {{0, 1.3, 0}, {0, 0, 1}}), 0.3, 1e-9);
  EXPECT_NEAR(margin(ring, {{1.5, 0.1, 0}, {0, 0, 1}}), 0.1, 1e-9);
  EXPECT_NEAR(value(ring, {0, 0.5, 1}), 0.5, rounding);
}

TEST(Reference, CylindersAndCones) {
  const auto cylinder = [](bool round0, bool open0, bool round1, bool open1) {
    return make_frustum({0, 0, 0}, {0, 0, 4}, {1, round0, open0}, {1, round1, open1});
  };
  const Ray along{{0.6, 0, -2}, {0, 0, 1}}, across{{-3, 0, 2}, {2, 0, 0}};
  expect_surfaces(cylinder(false, false, false, false), along, {{2, 1, false}, {6, 2, true}});
  expect_surfaces(cylinder(true, false, true, false), along, {{1.2, 1, false}, {6.8, 2, true}});
  expect_surfaces(cylinder(false, true, true, false), along, {{6.8, 2, true}});
  expect_surfaces(cylinder(false, true, false, true), along, {});
  expect_surfaces(cylinder(false, false, true, false), across, {{1, 0, false}, {2, 0, true}});
  // In at the side, out at the cap.
  expect_surfaces(cylinder(false, false, false, false), {{-3, 0, 1}, {1, 0, 1}},
                  {{2, 0, false}, {3, 2, true}});
  expect_surfaces(cylinder(false, true, false, true), {{-3, 0, 1}, {1, 0, 1}}, {{2, 0, false}});

  // A frustum whose side has slope 1, and its apex.
  const Frustum frustum = make_frustum({0, 0, 0}, {0, 0, 2}, {3, false, false}, {1, false, false});
  expect_surfaces(frustum, {{-5, 0, 1}, {1, 0, 0}}, {{3, 0, false}, {7, 0, true}});
  expect_surfaces(frustum, {{2, 0, 5}, {0, 0, -1}}, {{4, 0, false}, {5, 1, true}});
  const Frustum cone = make_frustum({0, 0, 0}, {0, 0, 2}, {2, false, false}, {0, false, false});
  expect_surfaces(cone, {{0, 0, 5}, {0, 0, -1}}, {{3, 0, false}, {5, 1, true}});
  EXPECT_NEAR(value(cone, {0, 0, 3}), 1, rounding);
  EXPECT_NEAR(value(cone, {2, 0, 1}), std::sqrt(0.5), rounding);

  // Round ends of two radii: the tapered capsule.
  const Capsule tapered{{0, 0, 0}, {0, 0, 4}, 2, 1};
  const Frustum same = make_frustum(tapered.p0, tapered.p1, {2, true, false}, {1, true, false});
  std::mt19937 random(3);
  for (int i = 0; i < 1000; ++i) {
    const dvec3 x = 3.0 * random_vector(random);
    // Outside both are the distance.
    if (value(tapered, x) > 0) {
      EXPECT_NEAR(value(same, x), value(tapered, x), 1e-12);
    } else {
      EXPECT_LE(value(same, x), 1e-12);
    }
  }
}

// The hull of a disk and a ball, by its definition: points between a point of the one and a point
// of the other.
TEST(Reference, MixedEndsAreTheHullOfADiskAndABall) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform;
  for (const auto& [disk, ball, length] : {std::tuple(2.0, 1.0, 3.0),
                                           {1.0, 2.0, 3.0},
                                           {1.0, 1.0, 0.5},
                                           {0.0, 1.0, 2.0},
                                           {3.0, 2.0, 1.0}}) {
    const Frustum frustum =
        make_frustum({0, 0, 0}, {0, 0, length}, {disk, false, false}, {ball, true, false});
    double greatest = -HUGE_VAL;
    for (int i = 0; i < 100000; ++i) {
      const double a = full_turn * uniform(random);
      const dvec3 p = disk * dvec3(std::cos(a), std::sin(a), 0);
      const dvec3 q = dvec3(0, 0, length) + ball * glm::normalize(random_vector(random));
      greatest = std::max(greatest, value(frustum, p + uniform(random) * (q - p)));
    }
    EXPECT_LE(greatest, 1e-12);
    // And no larger: a plane that touches the frustum touches the disk or the ball.
    for (int i = 0; i < 1000; ++i) {
      const dvec3 n = glm::normalize(random_vector(random));
      const double support = std::max(disk * std::hypot(n.x, n.y), n.z * length + ball);
      for (int k = 0; k < 10; ++k) {
        const dvec3 x = (1 + std::abs(uniform(random))) * support * n +
                        3.0 * glm::cross(n, random_vector(random));
        if (glm::dot(n, x) > support) {
          EXPECT_GE(value(frustum, x), glm::dot(n, x) - support - 1e-12);
        }
      }
    }
  }
}

TEST(Reference, BoxesAndPolyhedra) {
  const Box box{{{-1, -2, -3}, {1, 2, 3}}};
  expect_surfaces(box, {{-5, 0.5, 0.5}, {2, 0, 0}}, {{2, 0, false}, {3, 1, true}});
  expect_surfaces(box, {{0.5, 5, 0.5}, {0, -1, 0}}, {{3, 3, false}, {7, 2, true}});
  expect_surfaces(box, {{0.5, 0.5, -5}, {0, 0.25, 1}}, {{2, 4, false}, {6, 3, true}});
  const std::vector<dvec3> normals = {{-1, 0, 0}, {0, -2, 0}, {0, 0, -1}, {1, 1, 1}};
  const std::vector<double> offsets = {0, 0, 0, 1};
  const Polyhedron tetrahedron = make_polyhedron({1, 1, 1}, normals, offsets);
  EXPECT_GE(tetrahedron.ball_radius, std::sqrt(0.5));
  EXPECT_LT(tetrahedron.ball_radius, 1);
  expect_surfaces(tetrahedron, {{0, 1.25, 1.25}, {1, 0, 0}}, {{1, 0, false}, {1.5, 3, true}});
  expect_surfaces(tetrahedron, {{1.25, 0, 1.25}, {0, 1, 0}}, {{1, 1, false}, {1.5, 3, true}});
}

TEST(Reference, PartsOfSpheresAndTubes) {
  const PartialSphere sphere{2, -1, 1.5, 4.71238898038469};
  expect_surfaces(sphere, {{-5, 0.1, 0}, {1, 0, 0}},
                  {{5 - std::sqrt(4 - 0.01), 0, false}, {5 + std::sqrt(4 - 0.01), 0, true}});
  expect_surfaces(sphere, {{-5, -0.1, 0}, {1, 0, 0}}, {{5 - std::sqrt(4 - 0.01), 0, false}});
  expect_surfaces(sphere, {{0.1, 0, -5}, {0, 0, 1}}, {});
  EXPECT_NEAR(value(sphere, {0, 0, 2}), std::hypot(std::sqrt(4 - 2.25), 0.5), rounding);
  EXPECT_NEAR(margin(sphere, {{-5, 0.1, 1.4}, {1, 0, 0}}), 0.1, 1e-9);
  const OpenCylinder tube{1, -1, 2, 4.71238898038469};
  expect_surfaces(tube, {{-5, 0.6, 0}, {1, 0, 0}}, {{4.2, 0, false}, {5.8, 0, true}});
  expect_surfaces(tube, {{-5, -0.6, 0}, {1, 0, 0}}, {{4.2, 0, false}});
  expect_surfaces(tube, {{-5, 0.6, 2.5}, {1, 0, 0}}, {});
  expect_surfaces(tube, {{0.5, 0, -5}, {0, 0, 1}}, {});
  EXPECT_NEAR(value(tube, {3, 0, 4}), std::sqrt(8), rounding);
}

TEST(Reference, MarginsOfOpenShapesAreDistancesToTheirBoundary) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> within(-1.3, 1.3);
  const PartialDisk sector{0, 1, 0.4, 2};
  for (int i = 0; i < 200; ++i) {
    const dvec3 p(within(random), within(random), 0);
    const double rho = glm::length(p), phi = std::atan2(p.y, p.x);
    const bool between = phi >= 0 && phi <= 2;
    double distance = HUGE_VAL;
    for (const double angle : {0.0, 2.0}) {
      const dvec3 along(std::cos(angle), std::sin(angle), 0);
      distance =
          std::min(distance, glm::length(p - std::clamp(glm::dot(p, along), 0.4, 1.0) * along));
    }
    for (const double arc : {0.4, 1.0})
      if (between) distance = std::min(distance, std::abs(rho - arc));
    const bool inside = between && rho >= 0.4 && rho <= 1;
    EXPECT_NEAR(margin(sector, {p - dvec3(0, 0, 3), {0, 0, 1}}), inside ? distance : -distance,
                1e-12)
        << p.x << ", " << p.y;
  }
  // Along (1, 1, 0) z = x y folds at the parabola z = -a^2 / 2, with a the place across the ray.
  const Bilinear saddle{{-1, -1, 1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, 1}};
  for (int i = 0; i < 200; ++i) {
    const double z = std::uniform_real_distribution<double>(-0.9, 0.35)(random);
    EXPECT_NEAR(margin(saddle, {{-2, -2, z}, {1, 1, 0}}), z, 1e-9);
  }
}

// Along this line the torus' value has a greatest and a least value 1/500 apart, both within 4e-9.
TEST(Reference, LinesThatFollowATorusNearlyTouchIt) {
  const MolecularPatch torus{{0, 0, 0},
                             0.73492853722728346,
                             0.9711319765310682,
                             false,
                             {},
                             {0, 0, 1},
                             {1, 0, 0},
                             full_turn,
                             3.34,
                             3.8,
                             {0, 0, 0},
                             1.8};
  const dvec3 origin(0.09268526, 0.30497208, -0.13677463),
      direction(-0.7600724, -0.05923139, -0.64713336);
  EXPECT_LE(std::abs(margin(torus, {origin, direction})), 1e-7);
}

TEST(Reference, BilinearPatches) {
  // z = x y: two crossings of a line along (1, -1) below, where x y is concave.
  const Bilinear saddle{{-1, -1, 1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, 1}};
  expect_surfaces(saddle, {{0.5, 0.25, -3}, {0, 0, 1}}, {{3.125, 0, true}});
  expect_surfaces(saddle, {{0.5, 0.25, 3}, {0, 0, -1}}, {{2.875, 0, false}});
  expect_surfaces(saddle, {{-0.8, 0.8, -0.25}, {1, -1, 0}}, {{0.3, 0, false}, {1.3, 0, true}});
  expect_surfaces(saddle, {{-0.8, 0.8, 0.25}, {1, -1, 0}}, {});
  EXPECT_NEAR(margin(saddle, {{-0.8, 0.8, 0.02}, {1, -1, 0}}), -0.02, 1e-6);
  EXPECT_NEAR(margin(saddle, {{0.75, 0.5, -3}, {0, 0, 1}}), 0.25, 1e-9);
  EXPECT_NEAR(value(saddle, {0.5, 0.25, 0.125}), 0, 1e-12);
  EXPECT_NEAR(value(saddle, {1, 1, 3}), 2, 1e-9);
  // A parallelogram.
  const Bilinear flat{{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {3, 1, 0}};
  expect_surfaces(flat, {{1.25, 0.5, -1}, {0, 0, 1}}, {{1, 0, true}});
  expect_surfaces(flat, {{0.25, 0.5, -1}, {0, 0, 1}}, {});
  expect_surfaces(flat, {{-4, 0.5, 0}, {1, 0, 0}}, {});
}

// However sharply a patch is folded: its own points are no distance from it, and no other of its
// points is nearer than that.
TEST(Reference, DistanceFromFoldedPatches) {
  // Where two extremes meet, rounding of the squared distance (2^-52) may hide them.
  constexpr double hidden = 0x1p-26;
  std::mt19937 random(8);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 3000; ++i) {
    Bilinear patch{random_vector(random), random_vector(random), random_vector(random),
                   random_vector(random)};
    // Opposite corners, or neighbours, nearly the same.
    const double fold = std::pow(10, -6 * share(random));
    if (i % 3 == 0) patch.p11 = patch.p00 + fold * (patch.p11 - patch.p00);
    if (i % 3 == 1) patch.p10 = patch.p00 + fold * (patch.p10 - patch.p00);
    const auto at = [&](double u, double v) {
      return (1 - u) * ((1 - v) * patch.p00 + v * patch.p01) +
             u * ((1 - v) * patch.p10 + v * patch.p11);
    };
    const double u = i % 2 == 0 ? share(random) : 0.5 + 0.01 * (share(random) - 0.5),
                 v = i % 2 == 0 ? share(random) : u;
    const dvec3 x = at(u, v), off = x + std::pow(10, -4 * share(random)) * random_vector(random);
    EXPECT_LT(value(patch, x), hidden) << i;
    const double distance = value(patch, off);
    for (int k = 0; k < 200; ++k)
      ASSERT_LE(distance, glm::length(off - at(share(random), share(random))) + hidden) << i;
    ASSERT_LE(distance, glm::length(off - x) + hidden) << i;
  }
}

// Away from edges the gradient says the same; beside one it is that of the surface asked for,
// however close the other is.
TEST(Reference, NormalsOfSurfaces) {
  const Frustum cone = make_frustum({0, 0, 0}, {0, 0, 3}, {2, false, false}, {1, false, false});
  const Frustum bullet = make_frustum({1, 0, 0}, {5, 0, 0}, {1, false, false}, {2, true, false});
  const Box box{{{-1, -2, -3}, {1, 2, 3}}};
  const std::array normals = {dvec3(0, 0, 2), dvec3(3, 0, -1), dvec3(-1, 2, -1), dvec3(-1, -2, -1)};
  const std::array offsets = {1.0, 1.0, 1.0, 1.0};
  const Polyhedron wedge = make_polyhedron({1, 1, 1}, normals, offsets);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (const Primitive& primitive :
       {Primitive(cone), Primitive(bullet), Primitive(box), Primitive(wedge)}) {
    const Ball ball = bounding_ball(primitive);
    std::set<int> seen;
    for (int i = 0; i < 2000; ++i) {
      const auto point = [&] {
        return ball.center +
               ball.radius * dvec3(coordinate(random), coordinate(random), coordinate(random));
      };
      const dvec3 a = point(), b = point();
      for (const Crossing& hit : crossings(primitive, {a, b - a})) {
        const dvec3 x = a + hit.t * (b - a);
        if (surface_at(primitive, x).margin < 1e-4) continue;
        seen.insert(hit.surface);
        EXPECT_LT(glm::length(normal_of_surface(primitive, x, hit.surface, 1e-6) -
                              normal_at(primitive, x, 1e-6)),
                  1e-6);
      }
    }
    EXPECT_EQ(seen.size(), static_cast<std::size_t>(surface_count(primitive)));
  }
  const dvec3 rim{2, 0, 1e-9}, side = glm::normalize(dvec3(3, 0, 1));
  EXPECT_LT(glm::length(normal_of_surface(cone, rim, 0, 1e-3) - side), 1e-12);
  EXPECT_LT(glm::length(normal_of_surface(cone, rim, 1, 1e-3) - dvec3(0, 0, -1)), 1e-12);
  EXPECT_LT(glm::length(normal_of_surface(box, {1, 2, 3}, 3, 1e-3) - dvec3(0, 1, 0)), 1e-12);
  EXPECT_LT(
      glm::length(normal_of_surface(Sphere{{1, 0, 0}, 2}, {3, 0, 0}, 0, 1e-3) - dvec3(1, 0, 0)),
      1e-9);
}

TEST(Reference, CsgByMembership) {
  const auto moved = [](const dvec3& by) { return glm::translate(glm::dmat4(1), by); };
  const Csg lens = make_csg(Csg::Operation::set_intersection,
                            std::vector<CsgPart>{{Sphere{{0, 0, 0}, 2}, moved({0, 0, -1})},
                                                 {Sphere{{0, 0, 0}, 2}, moved({0, 0, 1})}});
  expect_surfaces(lens, {{0, 0, -5}, {0, 0, 1}}, {{4, 1, false}, {6, 0, true}});
  expect_surfaces(lens, {{1.8, 0, -5}, {0, 0, 1}}, {});
  const Csg hollow = make_csg(
      Csg::Operation::set_difference,
      std::vector<CsgPart>{{Box{{{-2, -2, -2}, {2, 2, 2}}}, glm::dmat4(1)}, {lens, glm::dmat4(1)}});
  EXPECT_EQ(surface_count(hollow), 8);
  expect_surfaces(hollow, {{0, 0, -5}, {0, 0, 1}},
                  {{3, 4, false}, {4, 7, true}, {6, 6, false}, {7, 5, true}});
  EXPECT_LT(glm::length(normal_at(hollow, {0, 0, -1}, 1e-6) - dvec3(0, 0, 1)), 1e-6);
  // Touching capsules: no inner surface.
  const Csg chain = make_csg(Csg::Operation::set_union,
                             std::vector<CsgPart>{{Box{{{0, 0, 0}, {1, 1, 1}}}, glm::dmat4(1)},
                                                  {Box{{{0, 0, 0}, {1, 1, 1}}}, moved({1, 0, 0})}});
  expect_surfaces(chain, {{-1, 0.5, 0.5}, {1, 0, 0}}, {{1, 0, false}, {3, 7, true}});
}

// All sign changes of the value, by excluding intervals that a 1-Lipschitz function cannot change
// sign in: no use is made of the operands' own crossings.
TEST(Reference, CsgCrossingsAreTheSignChangesOfTheValue) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform;
  int crossed = 0;
  for (int i = 0; i < 300; ++i) {
    std::vector<CsgPart> parts;
    for (int k = 0; k < 4; ++k) {
      const glm::dmat4 m =
          glm::scale(glm::rotate(glm::translate(glm::dmat4(1), 0.7 * random_vector(random)),
                                 6 * uniform(random), glm::normalize(random_vector(random))),
                     dvec3(0.3 + uniform(random), 0.3 + uniform(random), 0.3 + uniform(random)));
      const Primitive primitive =
          k == 0   ? Primitive(Box{{{-1, -1, -1}, {1, 1, 1}}})
          : k == 1 ? Primitive(Sphere{})
          : k == 2 ? Primitive(make_frustum({0, 0, -1}, {0, 0, 1}, {1, false, false},
                                            {0.5, false, false}))
                   : Primitive(Capsule{{0, 0, -1}, {0, 0, 1}, 0.5, 0.3});
      parts.push_back({primitive, m});
    }
    const auto operation = [&] { return static_cast<Csg::Operation>(i / 7 % 3); };
    const Csg inner = make_csg(operation(), std::vector<CsgPart>(parts.begin(), parts.begin() + 2));
    parts.erase(parts.begin(), parts.begin() + 2);
    parts.push_back({inner, glm::dmat4(1)});
    const Csg csg = make_csg(static_cast<Csg::Operation>(i % 3), parts);
    for (int r = 0; r < 10; ++r) {
      const dvec3 origin = 6.0 * glm::normalize(random_vector(random));
      const Ray ray{origin, glm::normalize(0.7 * random_vector(random) - origin)};
      const auto f = [&](double t) { return value(csg, origin + t * ray.direction); };
      std::vector<double> roots;
      const std::function<void(double, double)> search = [&](double a, double b) {
        const double middle = 0.5 * (a + b);
        if (std::abs(f(middle)) > 0.5 * (b - a)) return;
        if (b - a > 1e-5) {
          search(a, middle);
          search(middle, b);
        } else if ((f(a) > 0) != (f(b) > 0)) {
          const bool falls = f(a) > 0;
          for (int n = 0; n < 60; ++n) {
            const double half = 0.5 * (a + b);
            ((f(half) > 0) == falls ? a : b) = half;
          }
          roots.push_back(a);
        }
      };
      search(0, 16);
      const auto found = crossings(csg, ray);
      ASSERT_EQ(found.size(), roots.size()) << i << " " << r;
      for (std::size_t k = 0; k < roots.size(); ++k) EXPECT_NEAR(found[k].t, roots[k], 1e-11);
      crossed += !found.empty();
    }
  }
  EXPECT_GT(crossed, 500);
}

TEST(Reference, MarginIsTheDistanceToTangency) {
  const Capsule capsule{{0, 0, 0}, {0, 0, 4}, 0.5, 0.5};
  EXPECT_NEAR(margin(capsule, {{5, 0.3, 2}, {-1, 0, 0}}), 0.2, rounding);
  EXPECT_NEAR(margin(capsule, {{5, 0.7, 2}, {-1, 0, 0}}), -0.2, rounding);
}

// The solver uses convexity, the referee does not.
TEST(Reference, SolverAgreesWithReferee) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform;
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Capsule capsule{random_vector(random), random_vector(random), uniform(random),
                          uniform(random)};
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

TEST(Reference, UselessRaysMiss) {
  const double nan = std::nan(""), inf = HUGE_VAL;
  const Sphere sphere{{0, 0, 0}, 1};
  EXPECT_TRUE(crossings(sphere, {{nan, 0, 0}, {0, 0, 1}}).empty());
  EXPECT_TRUE(crossings(sphere, {{0, 0, 0}, {0, inf, 1}}).empty());
  EXPECT_TRUE(crossings(sphere, {{0, 0, 0}, {0, 0, 0}}).empty());
  EXPECT_FALSE(closest(sphere, {{0, 0, -3}, {0, 0, 1}, 4, inf}).has_value());
  EXPECT_TRUE(closest(sphere, {{0, 0, -3}, {0, 0, 1}, 2, inf})->leaving);
}

TEST(SceneReference, InstancesKeepT) {
  Scene scene;
  Shape capsules;
  capsules.geometry =
      CapsulesShape{{{0, 0, 0}, {5, 0, 0}}, {{0, 0, 1}, {5, 0, 1}}, {0.5f, 0.5f}, {}, {}};
  scene.shapes.push_back(capsules);
  Shape sphere;
  sphere.geometry = SphereShape{1};
  sphere.world_from_object = glm::scale(glm::dmat4(1), {1, 1, 3});
  scene.objects.push_back({"ellipsoid", {sphere}, {}});
  scene.instances.push_back({0, glm::translate(glm::dmat4(1), {10, 0, 2}), {}});
  const SceneReference reference(scene);
  EXPECT_EQ(reference.size(), 3u);
  const std::vector<Ray> rays = {{{5, 0, -9.5}, {0, 0, 2}},
                                 {{10, 0, -13}, {0, 0, 2}},
                                 {{-9, 0, 0}, {1, 0, 0}},
                                 {{0, 0, 9}, {0, 1, 0}}};
  const auto hits = reference.closest(rays);
  ASSERT_TRUE(hits[0] && hits[1] && hits[2]);
  EXPECT_NEAR(hits[0]->t, 4.5, rounding);
  EXPECT_EQ(hits[0]->primitive, 1u);
  EXPECT_EQ(hits[0]->instance, no_instance);
  EXPECT_NEAR(hits[1]->t, 6, 10 * rounding);
  EXPECT_EQ(hits[1]->instance, 0u);
  EXPECT_NEAR(hits[2]->t, 8.5, 10 * rounding);
  EXPECT_FALSE(hits[3]);
}

TEST(SceneReference, SurfacesMaterialsAndNormals) {
  Scene scene;
  Shape box;
  box.geometry = BoxShape{{-1, -1, -1}, {1, 1, 1}};
  box.materials = {10, 11, 12, 13, 14, 15};
  Shape sphere;
  sphere.geometry = SphereShape{0.5};
  sphere.material = 20;
  sphere.world_from_object = glm::translate(glm::dmat4(1), {1, 0, 0});
  Shape bitten;
  bitten.geometry =
      CsgShape{CsgShape::Operation::set_difference,
               {std::make_shared<const Shape>(box), std::make_shared<const Shape>(sphere)}};
  scene.objects.push_back({"bitten", {bitten}, {}});
  // Mirrored in x, twice as long in z.
  scene.instances.push_back(
      {0, glm::scale(glm::translate(glm::dmat4(1), {5, 0, 0}), {-1, 1, 2}), {}});
  Shape tube;
  tube.geometry = OpenCylinderShape{1, -1, 1, caplet::full_turn};
  tube.material = 30;
  tube.one_sided = true;
  tube.reverse_orientation = true;
  scene.shapes.push_back(tube);
  const SceneReference reference(scene);

  const Ray ray{{-9, 0, 0.1}, {2, 0, 0}};
  const auto hits = reference.all(ray);
  // The tube is seen from inside alone, then the bite, which is its sphere's inside, then the far
  // face: that of the least x.
  ASSERT_EQ(hits.size(), 3u);
  EXPECT_NEAR(hits[0].t, 5, rounding);
  EXPECT_EQ(hits[0].material, 30u);
  EXPECT_TRUE(hits[0].leaving);
  EXPECT_LT(glm::length(reference.normal(hits[0], {1, 0, 0.1}) - dvec3(-1, 0, 0)), 1e-9);
  const double chord = std::sqrt(0.25 - 0.05 * 0.05);
  EXPECT_NEAR(hits[1].t, (9 + 4 + chord) / 2, 10 * rounding);
  EXPECT_EQ(hits[1].surface, 6u);
  EXPECT_EQ(hits[1].material, 20u);
  EXPECT_EQ(hits[1].instance, 0u);
  EXPECT_FALSE(hits[1].leaving);
  // The normal is that of the ellipsoid with half axes 1/2 and 1, into its middle.
  EXPECT_LT(glm::length(reference.normal(hits[1], {4 + chord, 0, 0.1}) +
                        glm::normalize(dvec3(chord / 0.25, 0, 0.1 / 1.0))),
            1e-6);
  EXPECT_NEAR(hits[2].t, (9 + 6) / 2.0, 10 * rounding);
  EXPECT_EQ(hits[2].surface, 0u);
  EXPECT_EQ(hits[2].material, 10u);
  EXPECT_LT(glm::length(reference.normal(hits[2], {6, 0, 0.1}) - dvec3(1, 0, 0)), 1e-9);

  EXPECT_EQ(reference.all(ray, 2).size(), 2u);
  const auto first = reference.closest(ray);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->t, hits[0].t);
}

}  // namespace
