// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Shapes that are right: their forms, surfaces, curves, csg, and bounds against points drawn from
// the shapes themselves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <random>

#include "import_text.h"

namespace caplet::test::shapes_test {
namespace {

using glm::dvec3;

using std::numbers::pi;

template <class T>
const T& geometry_of(const Scene& scene, std::size_t shape = 0) {
  return std::get<T>(scene.shapes.at(shape).geometry);
}
void expect_near(const dvec3& a, const dvec3& b, double bound) {
  EXPECT_LE(glm::length(a - b), bound)
      << a.x << " " << a.y << " " << a.z << " for " << b.x << " " << b.y << " " << b.z;
}

// --- Forms ---

TEST(Solids, CylindersOfBothForms) {
  const Scene scene = world_of(
      "Shape \"cylinder\" \"point3 p0\" [1 2 3] \"point3 p1\" [4 5 6] \"float radius\" .5\n"
      "Shape \"cylinder\" \"point3 p0\" [1 2 3] \"point3 p1\" [4 5 6] \"float radius\" .5 \"string "
      "caps\" \"round\"\n"
      "Shape \"cylinder\" \"point3 p0\" [1 2 3] \"point3 p1\" [4 5 6] \"float radius\" .5 \"string "
      "caps\" [\"open\" \"flat\"]\n"
      "Shape \"cylinder\"\nShape \"cylinder\" \"float radius\" 2 \"float zmin\" 5 \"float zmax\" 1 "
      "\"float phimax\" 90\n"
      "Shape \"cylinder\" \"float phimax\" 400");
  const auto& closed = geometry_of<CylinderShape>(scene);
  EXPECT_EQ(closed.p0, dvec3(1, 2, 3));
  EXPECT_EQ(closed.p1, dvec3(4, 5, 6));
  EXPECT_EQ(closed.radius, .5);
  EXPECT_THAT(closed.caps, testing::ElementsAre(Cap::flat, Cap::flat));
  EXPECT_THAT(geometry_of<CylinderShape>(scene, 1).caps,
              testing::ElementsAre(Cap::round, Cap::round));
  EXPECT_THAT(geometry_of<CylinderShape>(scene, 2).caps,
              testing::ElementsAre(Cap::open, Cap::flat));
  EXPECT_TRUE(is_closed(scene.shapes[1]));
  EXPECT_FALSE(is_closed(scene.shapes[2]));
  const auto& plain = geometry_of<OpenCylinderShape>(scene, 3);
  EXPECT_THAT((std::array{plain.radius, plain.z_min, plain.z_max, plain.phi_max}),
              testing::ElementsAre(1, -1, 1, full_turn));
  const auto& part = geometry_of<OpenCylinderShape>(scene, 4);
  EXPECT_THAT((std::array{part.radius, part.z_min, part.z_max, part.phi_max}),
              testing::ElementsAre(2, 1, 5, pi / 2));
  EXPECT_EQ(geometry_of<OpenCylinderShape>(scene, 5).phi_max, full_turn);
  EXPECT_EQ(count_primitives(scene), (std::map<std::string, std::uint64_t>{{"cylinder", 6}}));
}

TEST(Solids, ConesBoxesAndPolyhedra) {
  const Scene scene = world_of(
      "Shape \"cone\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 0 2] \"float radius\" 1\n"
      "Shape \"cone\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 0 2] \"float radius\" [0 3] \"string "
      "caps\" [\"flat\" \"round\"]\n"
      "Shape \"box\" \"point3 p0\" [1 -2 3] \"point3 p1\" [-1 2 -3]\n"
      "Shape \"polyhedron\" \"point3 P\" [0 0 0 0 0 0 0 0 0 1 0 0] \"normal N\" [-2 0 0 0 -1 0 0 0 "
      "-1 1 1 1]");
  EXPECT_THAT(geometry_of<ConeShape>(scene).radius, testing::ElementsAre(1, 0));
  EXPECT_THAT(geometry_of<ConeShape>(scene, 1).radius, testing::ElementsAre(0, 3));
  EXPECT_THAT(geometry_of<ConeShape>(scene, 1).caps, testing::ElementsAre(Cap::flat, Cap::round));
  EXPECT_EQ(geometry_of<BoxShape>(scene, 2).p0, dvec3(-1, -2, -3));
  EXPECT_EQ(geometry_of<BoxShape>(scene, 2).p1, dvec3(1, 2, 3));
  EXPECT_EQ(surface_count(scene.shapes[3]), 4u);
  const Bounds corner = bounds_of(scene.shapes[3]);
  expect_near(corner.min, {0, 0, 0}, 1e-12);
  expect_near(corner.max, {1, 1, 1}, 1e-12);
  EXPECT_EQ(count_primitives(scene),
            (std::map<std::string, std::uint64_t>{{"cone", 2}, {"box", 1}, {"polyhedron", 1}}));
}

TEST(Parts, OfSpheresAndDisks) {
  const Scene scene = world_of(
      "Shape \"sphere\" \"float radius\" 2 \"float zmin\" -9 \"float zmax\" 1 \"float phimax\" "
      "180\n"
      "Shape \"sphere\" \"float radius\" 2 \"float zmin\" -2 \"float zmax\" 3 \"float phimax\" "
      "360\n"
      "Shape \"disk\" \"float radius\" 2 \"float innerradius\" 1 \"float phimax\" 45\nShape "
      "\"disk\" \"float phimax\" 720");
  const auto& part = geometry_of<PartialSphereShape>(scene);
  EXPECT_THAT((std::array{part.radius, part.z_min, part.z_max, part.phi_max}),
              testing::ElementsAre(2, -2, 1, pi));
  EXPECT_EQ(geometry_of<SphereShape>(scene, 1).radius, 2);
  const auto& ring = geometry_of<DiskShape>(scene, 2);
  EXPECT_EQ(ring.inner_radius, 1);
  EXPECT_EQ(ring.phi_max, pi / 4);
  EXPECT_FALSE(ring.is_whole());
  EXPECT_TRUE(geometry_of<DiskShape>(scene, 3).is_whole());
  EXPECT_EQ(count_primitives(scene),
            (std::map<std::string, std::uint64_t>{{"sphere", 2}, {"disk", 2}}));
}

TEST(Patches, PlainAndIndexed) {
  const Scene scene = world_of(
      "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 5]\n"
      "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0 0 2 0 1 2 9] \"integer "
      "indices\" [0 1 2 3 2 3 4 5]\n"
      " \"normal N\" [0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1] \"point2 uv\" [0 0 1 0 0 1 1 1 0 2 1 "
      "2]");
  using Patch = std::array<std::uint32_t, 4>;
  EXPECT_THAT(geometry_of<BilinearMeshShape>(scene).patches,
              testing::ElementsAre(Patch{0, 1, 2, 3}));
  const auto& mesh = geometry_of<BilinearMeshShape>(scene, 1);
  EXPECT_THAT(mesh.patches, testing::ElementsAre(Patch{0, 1, 2, 3}, Patch{2, 3, 4, 5}));
  EXPECT_EQ(mesh.normals.size(), 6u);
  EXPECT_EQ(mesh.uvs[5], glm::vec2(1, 2));
  EXPECT_EQ(bounds_of(scene).max, dvec3(1, 2, 9));
  EXPECT_EQ(count_primitives(scene), (std::map<std::string, std::uint64_t>{{"bilinear_patch", 3}}));
}

// --- Surfaces ---

TEST(Surfaces, MaterialsSidesAndLights) {
  const Scene scene = world_of(
      "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" MakeNamedMaterial \"b\" \"string type\" "
      "\"conductor\"\n"
      "Shape \"cylinder\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 0 1] \"float radius\" 1 \"string "
      "materials\" [\"b\" \"a\" "
      "\"b\"]\n"
      "AreaLightSource \"diffuse\" \"integer surfaces\" [2 4]\n"
      "Shape \"box\" \"point3 p0\" [0 0 0] \"point3 p1\" [1 1 1] \"bool onesided\" true");
  const auto name = [&](std::uint32_t index) { return scene.materials.at(index).name; };
  const Shape& cylinder = scene.shapes[0];
  ASSERT_EQ(cylinder.materials.size(), 3u);
  EXPECT_EQ(name(cylinder.materials[0]) + name(cylinder.materials[1]) + name(cylinder.materials[2]),
            "bab");
  EXPECT_EQ(name(cylinder.material), "b");
  EXPECT_FALSE(cylinder.one_sided);
  EXPECT_TRUE(scene.shapes[1].one_sided);
  EXPECT_TRUE(scene.shapes[1].materials.empty());
  EXPECT_EQ(name(scene.shapes[1].material), "default");
  EXPECT_THAT(scene.shapes[1].emission->surfaces, testing::ElementsAre(2, 4));
}

TEST(Surfaces, MaterialsWithinObjectsAreTheirs) {
  const Scene scene = world_of(
      "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" MakeNamedMaterial \"b\" \"string type\" "
      "\"conductor\"\n"
      "ObjectBegin \"o\" Shape \"cone\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 0 1] \"float "
      "radius\" 1 \"string materials\" "
      "[\"b\" \"a\" "
      "\"b\"] ObjectEnd\nObjectInstance \"o\"");
  EXPECT_THAT(scene.objects[0].shapes[0].materials, testing::ElementsAre(1, 0, 1));
  EXPECT_EQ(scene.materials.size(), 2u);
}

// --- Csg ---

const std::string parts =
    "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" MakeNamedMaterial \"b\" \"string type\" "
    "\"conductor\"\n"
    "NamedMaterial \"a\"\n"
    "AttributeBegin Translate 1 0 0 ObjectBegin \"ball\" Scale 2 2 2 Shape \"sphere\" ObjectEnd "
    "AttributeEnd\n"
    "NamedMaterial \"b\"\n"
    "ObjectBegin \"box\" Shape \"box\" \"point3 p0\" [-9 -9 0] \"point3 p1\" [9 9 9] ObjectEnd\n"
    "ObjectBegin \"pin\" Shape \"capsule\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 0 1] \"float "
    "radius\" .5 ObjectEnd\n";

TEST(Csg, OperandsKeepTheirTransformsAndMaterials) {
  const Scene scene = world_of(parts +
                               "ObjectBegin \"half\" Translate 0 0 5 Shape \"csg\" \"string "
                               "operation\" \"difference\" \"string operands\" [\"ball\" "
                               "\"box\"] ObjectEnd\n"
                               "Translate 0 10 0\nShape \"csg\" \"string operation\" \"union\" "
                               "\"string operands\" [\"half\" \"pin\"]");
  const auto& whole = geometry_of<CsgShape>(scene);
  EXPECT_EQ(whole.operation, CsgShape::Operation::set_union);
  ASSERT_EQ(whole.operands.size(), 2u);
  const auto& half = std::get<CsgShape>(whole.operands[0]->geometry);
  EXPECT_EQ(half.operation, CsgShape::Operation::set_difference);
  EXPECT_EQ(surface_count(scene.shapes[0]), 1u + 6u + 1u);
  EXPECT_EQ(solid_count(scene.shapes[0]), 3u);
  EXPECT_EQ(scene.materials.at(half.operands[0]->material).name, "a");
  EXPECT_EQ(scene.materials.at(half.operands[1]->material).name, "b");
  EXPECT_EQ(scene.materials.size(), 2u);
  EXPECT_TRUE(scene.instances.empty());
  // The ball around (1, 0, 0) of radius 2 below z = 0, moved by (0, 10, 5); the pin only by (0, 10,
  // 0).
  const Bounds bounds = bounds_of(scene);
  const double part = 4.0 / 64;
  expect_near(bounds.min, {-1, 8, -.5}, 2 * part);
  expect_near(bounds.max, {3, 12, 5}, 2 * part);
  EXPECT_GE(bounds.max.z, 5);
  EXPECT_EQ(count_primitives(scene), (std::map<std::string, std::uint64_t>{{"csg", 1}}));
}

// A list of one capsule has the material that its list names, whatever the current one is.
TEST(Csg, ACapsuleOfAListKeepsItsMaterial) {
  const Scene scene = world_of(
      parts +
      "ObjectBegin \"one\" Shape \"capsules\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 0 1] \"float "
      "radius\" .5"
      " \"string capsulematerials\" \"a\" \"integer materialindices\" 0 ObjectEnd\n"
      "Shape \"csg\" \"string operation\" \"union\" \"string operands\" [\"pin\" \"one\"]");
  const auto& whole = geometry_of<CsgShape>(scene);
  EXPECT_EQ(scene.materials.at(whole.operands.at(0)->material).name, "b");
  EXPECT_EQ(scene.materials.at(whole.operands.at(1)->material).name, "a");
  EXPECT_TRUE(std::get<CapsulesShape>(whole.operands[1]->geometry).materials.empty());
}

TEST(Csg, MaterialsOfTheWholeCountAllSurfaces) {
  const Scene scene = world_of(
      parts +
      "Shape \"csg\" \"string operation\" \"intersection\" \"string operands\" [\"ball\" \"box\"]\n"
      " \"string materials\" [\"b\" \"a\" \"a\" \"a\" \"a\" \"a\" \"b\"]");
  EXPECT_THAT(scene.shapes[0].materials, testing::ElementsAre(1, 0, 0, 0, 0, 0, 1));
}

TEST(Csg, ThirtyTwoSolidsAreAllowed) {
  std::string names;
  for (int i = 0; i < 32; ++i) names += " \"pin\"";
  const Scene scene = world_of(
      parts + "Shape \"csg\" \"string operation\" \"union\" \"string operands\" [" + names + "]");
  EXPECT_EQ(solid_count(scene.shapes[0]), 32u);
}

TEST(Csg, WhatIsEmptyHasNoBoundsAndIsNoError) {
  const std::string text =
      parts +
      "AttributeBegin Translate 0 0 20 ObjectBegin \"far\" Shape \"sphere\" ObjectEnd "
      "AttributeEnd\n"
      "Shape \"csg\" \"string operation\" \"intersection\" \"string operands\" [\"pin\" \"far\"]\n"
      "Shape \"csg\" \"string operation\" \"difference\" \"string operands\" [\"pin\" \"ball\"]\n"
      "ObjectBegin \"none\" Shape \"csg\" \"string operation\" \"intersection\" \"string "
      "operands\" [\"pin\" \"far\"] "
      "ObjectEnd\n"
      "Shape \"csg\" \"string operation\" \"union\" \"string operands\" [\"pin\" \"none\"]\n"
      "Shape \"csg\" \"string operation\" \"intersection\" \"string operands\" [\"pin\" \"none\"]";
  const Scene scene = world_of(text);
  EXPECT_TRUE(bounds_of(scene.shapes[0]).empty());
  EXPECT_TRUE(bounds_of(scene.shapes[1]).empty());  // the pin lies within the ball
  EXPECT_EQ(bounds_of(scene.shapes[2]).max, dvec3(.5, .5, 1.5));
  EXPECT_TRUE(bounds_of(scene.shapes[3]).empty());
  EXPECT_THAT(complaints("Camera \"perspective\"\nWorldBegin\n" + text), testing::IsEmpty());
}

// --- Bounds ---

/// Points of a shape's surface, drawn by `draw`, under random affine maps: all within the bounds,
/// which each side nearly attains.
void expect_bounds(const Shape& original, const std::function<dvec3(std::mt19937&)>& draw, int maps,
                   double share) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int map = 0; map < maps; ++map) {
    Shape shape = original;
    for (int c = 0; map > 0 && c < 4; ++c)
      for (int r = 0; r < 3; ++r) shape.world_from_object[c][r] = number(random) + (r == c ? 1 : 0);
    const Bounds bounds = bounds_of(shape);
    Bounds drawn;
    for (int i = 0; i < 20000; ++i)
      drawn.extend(dvec3(shape.world_from_object * glm::dvec4(draw(random), 1)));
    const dvec3 size = bounds.max - bounds.min;
    const double slack = 1e-12 * glm::length(size);  // a few roundings of a double
    for (int k = 0; k < 3; ++k) {
      EXPECT_LE(bounds.min[k], drawn.min[k] + slack) << "axis " << k << " of map " << map;
      EXPECT_GE(bounds.max[k], drawn.max[k] - slack) << "axis " << k << " of map " << map;
      EXPECT_GE(bounds.min[k], drawn.min[k] - share * size[k]) << "axis " << k << " of map " << map;
      EXPECT_LE(bounds.max[k], drawn.max[k] + share * size[k]) << "axis " << k << " of map " << map;
    }
  }
}

