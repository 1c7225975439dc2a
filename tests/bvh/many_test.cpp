// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Rays that go through the tree many at once find what they find one after the other, to the bit:
// pools and streams, in the device's own way and the portable one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "device_tracer.h"
#include "random_scene.h"
#include "support/test_device.h"

namespace caplet::test {
namespace {

using Manner = DeviceTracer::Manner;

struct Way {
  std::string name, options;
  Manner manner;
};
const Way ways[] = {{"pool", "", Manner::pool},
                    {"portable_pool", "-DCAPLET_PORTABLE", Manner::pool},
                    {"narrow_pool", "-DCAPLET_POOL_RAYS=3", Manner::pool},
                    {"stream", "", Manner::stream},
                    {"portable_stream", "-DCAPLET_PORTABLE", Manner::stream},
                    {"narrow_stream", "-DCAPLET_STREAM_RAYS=8", Manner::stream}};

class Many : public testing::TestWithParam<std::size_t> {
 protected:
  // A work-item has some 130 kB of rays and stacks. A GPU sets that aside for each of the 270,000
  // that it can run at once, and may not have so much (CL_OUT_OF_HOST_MEMORY).
  void SetUp() override {
    if (!test_device().is_cpu())
      GTEST_SKIP() << "the tracing of many rays by a work-item is for processors; the tests run on "
                   << test_device().info().name;
  }
  const Way& way() const { return ways[GetParam()]; }
  DeviceTracer tracer_{test_device(), 8, way().options, {}, way().manner};
  DeviceTracer one_by_one_{test_device(), 8, "", {}, Manner::one_by_one};

  /// Number of rays that hit.
  int compare(const std::vector<RayRecord>& rays) {
    const auto hits = same_hits(tracer_, one_by_one_, rays);
    return static_cast<int>(
        std::ranges::count_if(hits, [](const HitRecord& hit) { return hit.slot != CAPLET_NONE; }));
  }
  void upload(const Encoded& scene) {
    for (DeviceTracer* tracer : {&tracer_, &one_by_one_})
      tracer->upload(scene.nodes, scene.leaves, {}, scene.tree.root);
  }
};
INSTANTIATE_TEST_SUITE_P(Ways, Many, testing::Range(std::size_t{0}, std::size(ways)),
                         [](const testing::TestParamInfo<std::size_t>& one) {
                           return ways[one.param].name;
                         });

TEST_P(Many, AreAsOneByOneOnAllKinds) {
  for (const unsigned kind :
       {unsigned(shape_capsule), unsigned(shape_triangle), unsigned(shape_instance)}) {
    const Encoded scene = encode(random_scene(41 + kind, kind, 3000, 0.1f));
    upload(scene);
    auto rays = random_rays(42, 20001);
    Random random(43);
    for (RayRecord& r : rays)
      if (random.below(3) == 0) {
        r.t_min = random.uniform(0, 0.2f) / (std::abs(r.dx) + std::abs(r.dy) + std::abs(r.dz));
        r.t_max = 8 * r.t_min;
      }
    EXPECT_GT(compare(rays), 1000);
  }
}

TEST_P(Many, AreAsOneByOneThroughInstances) {
  PlacedScene scene = placed_scene(51, 60);
  for (std::size_t i = 0; i < scene.instances.size(); i += 7)
    scene.instances[i].flags = CAPLET_INSTANCE_NO_ENTERING;
  for (DeviceTracer* tracer : {&tracer_, &one_by_one_})
    tracer->upload(scene.nodes, scene.leaves, scene.instances, scene.world.root);
  auto rays = random_rays(52, 20001);
  for (RayRecord& r : rays) r.ox *= 2, r.oy *= 2, r.oz *= 2;
  EXPECT_GT(compare(rays), 1000);
  // Side by side, as camera rays are: many of them meet the same instance.
  for (std::size_t i = 0; i < rays.size(); i++) {
    const float x = static_cast<float>(i % 128) / 64 - 1, y = static_cast<float>(i / 128) / 78 - 1;
    rays[i] = {0.3f, -0.2f, -14, 0, 0.5f * x, 0.5f * y, 1, INFINITY};
  }
  EXPECT_GT(compare(rays), 1000);
}

TEST_P(Many, OfAnyNumberAndWithOnesThatAreNone) {
  const Encoded scene = encode(random_scene(44, shape_capsule, 500, 0.3f));
  upload(scene);
  for (const int count : {1, 7, 23, 24, 25, 127, 128, 129, 300, 2500}) {
    auto rays = random_rays(45 + static_cast<unsigned>(count), count);
    for (std::size_t i = 0; i < rays.size(); i += 5) rays[i].dx = rays[i].dy = rays[i].dz = 0;
    for (std::size_t i = 1; i < rays.size(); i += 5) rays[i].t_max = rays[i].t_min;
    for (std::size_t i = 2; i < rays.size(); i += 25) rays[i].oy = NAN;
    compare(rays);
  }
}

// Capsules are looked at roughly before they are tested (capsule_near): rays along their
// silhouettes, from near and far, at many scales and far from the world's origin, must pass.
TEST_P(Many, RaysAlongSilhouettesAreSeen) {
  Random random(46);
  for (const float scale : {1e-8f, 1e-3f, 1.0f, 1e5f}) {
    for (const float off : {0.0f, 30.0f}) {
      for (const float thin : {0.5f, 0.01f, 1e-4f}) {
        std::vector<FlatPrimitive> primitives;
        std::vector<RayRecord> rays;
        for (std::uint32_t i = 0; i < 200; ++i) {
          FlatPrimitive p{shape_capsule, i, {}};
          float length = 0, axis[3];
          for (int k = 0; k < 3; ++k) {
            p.data[k] = scale * (off + random.uniform(-1, 1));
            p.data[3 + k] = p.data[k] + scale * 0.2f * random.uniform(-1, 1);
            axis[k] = p.data[3 + k] - p.data[k];
            length += axis[k] * axis[k];
          }
          p.data[6] = thin * std::sqrt(length);
          primitives.push_back(p);
          for (int n = 0; n < 40; ++n) {
            // Across the axis, at a distance of about r from it, or from a point of the axis along
            // it.
            float from[3], to[3],
                across[3] = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
            const float away = n % 2 == 0 ? 3 : 300, place = random.uniform(-0.1f, 1.1f);
            float along = 0, norm = 0;
            for (int k = 0; k < 3; ++k) along += across[k] * axis[k] / length;
            for (int k = 0; k < 3; ++k) {
              across[k] -= along * axis[k];
              norm += across[k] * across[k];
            }
            RayRecord ray{};
            ray.t_max = INFINITY;
            for (int k = 0; k < 3; ++k) {
              to[k] = p.data[k] + place * axis[k] +
                      p.data[6] * (1 + random.uniform(-4, 4) * 1e-7f) * across[k] / std::sqrt(norm);
              from[k] = to[k] + scale * away * random.uniform(-1, 1);
            }
            ray.ox = from[0], ray.oy = from[1], ray.oz = from[2];
            ray.dx = to[0] - from[0], ray.dy = to[1] - from[1], ray.dz = to[2] - from[2];
            rays.push_back(ray);
          }
        }
        const Encoded scene = encode(primitives);
        upload(scene);
        EXPECT_GT(compare(rays), 500) << "scale " << scale << ", off " << off << ", thin " << thin;
      }
    }
  }
}

}  // namespace
}  // namespace caplet::test
