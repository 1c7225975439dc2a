// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Meshes whose vertices move: hits are to the bit those of the mesh that stands still as it is at
// the ray's time.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "frozen_hits.h"
#include "lower/lower.h"
#include "render/query.h"
#include "render_scene.h"
#include "scene/frozen.h"
#include "scene/shapes/mesh_motion.h"
#include "shared/shapes.h"
#include "support/rays.h"

namespace caplet::test::meshes_test {
namespace {

using glm::vec3;

/// A grid of n x n cells whose vertices are anywhere in a cube at each time, with or without
/// normals, uvs, and faces that normals turn over.
TriangleMeshShape random_mesh(std::uint32_t n, std::vector<double> times, bool has_normals,
                              bool has_uvs, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto vector = [&] { return vec3(unit(random), unit(random), unit(random)); };
  TriangleMeshShape out;
  out.times = std::move(times);
  const std::uint32_t row = n + 1;
  std::vector<vec3> normals;
  for (std::uint32_t i = 0; i < row * row; ++i) normals.push_back(vector());
  for (std::size_t key = 0; key < out.times.size(); ++key)
    for (std::uint32_t i = 0; i < row * row; ++i) {
      out.positions.push_back(3.0f * vector());
      // They turn little, so that faces have their outside on one side at all times.
      if (has_normals) out.normals.push_back(normals[i] + 0.1f * vector());
    }
  for (std::uint32_t y = 0; y < n; ++y)
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t at = row * y + x;
      out.triangles.push_back({at, at + 1, at + row});
      out.triangles.push_back({at + 1, at + row + 1, at + row});
    }
  if (has_uvs)
    for (std::uint32_t i = 0; i < row * row; ++i) out.uvs.emplace_back(unit(random), unit(random));
  return out;
}

/// Meshes of the world, of an object that turns, and one that moves only before the shutter opens,
/// from 0.5 to 2 seconds.
Scene moving_scene() {
  Scene scene = scene_of_text(
      "Camera \"perspective\" \"float shutteropen\" 0.5 \"float shutterclose\" 2\nTransformTimes 0 "
      "2\nWorldBegin\nShape \"disk\" \"float radius\" 20 \"float height\" -5\nObjectBegin "
      "\"turned\" Shape \"sphere\" ObjectEnd\nTranslate 1 0 0\nActiveTransform EndTime\nRotate 70 "
      "0 1 1\nActiveTransform All\nObjectInstance \"turned\"\n");
  const auto add = [&](std::vector<Shape>& to, TriangleMeshShape mesh) {
    Shape& shape = to.emplace_back();
    shape.geometry = std::move(mesh);
  };
  add(scene.shapes, random_mesh(3, {0, 0.8, 1.3, 1.9, 4}, false, true, 1));
  add(scene.shapes, random_mesh(2, {0, 2.5}, false, false, 2));
  add(scene.shapes, random_mesh(2, {0, 0.5}, true, false, 3));
  add(scene.objects[0].shapes, random_mesh(2, {0.5, 2}, false, true, 4));
  return scene;
}

TEST(MovingMeshes, AreToTheBitWhatTheyAreAtEachTime) {
  expect_hits_of_frozen(moving_scene(), shape_moving_triangle, {shape_triangle, shape_sphere});
}

// Vertices and normals move evenly from 1 to 2 seconds, and rest before and after; the shutter is
// open longer.
TEST(MovingMeshes, GoStraightAndEvenly) {
  TriangleMeshShape mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {4, 0, 2}, {1, 8, 0}, {0, 1, -4}},
                         {{0, 1, 2}},
                         {{0, 0, 1}, {0, 0, 1}, {0, 0, 3}, {0, 2, 0}, {0, 0, 1}, {0, 0, 5}},
                         {}};
  mesh.times = {1, 2};
  EXPECT_EQ(vertex_count(mesh), 3u);
  const MeshMotion motion(mesh, 0, 4);
  EXPECT_EQ(motion.times().segments(), 3u);
  EXPECT_FALSE(motion.rests());
  for (const auto& [time, share] :
       {std::pair(0.0f, 0.0f), std::pair(0.25f, 0.0f), std::pair(0.3125f, 0.25f),
        std::pair(0.4375f, 0.75f), std::pair(0.5f, 1.0f), std::pair(1.0f, 1.0f)}) {
    for (const TriangleMeshShape& at : {motion.at(time), at_time(mesh, 4 * double{time})}) {
      EXPECT_EQ(
          at.positions,
          (std::vector<vec3>{{4 * share, 0, 2 * share}, {1, 8 * share, 0}, {0, 1, -4 * share}}));
      // Normals are those of unit length in between.
      EXPECT_EQ(at.normals, (std::vector<vec3>{{0, share, 1 - share}, {0, 0, 1}, {0, 0, 1}}));
      EXPECT_EQ(at.triangles, mesh.triangles);
      EXPECT_TRUE(at.times.empty());
    }
  }
  EXPECT_TRUE(MeshMotion(mesh, 2, 5).rests());
  EXPECT_TRUE(MeshMotion(mesh, -3, 4).rests());
}