// 20,000 points of a surface leave gaps of 1 % of its size, and corners are the worst: 4 % of a
// side there.
constexpr double drawn_share = 0.04;

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

TEST(Bounds, PartsOfQuadrics) {
  const double angles[] = {0.3, 1.9, 3.5, 5.9, full_turn};
  for (const double phi_max : angles)
    for (const auto& [low, high] : {std::pair{-2.0, 2.0}, {-1.5, 0.5}, {0.5, 1.9}, {-2.0, -1.0}}) {
      SCOPED_TRACE(testing::Message()
                   << "phi up to " << phi_max << ", z from " << low << " to " << high);
      Shape shape;
      shape.geometry = PartialSphereShape{2, low, high, phi_max};
      const auto on = [](double rho, double phi, double z) {
        return dvec3(rho * std::cos(phi), rho * std::sin(phi), z);
      };
      expect_bounds(
          shape,
          [&, z_min = low, z_max = high](std::mt19937& random) {
            const double z = uniform(random, z_min, z_max);
            return on(std::sqrt(4 - z * z), uniform(random, 0, phi_max), z);
          },
          6, drawn_share);
      shape.geometry = OpenCylinderShape{2, low, high, phi_max};
      expect_bounds(
          shape,
          [&, z_min = low, z_max = high](std::mt19937& random) {
            return on(2, uniform(random, 0, phi_max), uniform(random, z_min, z_max));
          },
          6, drawn_share);
    }
  for (const double phi_max : angles) {
    Shape shape;
    shape.geometry = DiskShape{0.5, 2, 1.2, phi_max};
    expect_bounds(
        shape,
        [&](std::mt19937& random) {
          const double rho = uniform(random, 1.2, 2), phi = uniform(random, 0, phi_max);
          return dvec3(rho * std::cos(phi), rho * std::sin(phi), 0.5);
        },
        6, drawn_share);
  }
}

