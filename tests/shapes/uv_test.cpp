// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The reference's texture coordinates at points whose (u, v) follows from docs/shapes.md by hand.
#include "reference/detail/uv.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "reference/scene_reference.h"

namespace {

using namespace caplet;
using namespace caplet::reference;
using caplet::reference::full_turn;
using glm::dvec2;
using glm::dvec3;

constexpr double pi = full_turn / 2;

void expect_uv(const Primitive& primitive, const dvec3& x, int surface, const dvec2& expected) {
  const dvec2 found = uv_at(primitive, x, surface);
  EXPECT_NEAR(found.x, expected.x, 1e-12);  // some roundings of numbers about 1
  EXPECT_NEAR(found.y, expected.y, 1e-12);
}

TEST(Uv, Spheres) {
  const Sphere sphere{{1, 2, 3}, 2};
  const double h = std::sqrt(0.5);
  expect_uv(sphere, {3, 2, 3}, 0, {0, 0.5});
  expect_uv(sphere, {1, 4, 3}, 0, {0.25, 0.5});
  expect_uv(sphere, dvec3(1, 2, 3) + 2.0 * dvec3(-h, 0, h), 0, {0.5, 0.75});
  EXPECT_NEAR(uv_at(sphere, {1, 2, 1}, 0).y, 0, 1e-12);
  EXPECT_NEAR(uv_at(sphere, {1, 2, 5}, 0).y, 1, 1e-12);
  // From latitude -30 to 90 degrees, a quarter of it turned by 90 of 180 degrees.
  const PartialSphere part{2, -1, 2, pi};
  expect_uv(part, {0, 2, 0}, 0, {0.5, 0.25});
  expect_uv(part, {0, std::sqrt(3.0), -1}, 0, {0.5, 0});
}

TEST(Uv, Capsules) {
  // Profile: a quarter of a circle (pi), 4 along, another quarter; u from +x, which stays where it
  // is.
  const Capsule capsule{{0, 0, 0}, {0, 0, 4}, 2, 2};
  const double whole = 2 * pi + 4;
  expect_uv(capsule, {2, 0, 1}, 0, {0, (pi + 1) / whole});
  expect_uv(capsule, {0, -2, 4}, 0, {0.75, (pi + 4) / whole});
  EXPECT_NEAR(uv_at(capsule, {0, 0, -2}, 0).y, 0, 1e-12);
  EXPECT_NEAR(uv_at(capsule, {0, 0, 6}, 0).y, 1, 1e-12);
  expect_uv(capsule, {0, std::sqrt(2.0), -std::sqrt(2.0)}, 0, {0.25, 0.5 * pi / whole});
  // Tapered: the generator is at the angle whose sine is (2 - 1) / 2 from the axis: 30 degrees; it
  // is sqrt(3) long.
  const Capsule tapered{{0, 0, 0}, {0, 0, 2}, 2, 1};
  const double first = 2 * (pi / 2 + pi / 6), side = std::sqrt(3.0), last = pi / 2 - pi / 6;
  const double c = std::sqrt(0.75);
  expect_uv(tapered, {2 * c, 0, 1}, 0, {0, first / (first + side + last)});
  expect_uv(tapered, {1.5 * c, 0, 1.75}, 0, {0, (first + 0.5 * side) / (first + side + last)});
  expect_uv(tapered, {c, 0, 2.5}, 0, {0, (first + side) / (first + side + last)});
  // One ball holds the other: its sphere, around the axis; one point: around z.
  expect_uv(Capsule{{0, 0, 0}, {1, 0, 0}, 3, 1}, {0, 3, 0}, 0, {0.25, 0.5});
  expect_uv(Capsule{{1, 0, 0}, {1, 0, 0}, 1, 1}, {1, 1, 0}, 0, {0.25, 0.5});
}

// +z goes to +x the short way, by a quarter of a turn around y: +x goes to -z. The same holds for
// axes next to the xy plane.
TEST(Uv, AnglesBeginWhereTheShortWayTakesThem) {
  const Capsule capsule{{0, 0, 0}, {4, 0, 0}, 1, 1};
  EXPECT_NEAR(uv_at(capsule, {2, 0, -1}, 0).x, 0, 1e-12);
  EXPECT_NEAR(uv_at(capsule, {2, 1, 0}, 0).x, 0.25, 1e-12);
  EXPECT_NEAR(uv_at(Capsule{{0, 0, 0}, {4, 0, -1e-9}, 1, 1}, {2, 1, 0}, 0).x, 0.25, 1e-9);
  EXPECT_NEAR(uv_at(Capsule{{0, 0, 0}, {0, 4, 0}, 1, 1}, {1, 2, 0}, 0).x, 0,
              1e-12);  // x is the axis of that turn
  // Below -0.9 -z goes there: down the z axis nothing moves, and the angle runs right-handed around
  // the axis.
  const Capsule down{{0, 0, 0}, {0, 0, -4}, 1, 1};
  EXPECT_NEAR(uv_at(down, {1, 0, -2}, 0).x, 0, 1e-12);
  EXPECT_NEAR(uv_at(down, {0, -1, -2}, 0).x, 0.25, 1e-12);
}

TEST(Uv, CylindersAndCones) {
  const Frustum cylinder = make_frustum({0, 0, 0}, {0, 0, 4}, {1, false, false}, {1, true, false});
  expect_uv(cylinder, {0, 1, 1}, 0, {0.25, 0.25});
  expect_uv(cylinder, {0, 0.5, 0}, 1, {0.25, 0.5});
  expect_uv(cylinder, {0, std::sqrt(0.5), 4 + std::sqrt(0.5)}, 2, {0.25, 0.5});
  const Frustum cone = make_frustum({0, 0, 0}, {0, 0, 3}, {2, false, false}, {1, false, false});
  expect_uv(cone, {1.5, 0, 1.5}, 0, {0, 0.5});
  expect_uv(cone, {0.25, 0, 3}, 2, {0, 0.75});
  // A ball of radius 5 at a distance of 4 through a disk of radius 5: a second part of the side,
  // which ends at the rim; the ball is whole.
  const Frustum pierced = make_frustum({0, 0, 0}, {0, 0, 4}, {5, true, false}, {5, false, false});
  ASSERT_EQ(pierced.side_count, 2);
  expect_uv(pierced, {5, 0, 4}, 0, {0, 1});
  expect_uv(pierced, {5, 0, 0}, 0, {0, 0});
  expect_uv(pierced, {5, 0, 0}, 1, {0, 0.5});
  expect_uv(OpenCylinder{2, -1, 3, pi}, {0, 2, 0}, 0, {0.5, 0.25});
}

TEST(Uv, Disks) {
  expect_uv(Disk{{0, 0, 1}, {0, 0, 2}, 2}, {0, 0.5, 1}, 0, {0.25, 0.75});
  expect_uv(PartialDisk{1, 2, 1, pi}, {0, 1.25, 1}, 0, {0.5, 0.75});
}

// Seen from outside: u to the right, v up z, or along y.
TEST(Uv, Boxes) {
  const Box box{{{0, 0, 0}, {1, 2, 4}}};
  expect_uv(box, {0, 0.5, 1}, 0, {0.75, 0.25});
  expect_uv(box, {1, 0.5, 1}, 1, {0.25, 0.25});
  expect_uv(box, {0.25, 0, 1}, 2, {0.25, 0.25});
  expect_uv(box, {0.25, 2, 1}, 3, {0.75, 0.25});
  expect_uv(box, {0.25, 0.5, 0}, 4, {0.75, 0.25});
  expect_uv(box, {0.25, 0.5, 4}, 5, {0.25, 0.25});
}

TEST(Uv, PolyhedraAndCsg) {
  // A box of half edges 1, 2, 2: a bounding radius of 3.
  const std::array<dvec3, 6> normals = {dvec3{-1, 0, 0}, {1, 0, 0},  {0, -1, 0},
                                        {0, 1, 0},       {0, 0, -1}, {0, 0, 1}};
  const std::array<double, 6> offsets = {1, 1, 2, 2, 2, 2};
  const Polyhedron p = make_polyhedron({5, 0, 0}, normals, offsets);
  expect_uv(p, {5, 0, 2}, 5, {0.5, 0.5});
  expect_uv(p, {5.6, 1.2, 2}, 5, {0.6, 0.7});
  expect_uv(p, {5.6, 1.2, -2}, 4, {0.6, 0.3});  // -y is up
  expect_uv(p, {6, 1.2, -0.6}, 1, {0.6, 0.7});  // +x goes to -z
  const std::array<CsgPart, 2> parts = {CsgPart{Sphere{}, glm::dmat4(1)},
                                        CsgPart{p, glm::translate(glm::dmat4(1), dvec3(0, 0, 7))}};
  const Csg csg = make_csg(Csg::Operation::set_union, parts);
  expect_uv(csg, {0, 1, 0}, 0, {0.25, 0.5});
  expect_uv(csg, {5.6, 1.2, 9}, 6, {0.6, 0.7});
}

TEST(Uv, Meshes) {
  expect_uv(Triangle{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {1, 2, 0}, 0, {0.75, 0.5});
  const Bilinear patch{{0, 0, 0}, {4, 0, 0}, {0, 2, 0}, {4, 2, 3}};
  const dvec2 uv(0.3, 0.8);
  expect_uv(patch, {4 * uv.x, 2 * uv.y, 3 * uv.x * uv.y}, 0, uv);
}

// A tapered capsule of a chain: u is that of the ball that touches there, v by the ray's distance
// from the axis.
TEST(Uv, OfChains) {
  // Radii 1 and 0.5 over a length of 1.3: the sine of the taper is 5 / 13, its cosine 12 / 13.
  const Capsule capsule{{0, 0, 0}, {1.3, 0, 0}, 1, 0.5, dvec2(2, 4)};
  const double sine = 5.0 / 13, cosine = 12.0 / 13, s = 0.25, r = 1 - 0.5 * s;
  const dvec3 x(1.3 * s + r * sine, 0, r * cosine);
  const auto expect = [&](const dvec3& at, const dvec3& direction, const dvec2& expected) {
    const dvec2 found = uv_at(capsule, at, 0, direction);
    EXPECT_NEAR(found.x, expected.x, 1e-12);
    EXPECT_NEAR(found.y, expected.y, 1e-12);
  };
  expect(x, {0, 0, -2}, {2.5, 0.5});
  // v grows to the side of direction x axis. A ray down and to -y goes by at r cos / sqrt(2) on
  // that side.
  expect(x, {0, -1, -1}, {2.5, 0.5 + 0.5 * std::sqrt(0.5)});
  expect(x, {3, 0, 0}, {2.5, 0.5});  // along the axis
  expect({-1, 0, 0}, {0, 0, -1}, {2, 0.5});
  expect({-0.6, 0.8 * cosine * 0.5, 0.5}, {0, 0, -1}, {2, 0.5 - 0.8 / 4});
  expect({1.8, 0, 0}, {0, 0, -1}, {4, 0.5});
  EXPECT_EQ(uv_at(Capsule{{0, 0, 0}, {0, 0, 0}, 1, 1, dvec2(2, 4)}, {1, 0, 0}, 0, {-1, 0, 0}).x, 2);
  // Two balls around one centre are the larger one. The axis is z: along -x, v grows with y.
  const dvec2 concentric = uv_at(Capsule{{0, 0, 0}, {0, 0, 0}, 0.25, 1, dvec2(2, 4)},
                                 {0, 0.5, std::sqrt(0.75)}, 0, {-1, 0, 0});
  EXPECT_EQ(concentric.x, 2);
  EXPECT_NEAR(concentric.y, 0.75, 1e-12);
  EXPECT_EQ(
      uv_at(Capsule{{0, 0, 0}, {0.1, 0, 0}, 0.2, 1, dvec2(2, 4)}, {1.1, 0, 0}, 0, {-1, 0, 0}).x, 4);
}

TEST(Uv, OfScenes) {
  Scene scene;
  Shape mesh;
  mesh.geometry = TriangleMeshShape{
      {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}, {}, {{0, 0}, {1, 0}, {0, 1}}};
  mesh.world_from_object = glm::translate(glm::dmat4(1), dvec3(0, 0, 9));
  Shape patch;
  patch.geometry = BilinearMeshShape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
                                     {{0, 1, 2, 3}},
                                     {},
                                     {{0, 0}, {3, 0}, {0, 5}, {3, 5}}};
  Shape ball;
  ball.geometry = SphereShape{1};
  ball.world_from_object =
      glm::rotate(glm::translate(glm::dmat4(1), dvec3(0, 0, 5)), pi / 2, dvec3(1, 0, 0));
  scene.shapes = {mesh, patch, ball};
  const SceneReference reference(scene);
  SceneHit hit;
  const auto expect = [&](std::size_t index, const dvec3& point, const dvec2& expected) {
    hit.index = index;
    const dvec2 found = reference.uv(hit, point, {});
    EXPECT_NEAR(found.x, expected.x, 1e-12);
    EXPECT_NEAR(found.y, expected.y, 1e-12);
  };
  expect(0, {1, 2, 9}, {0.25, 0.5});
  expect(1, {0.5, 0.25, 0}, {1.5, 1.25});
  expect(2, {0, 0, 6}, {0.25, 0.5});  // its y axis is up, its z axis is -y
  hit.index = 2;
  EXPECT_NEAR(reference.uv(hit, {0, -1, 5}, {}).y, 1, 1e-12);
}

}  // namespace
