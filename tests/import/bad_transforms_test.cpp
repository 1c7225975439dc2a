// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Transforms and lenses that 32-bit floats cannot hold are refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "scene/scene.h"

namespace caplet::test {
namespace {

Scene sphere_scene() {
  Scene scene;
  scene.materials.emplace_back();
  scene.shapes.emplace_back();
  scene.shapes[0].where = {"here", 1, 2};
  return scene;
}

std::string complaint(const Scene& scene) {
  Diagnostics diagnostics;
  validate(scene, diagnostics);
  try {
    diagnostics.finish();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

// The determinant by itself tells little: a disk of a thickness of 1e-10 is sound.
TEST(Model, TransformsBeyondFloats) {
  Scene scene = sphere_scene();
  scene.shapes[0].world_from_object[2][2] = 1e-10;
  EXPECT_EQ(complaint(scene), "");
  for (const double scale : {1e-300, 1e-45, 1e-19, 1e19, 1e100}) {
    scene.shapes[0].world_from_object[2][2] = scale;
    EXPECT_THAT(complaint(scene), testing::HasSubstr("where 32-bit floats end")) << scale;
  }
}

TEST(Model, LensesBeyondFloats) {
  Scene scene = sphere_scene();
  scene.view.camera.lens_radius = 1;
  scene.view.camera.focal_distance = 1e-10;
  EXPECT_EQ(complaint(scene), "");
  for (const auto& [radius, distance] : {std::pair{1.0, 1e-40}, {1e19, 1e19}, {1e10, 1e-10}}) {
    scene.view.camera.lens_radius = radius;
    scene.view.camera.focal_distance = distance;
    EXPECT_THAT(complaint(scene), testing::HasSubstr("where 32-bit floats end"))
        << radius << " at " << distance;
  }
}

}  // namespace
}  // namespace caplet::test
