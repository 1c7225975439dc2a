// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Placed objects against the same primitives intersected in object space by brute force.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <glm/mat4x4.hpp>

#include "brute.h"
#include "device_tracer.h"
#include "random_scene.h"
#include "shared/kinds.h"
#include "support/test_device.h"

namespace caplet::test {
namespace {

TEST(Instances, AgreeWithBruteForceInObjectSpace) {
  const PlacedScene scene = placed_scene(21, 40);
  const auto& [nodes, leaves, primitives, world_primitives, object, world, instances] = scene;
  auto rays = random_rays(24, 600 * test_scale());
  for (RayRecord& r : rays) r.ox *= 2, r.oy *= 2, r.oz *= 2;

  for (const int width : {8, 1}) {
    DeviceTracer tracer(test_device(), width);
    tracer.upload(nodes, leaves, instances, world.root);
    const auto hits = tracer.closest(rays);
    const auto any = tracer.any(rays);
    unsigned in_instance = 0, in_world = 0;
    for (std::size_t i = 0; i < rays.size(); i++) {
      const HitRecord& hit = hits[i];
      const double t = hit.slot == CAPLET_NONE ? double(INFINITY) : double(hit.t);
      EXPECT_EQ(any[i] != 0, hit.slot != CAPLET_NONE);
      in_instance += hit.slot != CAPLET_NONE && hit.instance != CAPLET_NONE ? 1 : 0;
      in_world += hit.slot != CAPLET_NONE && hit.instance == CAPLET_NONE ? 1 : 0;
      const DoubleRay ray = widen(rays[i]);
      for (unsigned j = 0; j <= instances.size(); j++) {
        const bool placed = j < instances.size();
        DoubleRay local = ray;
        double rounding = 0;  // of the ray's transform: 4 products and sums a component, each
                              // within eps of its terms
        if (placed) {
          const float* m = instances[j].object_from_world;
          for (std::size_t k = 0; k < 3; k++) {
            local.o[k] = double(m[4 * k + 3]);
            local.d[k] = 0;
            double terms = std::abs(double(m[4 * k + 3]));
            for (std::size_t c = 0; c < 3; c++) {
              local.o[k] += double(m[4 * k + c]) * ray.o[c];
              local.d[k] += double(m[4 * k + c]) * ray.d[c];
              terms += std::abs(double(m[4 * k + c]) * ray.o[c]);
              if (std::isfinite(t)) terms += std::abs(double(m[4 * k + c]) * ray.d[c] * t);
            }
            rounding += 4 * 0x1p-24 * terms;
          }
        }
        const auto& tested = placed ? primitives : world_primitives;
        for (std::size_t p = 0; p < tested.size(); p++) {
          const double error = claimed_error(tested[p], local) + rounding;
          const std::uint32_t slot = placed ? object.slots[p] : world.slots[p];
          if (hit.slot == slot && hit.instance == (placed ? j : CAPLET_NONE)) {
            const Vec x = {local.o[0] + t * local.d[0], local.o[1] + t * local.d[1],
                           local.o[2] + t * local.d[2]};
            EXPECT_LE(std::abs(surface_distance(tested[p], x)), error) << "ray " << i;
          }
          const double latest = latest_hit(tested[p], local, error);
          EXPECT_TRUE(t <= latest || latest >= ray.t_max)
              << "ray " << i << " passed primitive " << p << " of instance " << j;
        }
      }
    }
    EXPECT_GT(in_instance, 100u);
    EXPECT_GT(in_world, 10u);
  }
}

TEST(Instances, EqualHitsGoToTheWorldThenToTheFirstInstance) {
  Encoded scene;
  const EncodedTree object =
      encode_tree(random_scene(31, shape_sphere, 20, 1), scene.nodes, scene.leaves);
  std::vector<InstanceRecord> instances(5);
  std::vector<FlatPrimitive> top;
  for (unsigned i = 0; i < instances.size(); i++) {
    place(instances[i], glm::dmat4(1));
    instances[i].root = object.root;
    instances[i].object = 9 - i;  // the last is the first of the scene
    FlatPrimitive box{shape_instance, i, {}};
    std::copy(object.min, object.min + 3, box.data);
    std::copy(object.max, object.max + 3, box.data + 3);
    top.push_back(box);
  }
  const EncodedTree placed = encode_tree(top, scene.nodes, scene.leaves);
  // The same spheres in the world too, of greater numbers.
  for (FlatPrimitive sphere : random_scene(31, shape_sphere, 20, 1)) {
    sphere.id += 1000;
    top.push_back(sphere);
  }
  const EncodedTree both = encode_tree(top, scene.nodes, scene.leaves);
  for (const bool in_world : {false, true}) {
    DeviceTracer tracer(test_device(), test_width());
    tracer.upload(scene.nodes, scene.leaves, instances, in_world ? both.root : placed.root);
    int hit = 0;
    for (const HitRecord& h : tracer.closest(random_rays(32, 500))) {
      if (h.slot == CAPLET_NONE) continue;
      EXPECT_EQ(h.instance, in_world ? CAPLET_NONE : 4u);
      hit++;
    }
    EXPECT_GT(hit, 100);
  }
}

}  // namespace
}  // namespace caplet::test
