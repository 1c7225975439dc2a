// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// uv of capsules with u at their ends, against what pbrt's curves have, in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <random>

#include "floats.h"
#include "scene_probe.h"

namespace caplet::test {
namespace {

using glm::dmat4;
using glm::dvec2;
using glm::dvec3;

using std::numbers::pi;

RayRecord ray_of(const dvec3& o, const dvec3& d) {
  return {static_cast<float>(o.x), static_cast<float>(o.y), static_cast<float>(o.z), 0,
          static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z), INFINITY};
}
dvec3 origin(const RayRecord& ray) { return {ray.ox, ray.oy, ray.oz}; }
dvec3 direction(const RayRecord& ray) { return {ray.dx, ray.dy, ray.dz}; }

void push(CapsulesShape& to, const dvec3& p0, const dvec3& p1, double r0, double r1, double u0,
          double u1) {
  to.p0.emplace_back(p0);
  to.p1.emplace_back(p1);
  to.radius0.push_back(static_cast<float>(r0));
  to.radius1.push_back(static_cast<float>(r1));
  to.u.emplace_back(u0, u1);
}

/// A circle of radius 1 around the origin, as chords of one angle; u is the angle over a full turn.
constexpr int chords = 12;
constexpr double tube = 0.1;
CapsulesShape ring() {
  CapsulesShape out;
  const auto at = [](int i) {
    return dvec3(std::cos(2 * pi * i / chords), std::sin(2 * pi * i / chords), 0);
  };
  for (int i = 0; i < chords; ++i)
    push(out, at(i), at(i + 1), tube, tube, double(i) / chords, double(i + 1) / chords);
  return out;
}

// Rays towards the ring's centre, from outside, meet a chord's tube at a distance of h + r from the
// middle of the chord's plane, or a ball at a joint, where u is the joint's.
TEST(Chains, UOfARingIsThatOfItsChordsAndJoints) {
  // Behind other shapes, of which one has numbers in the same list.
  CapsulesShape before;
  push(before, {0, 0, 50}, {0, 0, 51}, 0.1, 0.1, 8, 9);
  const FlatScene scene =
      lower_shapes({shape_of(SphereShape{0.1}), shape_of(before), shape_of(ring())});
  EXPECT_TRUE(scene.has_chains);
  std::vector<RayRecord> rays;
  std::vector<double> expected;
  int joints = 0;
  constexpr int steps = 5000;
  for (int i = 0; i < steps; ++i) {
    const double angle = 2 * pi * (i + 0.5) / steps, width = 2 * pi / chords;
    const int chord = static_cast<int>(angle / width);
    const double along = std::tan(angle - (chord + 0.5) * width) * (std::cos(width / 2) + tube),
                 half = std::sin(width / 2);
    // Where the ball of the next chord rises above the tube by less than rounding, some 8 eps of 3,
    // either is met: x^2 / (2 r) for a way x. Where the ring closes, u is 0 and 1.
    if (std::abs(std::abs(along) - half) < 6e-4 ||
        (std::abs(along) > half && std::abs(angle - pi) > 3))
      continue;
    joints += std::abs(along) > half;
    expected.push_back((chord + std::clamp(0.5 + along / (2 * half), 0.0, 1.0)) / chords);
    rays.push_back(ray_of(dvec3(3 * std::cos(angle), 3 * std::sin(angle), 0),
                          -dvec3(std::cos(angle), std::sin(angle), 0)));
  }
  ASSERT_GT(joints, steps / 20);
  const std::vector<SceneHit> hits = trace(scene, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(hits[i].found, 1u) << i;
    // The point is off by its error, of a piece that is 0.5 long; the ray's direction by eps, over
    // a way of 3.
    EXPECT_NEAR(hits[i].u, expected[i], (double(hits[i].error) + 8 * eps) / 0.5 / chords + 4 * eps)
        << i;
    EXPECT_NEAR(hits[i].v, 0.5, 1e-6) << i;
  }
}

// Where tubes of different lengths, radii and rates meet, the balls of both have the same number,
// to the bit.
TEST(Chains, NeighboursAgreeAtTheirJoint) {
  const dvec3 joint(0.3, -0.2, 0.7);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const auto any = [&] { return dvec3(normal(random), normal(random), normal(random)); };
  const float u = 0.1f;  // 0.7 + 0.1f (0.3f - 0.7f) and the like are rounded
  for (int side = 0; side < 2; ++side) {
    CapsulesShape one;
    if (side == 0)
      push(one, {-1.1, 0.4, 0.1}, joint, 0.31, 0.2, 0.7, u);
    else
      push(one, joint, {1.3, 0.5, -0.4}, 0.2, 0.07, u, -0.43);
    const dvec3 axis =
        glm::normalize(dvec3(one.p1[0]) - dvec3(one.p0[0])) * (side == 0 ? 1.0 : -1.0);
    std::vector<RayRecord> rays;
    for (int i = 0; i < 2000; ++i) {
      const dvec3 n = glm::normalize(any());
      // On the cap, beyond the tangent cone's rim, whose height is below 0.2.
      if (glm::dot(n, axis) > 0.25) rays.push_back(ray_of(joint + 0.9 * n, -n));
    }
    const std::vector<SceneHit> hits = trace(lower_shapes({shape_of(one)}), rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(hits[i].found, 1u);
      ASSERT_EQ(hits[i].u, u) << side << " " << i;
      ASSERT_GT(glm::length(vec(hits[i].dpdu)), 0);
    }
    EXPECT_GT(rays.size(), 500u);
  }
}

/// pbrt-v4's v: by the distance of the ray from the axis, over the width, in the space of the
/// curve.
double v_of_pbrt(const dvec3& o, const dvec3& d, const dvec3& on_axis, const dvec3& axis,
                 double radius) {
  return 0.5 + glm::dot(o - on_axis, glm::normalize(glm::cross(d, axis))) / (2 * radius);
}

// A straight chain of three pieces of any lengths, from all sides: u is where the point lies along
// it, v pbrt's.
TEST(Chains, UvOfAStraightTubeAreThoseOfPbrtsCurve) {
  const dvec3 begin(-0.4, 0.3, 0.2), axis = glm::normalize(dvec3(2, -1, 2));
  CapsulesShape chain;
  const double stops[] = {0, 0.5, 2, 3};
  for (int i = 0; i < 3; ++i)
    push(chain, begin + stops[i] * axis, begin + stops[i + 1] * axis, 0.2, 0.2, stops[i] / 3,
         stops[i + 1] / 3);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal;
  std::vector<RayRecord> rays;
  for (int i = 0; i < 4000; ++i) {
    const dvec3 from = 4.0 * glm::normalize(dvec3(normal(random), normal(random), normal(random)));
    const dvec3 to = begin + (0.3 + 2.4 * uniform(random)) * axis +
                     0.19 * (2 * uniform(random) - 1) * glm::normalize(glm::cross(axis, from));
    rays.push_back(ray_of(from, (to - from) * (0.1 + uniform(random))));
  }
  const FlatScene flat = lower_shapes({shape_of(chain)});
  const std::vector<SceneHit> hits = trace(flat, rays);
  int met = 0;
  double least = 1, most = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].found == 0) continue;
    const dvec3 p = vec(hits[i].p), o = origin(rays[i]), d = glm::normalize(direction(rays[i]));
    const double along = glm::dot(p - begin, axis), sine = glm::length(glm::cross(d, axis));
    if (along < 0 || along > 3 || sine < 0.1) continue;
    ++met;
    // Ends are rounded to floats: by eps of 3 at most over a length of 0.5.
    EXPECT_NEAR(hits[i].u, along / 3, double(hits[i].error) + 8 * eps) << i;
    // The ray's distance from the axis is off by eps of some 4 to a side, which is 10 of the tube;
    // where it touches the tube, the point's own distance from the axis counts.
    EXPECT_NEAR(hits[i].v, v_of_pbrt(o, d, begin, axis, 0.2),
                (double(hits[i].error) + 16 * eps) / 0.2 / sine)
        << i;
    least = std::min(least, double(hits[i].v));
    most = std::max(most, double(hits[i].v));
  }
  EXPECT_GT(met, 2000);
  EXPECT_LT(least, 0.1);
  EXPECT_GT(most, 0.9);
}