std::shared_ptr<const Shape> operand(const decltype(Shape::geometry)& geometry,
                                     const glm::dmat4& object_from_operand = glm::dmat4(1)) {
  auto shape = std::make_shared<Shape>();
  shape->geometry = geometry;
  shape->world_from_object = object_from_operand;
  return shape;
}

/// Draws points of a box until `inside` takes one.
std::function<dvec3(std::mt19937&)> drawn_from(const dvec3& low, const dvec3& high,
                                               const std::function<bool(const dvec3&)>& inside) {
  return [=](std::mt19937& random) {
    for (;;) {
      const dvec3 p(uniform(random, low.x, high.x), uniform(random, low.y, high.y),
                    uniform(random, low.z, high.z));
      if (inside(p)) return p;
    }
  };
}

// This is a share of the box that the search starts from, which is up to three times as wide here.
// Points within a solid meet its tips more rarely than those on a surface.
constexpr double csg_share = 3.0 / 64 + 2 * drawn_share;

TEST(Bounds, LensOfTwoSpheres) {
  using enum CsgShape::Operation;
  Shape shape;
  shape.geometry =
      CsgShape{set_intersection,
               {operand(SphereShape{1}, glm::translate(glm::dmat4(1), dvec3(-.8, 0, 0))),
                operand(SphereShape{1}, glm::translate(glm::dmat4(1), dvec3(.8, 0, 0)))}};
  const Bounds bounds = bounds_of(shape);
  // The rim has the radius sqrt(1 - 0.8^2), where the surfaces meet at a slant: two parts of 1/128
  // of a box 1.2 to 1.3 wide.
  for (int k = 1; k < 3; ++k) {
    EXPECT_GE(bounds.max[k], 0.6);
    EXPECT_LE(bounds.max[k], 0.6 + 2 * 1.3 / 128);
  }
  EXPECT_GE(bounds.max.x, 0.2 - 1e-15);
  EXPECT_LE(bounds.max.x, 0.2 + 0.4 / 64);
  const auto inside = drawn_from({-.2, -.6, -.6}, {.2, .6, .6}, [](const dvec3& p) {
    return glm::length(p - dvec3(.8, 0, 0)) <= 1 && glm::length(p + dvec3(.8, 0, 0)) <= 1;
  });
  const auto inside_or_rim = [&](std::mt19937& random) {
    const double angle = uniform(random, -pi, pi);
    return angle > 0 ? inside(random)
                     : dvec3(0, 0.6 * std::cos(2 * angle), 0.6 * std::sin(2 * angle));
  };
  expect_bounds(shape, inside_or_rim, 6, csg_share);
}

