// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Numbers at the ends of a float, as fuzzing found them (docs/testing.md, "Sanitised kernels").
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene_probe.h"
#include "shared/kinds.h"

namespace caplet::test {
namespace {

RayRecord ray_along_z(float x, float y, float scale) {
  return {x, y, -5 * scale, 0, 0, 0, scale, HUGE_VALF};
}

// The direction overflows in the object's space: empty places of a node, whose bounds are infinite,
// then seemed to be met, and what they name was read.
TEST(Extremes, RayThatOverflowsInAnInstanceMisses) {
  const glm::dmat4 squeezed = glm::scale(glm::dmat4(1), glm::dvec3(1, 2, 3));
  FlatScene scene = lower_shapes({shape_of(SphereShape{1}, squeezed)});
  ASSERT_EQ(scene.instances.size(), 1u);
  for (float& entry : scene.instances[0].object_from_world) entry *= 1e30f;
  for (const int width : {8, 1})
    for (const float scale : {1e9f, 1e15f, 1e18f}) {
      const std::vector<SceneHit> hits =
          trace(scene, {ray_along_z(0.1f, 0.2f, scale), ray_along_z(-0.1f, 0, -scale)}, width);
      for (const SceneHit& hit : hits) {
        EXPECT_EQ(hit.found, 0u) << "width " << width << " scale " << scale;
        EXPECT_EQ(hit.any, 0u);
      }
    }
}

template <class Mesh>
Shape square(std::vector<glm::vec2> uvs) {
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}};
  mesh.uvs = std::move(uvs);
  if constexpr (std::is_same_v<Mesh, TriangleMeshShape>)
    mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
  else
    mesh.patches = {{0, 1, 2, 3}};
  return shape_of(std::move(mesh));
}

// Products of large uvs overflow and those of tiny ones vanish: the derivatives by them are then
// zero, as where they are undefined, and uv itself lies between those of the corners.
TEST(Extremes, DerivativesByExtremeUvAreFinite) {
  for (const float size : {FLT_MAX, 1e28f, 1e-30f, FLT_MIN, 0x1p-149f}) {
    const std::vector<glm::vec2> uvs = {{-size, -size}, {size, -size}, {-size, size}, {size, size}};
    for (const Shape& shape : {square<TriangleMeshShape>(uvs), square<BilinearMeshShape>(uvs)}) {
      const FlatScene scene = lower_shapes({shape});
      for (const int width : {8, 1})
        for (const SceneHit& hit :
             trace(scene, {ray_along_z(0.3f, 0.4f, 1), ray_along_z(-0.25f, -0.5f, 1)}, width)) {
          ASSERT_EQ(hit.found, 1u);
          for (int i = 0; i < 3; ++i) {
            EXPECT_TRUE(std::isfinite(hit.dpdu[i]) && std::isfinite(hit.dpdv[i]))
                << "uv of size " << size;
            EXPECT_TRUE(std::isfinite(hit.ng[i]) && std::isfinite(hit.ns[i]));
          }
          EXPECT_LE(std::abs(hit.u), size);
          EXPECT_LE(std::abs(hit.v), size);
        }
    }
  }
}

}  // namespace
}  // namespace caplet::test