// Steps of a ray to the side are steps of u and v along the derivatives, up to the squares of them.
TEST(Chains, DerivativesMatchDifferences) {
  CapsulesShape chain;
  push(chain, {0, 0, 0}, {0, 0, 2}, 0.5, 0.3, 0.25, 0.75);
  const FlatScene flat = lower_shapes({shape_of(chain)});
  const double h = 1.0 / 256;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<RayRecord> rays;
  for (int i = 0; i < 500; ++i) {
    const dvec3 d = glm::normalize(dvec3(-2, uniform(random), uniform(random))),
                to(0, 0.35 * uniform(random), 1 + 0.6 * uniform(random));
    for (const dvec3& by : {dvec3(0), dvec3(0, h, 0), dvec3(0, 0, h)})
      rays.push_back(ray_of(to - 2.0 * d + by, d));
  }
  const std::vector<SceneHit> hits = trace(flat, rays);
  for (std::size_t i = 0; i < rays.size(); i += 3)
    for (std::size_t k = 1; k < 3; ++k) {
      const SceneHit &a = hits[i], &b = hits[i + k];
      ASSERT_TRUE(a.found == 1 && b.found == 1);
      const double du = double(b.u) - double(a.u), dv = double(b.v) - double(a.v);
      const dvec3 moved = vec(b.p) - vec(a.p), predicted = du * vec(a.dpdu) + dv * vec(a.dpdv);
      // A way of w along the tube of radius r, seen under the cosine c, bends away from its tangent
      // by w^2 / (2 r), and v by as much more as the cosine changes: w^2 / (2 r c).
      const double way = glm::length(moved),
                   cosine = std::abs(glm::dot(vec(a.ng), direction(rays[i])));
      EXPECT_LE(glm::length(moved - predicted), way * way / (0.3 * cosine) + 1e-5) << i << " " << k;
      EXPECT_GT(way, 0.9 * h);
      // Both on the tangent plane, and u along the tube: dp/du is 2 / 0.5 long there, by the cosine
      // of the taper.
      EXPECT_NEAR(glm::dot(vec(a.dpdu), vec(a.ng)), 0, 1e-5);
      EXPECT_NEAR(glm::dot(vec(a.dpdv), vec(a.ng)), 0, 1e-4);
      EXPECT_NEAR(glm::length(vec(a.dpdu)), 4 * std::sqrt(1 - 0.01), 1e-5);
    }
}