TEST(Bounds, DifferencesAndHulls) {
  using enum CsgShape::Operation;
  Shape shape;
  // A flat-capped cylinder along x with a half-space cut off, and a frustum with a ball at its end
  // around it.
  shape.geometry = CsgShape{
      set_difference,
      {operand(CylinderShape{{-2, 0, 0}, {2, 0, 0}, 1, {Cap::flat, Cap::round}}),
       operand(BoxShape{{0.5, -9, -9}, {9, 9, 9}}), operand(BoxShape{{-9, 0.25, -9}, {9, 9, 9}})}};
  expect_bounds(shape,
                drawn_from({-2, -1, -1}, {.5, .25, 1},
                           [](const dvec3& p) { return p.y * p.y + p.z * p.z <= 1; }),
                5, csg_share);
  const Bounds cut = bounds_of(shape);
  EXPECT_LE(cut.max.x, 0.5 + 5.0 / 64);
  EXPECT_LE(cut.max.y, 0.25 + 2.0 / 64);
  // A cone from a disk of radius 2 at z = 0 to a ball of radius 1 at z = 3, within a ball: by the
  // hull's own definition.
  shape.geometry =
      CsgShape{set_intersection,
               {operand(ConeShape{{0, 0, 0}, {0, 0, 3}, {2, 1}, {Cap::flat, Cap::round}}),
                operand(SphereShape{1.5}, glm::translate(glm::dmat4(1), dvec3(0, 0, 3)))}};
  expect_bounds(shape,
                drawn_from({-1.5, -1.5, 1.5}, {1.5, 1.5, 4},
                           [](const dvec3& p) {
                             if (glm::length(p - dvec3(0, 0, 3)) > 1.5) return false;
                             const double rho = std::hypot(p.x, p.y);
                             for (int i = 0; i <= 100; ++i) {
                               const double s = i / 100.0;
                               if (std::hypot(std::max(rho - 2 * (1 - s), 0.0), p.z - 3 * s) <= s)
                                 return true;
                             }
                             return false;
                           }),
                3, csg_share);
}

