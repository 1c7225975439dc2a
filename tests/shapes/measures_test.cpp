// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What the host works out about solids: faces and corners of polyhedra, planes to blame, areas. No
// device.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <optional>
#include <random>

#include "lower/detail/area.h"
#include "lower/detail/flat_shapes.h"
#include "lower/detail/shapes.h"
#include "scene/scene.h"
#include "shared/kinds.h"

namespace caplet::test {
namespace {

using glm::dvec3;

using std::numbers::pi;

PolyhedronShape cube() {
  return {{dvec3(0), dvec3(1), dvec3(0), dvec3(1), dvec3(0), dvec3(1)},
          {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 5, 0}, {0, 0, -1e-3}, {0, 0, 1}}};
}

dvec3 random_direction(std::mt19937& engine) {
  std::normal_distribution<double> normal;
  return glm::normalize(dvec3(normal(engine), normal(engine), normal(engine)));
}

std::optional<std::size_t> blamed(const PolyhedronShape& polyhedron) {
  std::size_t plane = 999;
  return polyhedron_corners(polyhedron, &plane).empty() ? std::optional(plane) : std::nullopt;
}

// --- Faces and corners ---

TEST(Polyhedra, ACubeHasEightCornersAndFacesSeenCounterClockwise) {
  const auto corners = polyhedron_corners(cube());
  EXPECT_EQ(corners.size(), 8u);
  for (const dvec3& x : corners)
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(std::min(std::abs(x[k]), std::abs(x[k] - 1)), 0, 1e-14);
  const auto faces = polyhedron_faces(cube());
  ASSERT_EQ(faces.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    ASSERT_EQ(faces[i].size(), 4u);
    for (std::size_t k = 0; k < 4; ++k) {
      const dvec3 turn = glm::cross(faces[i][(k + 1) % 4] - faces[i][k],
                                    faces[i][(k + 2) % 4] - faces[i][(k + 1) % 4]);
      EXPECT_NEAR(glm::dot(turn, glm::normalize(cube().normals[i])), 1, 1e-12);
    }
  }
}

// Planes that touch a ball at random: three faces meet at every corner, so there are 2 n - 4 of
// them (Euler).
TEST(Polyhedra, HundredsOfPlanesAroundABall) {
  std::mt19937 engine(1);
  for (const std::size_t n : {20u, 100u, 400u}) {
    const dvec3 center(1000, -2000, 300);
    PolyhedronShape ball;
    for (std::size_t i = 0; i < n; ++i) {
      ball.normals.push_back(random_direction(engine));
      ball.points.push_back(center + 2.5 * ball.normals.back());
    }
    const auto corners = polyhedron_corners(ball);
    EXPECT_EQ(corners.size(), 2 * n - 4);
    for (const dvec3& x : corners) {
      int touching = 0;
      for (std::size_t i = 0; i < n; ++i) {
        const double above = glm::dot(ball.normals[i], x - ball.points[i]);
        EXPECT_LE(above, 1e-11);
        touching += above > -1e-11;
      }
      EXPECT_EQ(touching, 3);
    }
  }
}

// A hundred planes through one point, and a repeated plane.
TEST(Polyhedra, CornersWhereManyFacesMeet) {
  PolyhedronShape pyramid{{{0, 0, 0}}, {{0, 0, -1}}};
  for (int i = 0; i < 100; ++i) {
    const double phi = 2 * pi * i / 100;
    pyramid.points.push_back({0, 0, 3});
    pyramid.normals.push_back({3 * std::cos(phi), 3 * std::sin(phi), 1});
  }
  pyramid.points.push_back({5, 7, 0});
  pyramid.normals.push_back({0, 0, -2});
  EXPECT_EQ(polyhedron_corners(pyramid).size(), 101u);
  const auto faces = polyhedron_faces(pyramid);
  EXPECT_EQ(faces[0].size(), 100u);
  EXPECT_LT(faces[101].size(), 3u);
}

TEST(Polyhedra, WhatTheyAreNotIsBlamedOnAPlane) {
  EXPECT_EQ(blamed(cube()), std::nullopt);
  for (std::size_t i = 0; i < 6; ++i) {
    PolyhedronShape open = cube();
    open.points.erase(open.points.begin() + std::ptrdiff_t(i));
    open.normals.erase(open.normals.begin() + std::ptrdiff_t(i));
    // The faces beside the missing one have no end.
    const auto plane = blamed(open);
    ASSERT_TRUE(plane.has_value()) << i;
    EXPECT_EQ(open.normals[*plane][int(i) / 2], 0) << i;
    PolyhedronShape bad = cube();
    bad.normals[i] = dvec3(0);
    EXPECT_EQ(blamed(bad), i);
    bad.normals[i] = dvec3(0, HUGE_VAL, 0);
    EXPECT_EQ(blamed(bad), i);
    bad = cube();
    bad.points[i].y = std::nan("");
    EXPECT_EQ(blamed(bad), i);
  }
  PolyhedronShape none = cube();
  none.points.push_back({0, 0, -1});
  none.normals.push_back({0, 0, 1});
  EXPECT_EQ(blamed(none), 6u);
  none.points.back() = {0, 0, 0};  // nothing but a face is left
  EXPECT_EQ(blamed(none), 6u);
  none.points.back() = {0, 0, 0.5};
  EXPECT_EQ(blamed(none), std::nullopt);
  // A slab, a wedge and a single plane have no end; planes through one point enclose nothing.
  EXPECT_TRUE(blamed({{dvec3(0), dvec3(0, 0, 1)}, {{0, 0, -1}, {0, 0, 1}}}));
  EXPECT_TRUE(blamed({{dvec3(0), dvec3(0), dvec3(1)}, {{0, 0, -1}, {0, 0.1, 1}, {1, 0, 0}}}));
  EXPECT_EQ(blamed({{dvec3(0)}, {{0, 0, 1}}}), 0u);
  EXPECT_EQ(blamed({{}, {}}), 0u);
  PolyhedronShape point = cube();
  for (dvec3& x : point.points) x = dvec3(1, 2, 3);
  EXPECT_TRUE(blamed(point));
}

TEST(Polyhedra, NeedlesAndPlatesAreThereAtAnyPlace) {
  for (const double thin : {1e-1, 1e-3, 1e-5}) {
    PolyhedronShape plate = cube();
    for (dvec3& x : plate.points) x = x * dvec3(1, thin, thin) + dvec3(1e4, 2e4, -3e4);
    EXPECT_EQ(polyhedron_corners(plate).size(), 8u) << thin;
  }
}

// --- Areas ---

double area(const Shape& shape) {
  std::vector<float> leaves;
  return std::visit(
      [&](const auto& geometry) -> double {
        using Geometry = std::decay_t<decltype(geometry)>;
        if constexpr (std::is_same_v<Geometry, CapsulesShape> ||
                      std::is_same_v<Geometry, TriangleMeshShape> ||
                      std::is_same_v<Geometry, BilinearMeshShape> ||
                      std::is_same_v<Geometry, MolecularSurfaceShape> ||
                      std::is_same_v<Geometry, CsgShape>) {
          return -1;
        } else {
          const FlatPrimitive p = flat_primitive(geometry, shape.world_from_object, leaves);
          return primitive_area(p, leaves);
        }
      },
      shape.geometry);
}
double area(decltype(Shape::geometry) geometry, const glm::dmat4& m = glm::dmat4(1)) {
  Shape shape;
  shape.geometry = std::move(geometry);
  shape.world_from_object = m;
  return area(shape);
}

TEST(Areas, SpheresAndCapsules) {
  const FlatPrimitive sphere{shape_sphere, 0, {1, 2, 3, 0.5f}};
  EXPECT_NEAR(primitive_area(sphere, {}), 4 * pi * 0.25, 1e-12);
  EXPECT_NEAR(area(SphereShape{0.5}, glm::scale(glm::dmat4(1), dvec3(3))), 4 * pi * 2.25, 1e-5);
  const FlatPrimitive capsule{shape_capsule, 0, {1, 2, 3, 1, 2, 5, 0.5f}};
  EXPECT_NEAR(primitive_area(capsule, {}), 2 * pi * 0.5 * 2 + 4 * pi * 0.25, 1e-12);
  // The joining cone's half angle has the sine 3/5 and the cosine 4/5; its generator is 4 long,
  // between circles of 4/5 of the radii.
  const FlatPrimitive tapered{shape_tapered_capsule, 0, {0, 0, 0, 0, 0, 5, 4, 1}};
  EXPECT_NEAR(primitive_area(tapered, {}), 2 * pi * (16 * 1.6 + 1 * 0.4) + pi * (4 + 1) * 0.8 * 4,
              1e-12);
}

TEST(Areas, ABoxIsThePolyhedronOfItsPlanes) {
  EXPECT_NEAR(area(BoxShape{{1, 2, 3}, {2, 5, 7}}), 2 * (3 + 12 + 4), 1e-6);
  EXPECT_NEAR(area(cube()), 6, 1e-6);
  const glm::dmat4 m =
      glm::rotate(glm::scale(glm::translate(glm::dmat4(1), dvec3(9, 8, 7)), dvec3(1, 3, 4)), 0.5,
                  dvec3(0, 0, 1));
  // The square of the x and y axes is stretched to 3; sides by the lengths of the rotated axes.
  const double x = std::hypot(std::cos(0.5), 3 * std::sin(0.5)),
               y = std::hypot(std::sin(0.5), 3 * std::cos(0.5));
  EXPECT_NEAR(area(cube(), m), 2 * (3 + 4 * x + 4 * y), 1e-4);
}

/// The area of the hull of two ends by turning the hull of their profile, found point by point,
/// around the axis.
double turned_hull(double length, double r0, Cap cap0, double r1, Cap cap1) {
  struct Point {
    double z, rho;
  };
  std::vector<Point> points;
  const auto add_end = [&](double z, double r, Cap cap) {
    constexpr int n = 20000;
    if (cap == Cap::round)
      for (int i = 0; i <= n; ++i)
        points.push_back({z - r * std::cos(pi * i / n), r * std::sin(pi * i / n)});
    else
      points.insert(points.end(), {{z, 0}, {z, r}});
  };
  add_end(0, r0, cap0);
  add_end(length, r1, cap1);
  // Lowest and highest z at the axis, and above it the upper hull (Andrew's monotone chain).
  std::ranges::sort(points, [](const Point& a, const Point& b) {
    return a.z < b.z || (a.z == b.z && a.rho < b.rho);
  });
  std::vector<Point> hull;
  for (const Point& p : points) {
    while (hull.size() >= 2) {
      const Point &a = hull[hull.size() - 2], &b = hull.back();
      if ((b.z - a.z) * (p.rho - a.rho) - (b.rho - a.rho) * (p.z - a.z) < 0) break;
      hull.pop_back();
    }
    hull.push_back(p);
  }
  hull.insert(hull.begin(), {hull.front().z, 0});
  hull.push_back({hull.back().z, 0});
  double sum = 0;
  for (std::size_t i = 1; i < hull.size(); ++i)
    sum += pi * (hull[i - 1].rho + hull[i].rho) *
           std::hypot(hull[i].z - hull[i - 1].z, hull[i].rho - hull[i - 1].rho);
  return sum;
}

TEST(Areas, CylindersAndConesAreHullsOfTheirEnds) {
  const Cap caps[] = {Cap::flat, Cap::round};
  for (const Cap cap0 : caps)
    for (const Cap cap1 : caps) {
      for (const double r : {0.25, 2.0})
        EXPECT_NEAR(area(CylinderShape{{1, 2, 3}, {1, 2, 6}, r, {cap0, cap1}}) /
                        turned_hull(3, r, cap0, r, cap1),
                    1, 2e-6);
      for (const auto& [r0, r1] : {std::pair(1.0, 0.25), std::pair(0.25, 1.0), std::pair(2.0, 0.0),
                                   std::pair(4.0, 0.5), std::pair(0.5, 4.0)})
        EXPECT_NEAR(area(ConeShape{{1, 2, 3}, {1, 2, 6}, {r0, r1}, {cap0, cap1}}) /
                        turned_hull(3, r0, cap0, r1, cap1),
                    1, 2e-6)
            << r0 << " " << r1 << " " << int(cap0) << int(cap1);
    }
  // A flat disk within a ball behind which the ball comes out again.
  EXPECT_NEAR(area(ConeShape{{0, 0, 0}, {0, 0, 0.5}, {2, 1}, {Cap::flat, Cap::round}}) /
                  turned_hull(0.5, 2, Cap::flat, 1, Cap::round),
              1, 2e-6);
  // Open ends have no cap.
  EXPECT_NEAR(area(CylinderShape{{0, 0, 0}, {0, 0, 3}, 0.5, {Cap::open, Cap::open}}),
              2 * pi * 0.5 * 3, 1e-6);
  EXPECT_NEAR(area(ConeShape{{0, 0, 0}, {0, 0, 4}, {3, 0}, {Cap::open, Cap::flat}}), pi * 3 * 5,
              1e-5);
}

TEST(Areas, PartsOfQuadrics) {
  EXPECT_NEAR(area(PartialSphereShape{2, -0.5, 1, pi}), pi * 2 * 1.5, 1e-6);
  EXPECT_NEAR(area(OpenCylinderShape{2, -0.5, 1, pi / 2}), pi / 2 * 2 * 1.5, 1e-6);
  EXPECT_NEAR(area(DiskShape{0, 2, 1, pi}), pi / 2 * 3, 1e-6);
}

double patch_area(const std::array<dvec3, 4>& p) {
  FlatPrimitive flat{shape_bilinear, 0, {}};
  for (std::size_t k = 0; k < 4; ++k) put(flat, static_cast<int>(3 * k), p[k]);
  return primitive_area(flat, {});
}

TEST(Areas, BilinearPatches) {
  EXPECT_NEAR(patch_area({dvec3(0), dvec3(2, 0, 0), dvec3(1, 3, 0), dvec3(3, 3, 0)}), 6, 1e-6);
  EXPECT_NEAR(patch_area({dvec3(0), dvec3(2, 0, 0), dvec3(0, 1, 0), dvec3(1, 1, 0)}), 1.5, 1e-6);
  // z = x y over the unit square: the integral of sqrt(1 + x^2 + y^2), the inner one in closed
  // form, the outer by 10^5 midpoints.
  double sum = 0;
  constexpr int n = 100000;
  for (int i = 0; i < n; ++i) {
    const double a2 = 1 + std::pow((i + 0.5) / n, 2), a = std::sqrt(a2);
    sum += 0.5 * (std::sqrt(a2 + 1) + a2 * std::asinh(1 / a)) / n;
  }
  EXPECT_NEAR(patch_area({dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(1, 1, 1)}), sum, 1e-8);
  // A corner beyond the opposite edge's line: u and v turn over, and the part that is covered twice
  // counts twice.
  const double dart = patch_area({dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0.25, 0.25, 0)});
  EXPECT_GT(dart, 0.25);
  EXPECT_LT(dart, 0.5);
}