std::vector<RayRecord> rays_at(const dvec3& center, double radius, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto any = [&] {
    return glm::normalize(dvec3(normal(random), normal(random), normal(random)));
  };
  std::vector<RayRecord> out;
  for (int i = 0; i < count; ++i) {
    const dvec3 from = center + 2 * radius * any(), to = center + 0.8 * radius * any();
    out.push_back(ray_of(from, to - from));
  }
  return out;
}

/// What rays see of the chain under a transform is what they see of it unmoved, from where they are
/// in its own space.
void expect_same_uv(const Scene& moved, const dmat4& world_from_chain, unsigned seed) {
  const FlatScene there = lower(moved), here = lower_shapes({shape_of(ring())});
  std::vector<RayRecord> rays = rays_at(dvec3(0), 1.2, 3000, seed), in_world;
  for (const RayRecord& ray : rays)
    in_world.push_back(ray_of(dvec3(world_from_chain * glm::dvec4(origin(ray), 1)),
                              dvec3(world_from_chain * glm::dvec4(direction(ray), 0))));
  const std::vector<SceneHit> a = trace(here, rays), b = trace(there, in_world);
  int met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (a[i].found == 0 || b[i].found == 0) continue;
    const dvec3 d = glm::normalize(direction(rays[i])), n = vec(a[i].ng);
    // Not where they graze: their points may be far apart there. Rounding of the matrices and rays
    // is some 100 eps of the ring's size.
    if (std::abs(glm::dot(d, n)) < 0.1 ||
        glm::length(vec(a[i].p) -
                    dvec3(glm::inverse(world_from_chain) * glm::dvec4(vec(b[i].p), 1))) > 1e-4)
      continue;
    const dvec3 axis = glm::normalize(vec(a[i].dpdu));
    if (glm::length(glm::cross(d, axis)) < 0.1) continue;
    // Balls at joints belong to both chords, which have the same u there; v and dp/du are those of
    // either.
    const double of_chord = double(a[i].u) * chords;
    if (std::abs(of_chord - std::round(of_chord)) < 1e-3) continue;
    ++met;
    EXPECT_NEAR(a[i].u, b[i].u, 1e-4) << i;
    EXPECT_NEAR(a[i].v, b[i].v, 2e-3) << i;
    const dvec3 expected = glm::dmat3(world_from_chain) * vec(a[i].dpdu);
    EXPECT_LT(glm::length(vec(b[i].dpdu) - expected), 2e-2 * glm::length(expected)) << i;
  }
  EXPECT_GT(met, 700);
}