// --- Curves ---

dvec3 bezier(const std::vector<dvec3>& p, double t) {
  std::vector<dvec3> points = p;
  for (std::size_t left = p.size() - 1; left > 0; --left)
    for (std::size_t i = 0; i < left; ++i) points[i] = (1 - t) * points[i] + t * points[i + 1];
  return points[0];
}

/// De Boor's algorithm on integer knots: the point at `t` from 0 to 1 of segment `at`.
dvec3 b_spline(const std::vector<dvec3>& p, std::size_t at, std::size_t degree, double t) {
  std::vector<dvec3> points(p.begin() + static_cast<std::ptrdiff_t>(at),
                            p.begin() + static_cast<std::ptrdiff_t>(at + degree + 1));
  for (std::size_t level = 1; level <= degree; ++level)
    for (std::size_t i = degree; i >= level; --i) {
      // Control point i has the knots i - degree .. i + 1 of the segment [0, 1].
      const double alpha =
          (t + static_cast<double>(degree - i)) / static_cast<double>(degree + 1 - level);
      points[i] = (1 - alpha) * points[i - 1] + alpha * points[i];
    }
  return points[degree];
}

double distance_to_chain(const CapsulesShape& chain, const dvec3& p) {
  double least = INFINITY;
  for (std::size_t i = 0; i < chain.p0.size(); ++i) {
    const dvec3 a(chain.p0[i]), b(chain.p1[i]);
    const double squared = glm::dot(b - a, b - a);
    const double s = squared > 0 ? std::clamp(glm::dot(p - a, b - a) / squared, 0.0, 1.0) : 0;
    least = std::min(least, glm::length(p - a - s * (b - a)));
  }
  return least;
}