// Two balls and the belt that a probe leaves between them, under maps of either kind.
TEST(Areas, MolecularPatches) {
  const double r = 1, half = 1.25, probe = 0.75;
  const MolecularSurfaceShape molecule =
      make_molecule({{0, 0, 1.25f}, {0, 0, -1.25f}}, {1, 1}, probe);
  const auto area_under = [&](const glm::dmat4& m) {
    std::vector<float> leaves;
    double out = 0;
    for (const FlatPrimitive& p : flat_patches(molecule, glm::dmat4(1), leaves))
      out += placed_area(p, leaves, AreaMap(m), {});
    return out;
  };
  const double major = std::sqrt((r + probe) * (r + probe) - half * half),
               contact = half * probe / (r + probe), angle = std::asin(contact / probe);
  const double ball = 2 * pi * r * (half + r - contact),
               belt = 2 * pi * probe * (major * angle - probe * std::sin(angle));
  EXPECT_NEAR(area_under(glm::dmat4(1)), 2 * (ball + belt), 3e-4 * 8 * pi);
  EXPECT_NEAR(area_under(glm::scale(glm::dmat4(1), dvec3(-3))), 9 * 2 * (ball + belt),
              27e-4 * 8 * pi);
  // Stretched along the axis by so much that slopes alone count: twice the widest and twice less
  // the narrowest circle, each way.
  const double flat = 1e-4, neck = major - probe;
  EXPECT_NEAR(area_under(glm::scale(glm::dmat4(1), dvec3(1, 1, flat))),
              2 * pi * (2 * r * r - neck * neck), 3e-3);
}

}  // namespace
}  // namespace caplet::test