TEST(Chains, UvBelongToTheirOwnSpace) {
  const dmat4 turned =
      glm::rotate(glm::translate(dmat4(1), dvec3(3, -1, 2)), 0.7, glm::normalize(dvec3(1, 2, -1)));
  const dmat4 mirrored = glm::scale(turned, dvec3(1, 1, -1)),
              squeezed = glm::scale(turned, dvec3(-0.5, 1, 2));
  unsigned seed = 20;
  for (const dmat4& m : {turned, glm::scale(mirrored, dvec3(2)), squeezed}) {
    Scene scene;
    scene.materials.emplace_back();
    scene.shapes.push_back(shape_of(ring(), m));
    expect_same_uv(scene, m, seed++);
    Scene placed;
    placed.materials.emplace_back();
    Object& object = placed.objects.emplace_back();
    object.shapes.push_back(shape_of(ring(), mirrored));
    placed.instances.push_back({0, m, {}});
    expect_same_uv(placed, m * mirrored, seed++);
  }
}

TEST(Chains, OperandsOfCsgKeepTheirU) {
  CapsulesShape first, second, third;
  push(first, {-1, 0, 0}, {1, 0, 0}, 0.2, 0.2, 0, 1);
  push(third, {-1, -3, 0}, {1, -3, 0}, 0.2, 0.2, 10, 20);
  push(second, {0, -1, 0}, {0, 1, 0}, 0.2, 0.1, 5, 7);
  CapsulesShape without{{{0, 0, -1}}, {{0, 0, 1}}, {0.15f}, {}, {}};
  const auto operand = [](Geometry geometry, const dmat4& m = dmat4(1)) {
    return std::make_shared<const Shape>(shape_of(std::move(geometry), m));
  };
  // A capsule without u, of the same kind as the first, and the second squeezed: it is placed in a
  // space of its own.
  const CsgShape csg{CsgShape::Operation::set_union,
                     {operand(without), operand(first),
                      operand(second, glm::scale(dmat4(1), dvec3(1, 1, 0.5))), operand(third)}};
  const FlatScene scene = lower_shapes({shape_of(csg)});
  EXPECT_TRUE(scene.has_chains);
  const std::vector<SceneHit> hits =
      trace(scene, {ray_of({0.5, 0.1, 3}, {0, 0, -1}), ray_of({0.05, 0.5, 3}, {0, 0, -1}),
                    ray_of({3, 0, 0.7}, {-1, 0, 0}), ray_of({0.5, -3, 3}, {0, 0, -1}),
                    ray_of({-1.47, 0.5, 3}, {0.5, 0, -1})});
  for (const SceneHit& hit : hits) ASSERT_EQ(hit.found, 1u);
  EXPECT_EQ(hits[0].surface, 1u);
  EXPECT_NEAR(hits[0].u, 0.75, 1e-6);
  EXPECT_NEAR(hits[0].v, v_of_pbrt({0.5, 0.1, 3}, {0, 0, -1}, {0, 0, 0}, {1, 0, 0}, 0.2), 1e-6);
  EXPECT_EQ(hits[1].surface, 2u);
  // The ball at s, of radius r = 0.2 - 0.1 s, touches the cone k r further on, k = 0.05: -1 + 2 s +
  // k r = 0.5; r sqrt(1 - k k) from the axis.
  const double k = 0.05, s = (1.5 - 0.2 * k) / (2 - 0.1 * k),
               across = (0.2 - 0.1 * s) * std::sqrt(1 - k * k);
  EXPECT_NEAR(hits[1].u, 5 + 2 * s, 1e-5);
  EXPECT_NEAR(hits[1].v, 0.5 + 0.05 / (2 * across), 1e-5);
  EXPECT_EQ(hits[2].surface, 0u);  // around z, from +x
  EXPECT_NEAR(hits[2].u, 0, 1e-6);
  EXPECT_NEAR(hits[3].u, 17.5, 1e-5);  // in a row with the first
  // Slanted, in the operand's own space twice as steep.
  EXPECT_EQ(hits[4].surface, 2u);
  EXPECT_NEAR(hits[4].v, v_of_pbrt({-1.47, 0.5, 6}, {0.5, 0, -2}, {0, 0, 0}, {0, 1, 0}, across),
              1e-5);
}