struct CurveCase {
  const char* name;
  const char* basis;
  std::size_t degree;
  std::size_t points;
};
void PrintTo(const CurveCase& row, std::ostream* out) { *out << row.name; }

class Curves : public testing::TestWithParam<CurveCase> {};

TEST_P(Curves, StayWithinTheToleranceOfTheCurve) {
  const CurveCase& row = GetParam();
  const bool is_bezier = std::string(row.basis) == "bezier";
  std::mt19937 random(11);
  std::vector<dvec3> points;
  std::string text;
  Bounds bounds;
  for (std::size_t i = 0; i < row.points; ++i) {
    // Eighths: exact as text and as floats.
    dvec3 p;
    for (int k = 0; k < 3; ++k) p[k] = std::floor(uniform(random, -16, 16)) / 8;
    points.push_back(p);
    bounds.extend(p);
    text += std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + " ";
  }
  const double size = glm::length(bounds.max - bounds.min);
  const std::size_t segments = is_bezier ? (row.points - 1) / row.degree : row.points - row.degree;
  const auto at = [&](double t) {  // 0 to 1 over the whole curve
    const double along = t * static_cast<double>(segments);
    const std::size_t segment = std::min(static_cast<std::size_t>(along), segments - 1);
    const double local = along - static_cast<double>(segment);
    if (!is_bezier) return b_spline(points, segment, row.degree, local);
    const auto begin = points.begin() + static_cast<std::ptrdiff_t>(segment * row.degree);
    return bezier({begin, begin + static_cast<std::ptrdiff_t>(row.degree + 1)}, local);
  };
  for (const auto& [width0, width1] : {std::pair{0.25, 0.125}, {0.001, 0.001}}) {
    const Scene scene =
        world_of("Shape \"curve\" \"string type\" \"cylinder\" \"string basis\" \"" +
                 std::string(row.basis) + "\" \"integer degree\" " + std::to_string(row.degree) +
                 " \"point3 P\" [" + text + "] \"float width0\" " + std::to_string(width0) +
                 " \"float width1\" " + std::to_string(width1));
    const auto& chain = geometry_of<CapsulesShape>(scene);
    // The tolerance is that of the documentation; ends are rounded to floats once more.
    const double tolerance = std::max(1e-3 * width0, 1e-5 * size) + 0x1p-23 * size;
    for (int i = 0; i <= 2000; ++i)
      EXPECT_LE(distance_to_chain(chain, at(i / 2000.0)), tolerance) << i;
    expect_near(dvec3(chain.p0.front()), at(0), tolerance);
    expect_near(dvec3(chain.p1.back()), at(1), tolerance);
    for (std::size_t i = 1; i < chain.p0.size(); ++i) EXPECT_EQ(chain.p0[i], chain.p1[i - 1]);
    // u is the parameter of each cubic, of which pbrt-v4 makes a curve: from 0 to 1, the same at
    // both sides of each joint.
    ASSERT_EQ(chain.u.size(), chain.p0.size());
    std::size_t segment = 0;
    for (std::size_t i = 0; i < chain.u.size(); ++i) {
      if (i > 0 && chain.u[i].x == 0) {
        EXPECT_EQ(chain.u[i - 1].y, 1);
        ++segment;
      } else {
        EXPECT_EQ(chain.u[i].x, i == 0 ? 0 : chain.u[i - 1].y);
      }
      const double share = (static_cast<double>(segment) + static_cast<double>(chain.u[i].y)) /
                           static_cast<double>(segments);
      expect_near(dvec3(chain.p1[i]), at(std::min(share, 1 - 1e-12)),
                  1e-10 * size + 0x1p-23 * size);
    }
    EXPECT_EQ(segment + 1, segments);
    EXPECT_EQ(chain.u.back().y, 1);
    EXPECT_EQ(chain.radius0.front(), static_cast<float>(width0 / 2));
    EXPECT_EQ(chain.radius1.empty(), width0 == width1);
    if (!chain.radius1.empty()) {
      EXPECT_EQ(chain.radius1.back(), static_cast<float>(width1 / 2));
      for (std::size_t i = 1; i < chain.p0.size(); ++i)
        EXPECT_EQ(chain.radius0[i], chain.radius1[i - 1]);
    }
    // An even chord of a cubic of this size needs about sqrt(size / (8 tolerance)) pieces a
    // segment; ten times that is waste.
    EXPECT_LE(static_cast<double>(chain.p0.size()),
              10 * static_cast<double>(segments) * std::sqrt(size / (8 * tolerance)));
  }
}