// What rests while the shutter is open is as light and fast as what never moves.
TEST(MovingMeshes, ThatRestAreTriangles) {
  Scene scene = moving_scene();
  scene.shapes.erase(scene.shapes.begin() + 1, scene.shapes.begin() + 3);
  scene.objects[0].shapes.pop_back();
  const FlatScene flat = lower(scene);
  EXPECT_EQ(flat.shapes & shape_bit(shape_moving_triangle), 0u);
  EXPECT_NE(flat.shapes & shape_bit(shape_triangle), 0u);
}

TEST(MovingMeshes, AreWithinTheirBounds) {
  const TriangleMeshShape mesh = random_mesh(3, {0, 1, 3}, false, false, 5);
  const Bounds bounds = bounds_under(mesh, glm::dmat4(1));
  Bounds swept;
  for (int k = 0; k <= 300; ++k) swept.extend(bounds_under(at_time(mesh, 0.01 * k), glm::dmat4(1)));
  EXPECT_EQ(swept.min, bounds.min);  // vertices that go straight are outermost at its times
  EXPECT_EQ(swept.max, bounds.max);
}

// A mesh that moves is placed by an instance where its shape has a transform, which may mirror it.
// Its outside, which side of it is seen, and its normals are as those of the mesh that rests.
TEST(MovingMeshes, HaveTheSidesOfThoseThatRest) {
  for (const bool mirrored : {false, true})
    for (const bool reversed : {false, true})
      for (const bool has_normals : {false, true})
        for (const bool one_sided : {false, true}) {
          SCOPED_TRACE(std::string(mirrored ? "mirrored " : "") + (reversed ? "reversed " : "") +
                       (has_normals ? "normals " : "") + (one_sided ? "one-sided" : ""));
          Scene scene = scene_of_text("Camera \"perspective\"\nWorldBegin\n");
          Shape& shape = scene.shapes.emplace_back();
          TriangleMeshShape mesh{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}, {}};
          if (has_normals) mesh.normals.assign(3, vec3(0, 0, -1));
          mesh.positions.insert(mesh.positions.end(), mesh.positions.begin(), mesh.positions.end());
          mesh.normals.insert(mesh.normals.end(), mesh.normals.begin(), mesh.normals.end());
          mesh.positions[3].x = -0.5f;
          mesh.times = {0, 1};
          shape.geometry = mesh;
          shape.one_sided = one_sided;
          shape.reverse_orientation = reversed;
          shape.world_from_object = glm::scale(glm::dmat4(1), glm::dvec3(mirrored ? -1 : 1, 1, 1));
          const FlatScene flat = lower(scene), frozen = lower(frozen_at(scene, 0));
          ASSERT_NE(flat.shapes & shape_bit(shape_moving_triangle), 0u);
          for (const double side : {-1.0, 1.0}) {
            const std::vector<RayRecord> ray{make_ray({0.1, 0, 3 * side}, {0, 0, -side})};
            const std::vector<float> time{0};
            const PickRecord ours = Query(flat, test_device()).closest(ray, time)[0],
                             theirs = Query(frozen, test_device()).closest(ray, time)[0];
            EXPECT_EQ(ours.t, theirs.t);
            if (!std::isfinite(ours.t)) continue;
            EXPECT_EQ(ours.leaving, theirs.leaving);
            EXPECT_EQ(ours.normal[2], theirs.normal[2]);
          }
        }
}

}  // namespace
}  // namespace caplet::test::meshes_test