// A ball has u of p0; one that holds the other, that of its end.
TEST(Chains, OfBalls) {
  CapsulesShape balls;
  push(balls, {0, 0, 0}, {0, 0, 0}, 0.5, 0.5, 0.25, 0.5);
  push(balls, {3, 0, 0}, {3.1, 0, 0}, 0.5, 0.2, 0.25, 0.5);
  push(balls, {6, 0, 0}, {6.1, 0, 0}, 0.2, 0.5, 0.25, 0.5);
  const std::vector<SceneHit> hits =
      trace(lower_shapes({shape_of(balls)}),
            {ray_of({0, 0.2, 3}, {0, 0, -1}), ray_of({3, 0.2, 3}, {0, 0, -1}),
             ray_of({6, 0.2, 3}, {0, 0, -1}), ray_of({9, 0, 0.1}, {-1, 0, 0})});
  EXPECT_EQ(hits[0].u, 0.25f);
  EXPECT_EQ(hits[1].u, 0.25f);
  EXPECT_EQ(hits[2].u, 0.5f);
  EXPECT_NEAR(hits[1].v, v_of_pbrt({3, 0.2, 3}, {0, 0, -1}, {3, 0, 0}, {1, 0, 0}, 0.5), 1e-6);
  EXPECT_EQ(hits[0].v, 0.5f);  // the ray runs along the axis, z
  EXPECT_TRUE(std::isfinite(hits[3].dpdv[0]) && std::isfinite(hits[3].dpdu[0]));
}

// Nothing is kept, and no kernel is another one, where no capsule is of a chain.
TEST(Chains, CostNothingWhereThereAreNone) {
  CapsulesShape plain = ring();
  plain.u.clear();
  const FlatScene with = lower_shapes({shape_of(ring())}),
                  without = lower_shapes({shape_of(plain)});
  EXPECT_FALSE(without.has_chains);
  EXPECT_TRUE(without.mesh_uvs.empty());
  EXPECT_EQ(with.mesh_uvs.size(), 2u * chords);
  EXPECT_EQ(with.device_bytes() - without.device_bytes(), 8u * chords);
}

}  // namespace
}  // namespace caplet::test