INSTANTIATE_TEST_SUITE_P(Import, Curves,
                         testing::Values(CurveCase{"Cubic", "bezier", 3, 10},
                                         CurveCase{"Quadratic", "bezier", 2, 7},
                                         CurveCase{"CubicSpline", "bspline", 3, 8},
                                         CurveCase{"QuadraticSpline", "bspline", 2, 8}),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(Curves, TypesAreAllRoundTubes) {
  const std::string rest =
      " \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0] \"float width\" .5 \"integer splitdepth\" 2\n";
  const Scene scene =
      world_of("Shape \"curve\"" + rest + "Shape \"curve\" \"string type\" \"cylinder\"" + rest +
               "Shape \"curve\" \"string type\" \"ribbon\" \"normal N\" [0 0 1 0 1 0]" + rest);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& chain = geometry_of<CapsulesShape>(scene, i);
    // A straight line of even speed is one capsule.
    ASSERT_EQ(chain.p0.size(), 1u);
    EXPECT_EQ(chain.p1[0], glm::vec3(3, 0, 0));
    EXPECT_EQ(chain.radius0[0], 0.25f);
    EXPECT_EQ(chain.u, (std::vector<glm::vec2>{{0, 1}}));
  }
  EXPECT_EQ(count_primitives(scene), (std::map<std::string, std::uint64_t>{{"capsule", 3}}));
}

TEST(Curves, UGoesOverAllPiecesWhereThatIsAskedFor) {
  const std::string curve =
      "Shape \"curve\" \"string urange\" \"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0 4 0 0 5 0 "
      "0 6 0 0 7 0 0 8 0 0 9 0 0]";
  const Scene scene = world_of(curve);
  const auto& chain = geometry_of<CapsulesShape>(scene);
  // Three straight pieces of even speed.
  EXPECT_EQ(chain.u, (std::vector<glm::vec2>{{0, 1.0f / 3}, {1.0f / 3, 2.0f / 3}, {2.0f / 3, 1}}));
  EXPECT_THAT(complaints("Camera \"perspective\"\nWorldBegin\nShape \"curve\" \"string urange\" "
                         "\"all\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0]"),
              testing::ElementsAre(
                  testing::HasSubstr("\"urange\" must be \"piece\" or \"curve\", not \"all\"")));
}

TEST(Curves, OfOnePointAreSpheres) {
  const Scene scene = world_of("Shape \"curve\" \"point3 P\" [1 1 1 1 1 1 1 1 1 1 1 1]");
  const auto& chain = geometry_of<CapsulesShape>(scene);
  ASSERT_EQ(chain.p0.size(), 1u);
  EXPECT_EQ(chain.p0[0], chain.p1[0]);
}

TEST(SharedCurves, Load) {
  CAPLET_NEEDS_DATA();
  const std::string file =
      (data_folder() / "fibres" / "pbrt_curve" / "blonde_one_hair.pbrt").string();
  const Scene scene = world_of("Include \"" + file + "\"");
  EXPECT_GT(count_primitives(scene).at("capsule"), 50u);
}

}  // namespace
}  // namespace caplet::test::shapes_test
