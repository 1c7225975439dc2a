// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Closest and any hit of every shape against brute force in double, in both encodings.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "brute.h"
#include "device_tracer.h"
#include "random_scene.h"
#include "shared/shapes.h"
#include "support/test_device.h"

namespace caplet::test::trace_test {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

class Trace : public testing::TestWithParam<unsigned> {
 protected:
  static DeviceTracer& wide() {
    static DeviceTracer tracer(test_device(), 8);
    return tracer;
  }
  static DeviceTracer& scalar() {
    static DeviceTracer tracer(test_device(), 1);
    return tracer;
  }
};

/// shape_instance stands for all kinds mixed.
INSTANTIATE_TEST_SUITE_P(Shapes, Trace,
                         testing::Values(unsigned(shape_sphere), unsigned(shape_capsule),
                                         unsigned(shape_tapered_capsule), unsigned(shape_triangle),
                                         unsigned(shape_disk), unsigned(shape_instance)));

TEST_P(Trace, AgreesWithBruteForce) {
  for (const float size : {0.05f, 0.5f}) {
    const auto primitives = random_scene(1 + GetParam(), GetParam(), 300, size);
    const Encoded scene = encode(primitives);
    const auto rays = random_rays(77, 1500 * test_scale());
    wide().upload(scene.nodes, scene.leaves, {}, scene.tree.root);
    const auto hits = wide().closest(rays);
    int wrong = 0, hit = 0;
    for (std::size_t i = 0; i < rays.size(); i++) {
      const std::string text = disagreement(primitives, scene.tree.slots, rays[i], hits[i]);
      if (!text.empty() && wrong++ < 5) ADD_FAILURE() << "ray " << i << ": " << text;
      hit += hits[i].slot != CAPLET_NONE ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(hit, 20);
  }
}

TEST_P(Trace, EncodingsAgreeAndAnyIsWhetherClosestExists) {
  const auto primitives = random_scene(9 + GetParam(), GetParam(), 3000, 0.1f);
  const Encoded scene = encode(primitives);
  auto rays = random_rays(5, 20000);
  Random random(6);
  for (RayRecord& r : rays) {
    r.t_min = random.uniform(0, 0.2f) / (std::abs(r.dx) + std::abs(r.dy) + std::abs(r.dz));
    r.t_max = random.below(2) == 0 ? inf : 4 * r.t_min;
  }
  wide().upload(scene.nodes, scene.leaves, {}, scene.tree.root);
  scalar().upload(scene.nodes, scene.leaves, {}, scene.tree.root);
  const auto a = wide().closest(rays), b = scalar().closest(rays);
  const auto any_a = wide().any(rays), any_b = scalar().any(rays);
  int different = 0, hit = 0;
  for (std::size_t i = 0; i < rays.size(); i++) {
    const bool exists = a[i].slot != CAPLET_NONE;
    hit += exists ? 1 : 0;
    ASSERT_EQ(any_a[i] != 0, exists) << i;
    ASSERT_EQ(any_b[i] != 0, b[i].slot != CAPLET_NONE) << i;
    if (a[i].slot == b[i].slot && a[i].surface == b[i].surface) {
      // Each is within 16 eps of the true distance relative to the origin's distance and the size,
      // both at most 6 here; grazing hits are where that is magnified along the ray, checked by the
      // surface distance in AgreesWithBruteForce.
      if (exists && std::abs(a[i].t - b[i].t) > 1e-5f * std::abs(a[i].t)) different++;
    } else {
      different++;
    }
  }
  EXPECT_GT(hit, 1000);
  // Contraction may differ between the two texts; what is left are rays that graze a silhouette
  // within the bound: an interval of 2e-6 around a silhouette of size 0.1 is met by one ray in 1e4
  // a primitive in the way.
  EXPECT_LE(different, 10);
}

TEST_P(Trace, KernelsForTheseShapesAloneAndWithMoreBitsForTheirKindSeeTheSame) {
  const auto primitives = random_scene(19 + GetParam(), GetParam(), 2000, 0.1f);
  std::uint64_t shapes = 0;
  for (const FlatPrimitive& p : primitives) shapes |= shape_bit(p.shape);
  const auto rays = random_rays(6, 20000);
  const Encoded scene = encode(primitives), roomy = encode(primitives, 6);
  for (const int width : {8, 1}) {
    DeviceTracer &all = width == 8 ? wide() : scalar(),
                 own(test_device(), width, "-DCAPLET_LEAF_KIND_BITS=6", {{"shapes", shapes}});
    all.upload(scene.nodes, scene.leaves, {}, scene.tree.root);
    own.upload(roomy.nodes, roomy.leaves, {}, roomy.tree.root);
    const auto expected = all.closest(rays), seen = own.closest(rays);
    EXPECT_EQ(all.any(rays), own.any(rays));
    int hit = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      hit += seen[i].slot != CAPLET_NONE ? 1 : 0;
      ASSERT_EQ(std::memcmp(&seen[i], &expected[i], sizeof seen[i]), 0) << i;
    }
    EXPECT_GT(hit, 1000);
  }
}

TEST_P(Trace, LimitsOfTheRay) {
  const auto primitives = random_scene(3, GetParam(), 200, 0.4f);
  const Encoded scene = encode(primitives);
  auto rays = random_rays(8, 3000);
  wide().upload(scene.nodes, scene.leaves, {}, scene.tree.root);
  const auto first = wide().closest(rays);
  auto below = rays, at = rays, beyond = rays;
  for (std::size_t i = 0; i < rays.size(); i++) {
    below[i].t_max = first[i].t;                    // the hit itself is not in the open interval
    at[i].t_max = std::nextafter(first[i].t, inf);  // just inside
    beyond[i].t_min = std::isinf(first[i].t) ? 0 : first[i].t;  // the next one
  }
  const auto h_below = wide().closest(below), h_at = wide().closest(at),
             h_beyond = wide().closest(beyond);
  int counted = 0;
  for (std::size_t i = 0; i < rays.size(); i++) {
    if (first[i].slot == CAPLET_NONE) continue;
    counted++;
    EXPECT_EQ(h_below[i].slot, CAPLET_NONE);
    EXPECT_TRUE(std::isinf(h_below[i].t));
    EXPECT_EQ(h_at[i].slot, first[i].slot);
    EXPECT_EQ(h_at[i].t, first[i].t);
    if (h_beyond[i].slot != CAPLET_NONE) {
      EXPECT_GT(h_beyond[i].t, first[i].t);
    }
  }
  EXPECT_GT(counted, 200);
}

TEST_P(Trace, EqualHitsGoToTheSmallerPrimitive) {
  // Every primitive three times, wherever the tree puts them. The greatest numbers come first.
  const auto once = random_scene(13, GetParam(), 150, 0.3f);
  std::vector<FlatPrimitive> primitives;
  for (int copy = 0; copy < 3; ++copy)
    for (const FlatPrimitive& p : once) primitives.push_back(p);
  for (std::size_t i = 0; i < primitives.size(); ++i)
    primitives[i].id = static_cast<std::uint32_t>(primitives.size() - i);
  const Encoded scene = encode(primitives);
  const auto slot = [&](std::size_t i) { return scene.tree.slots[i]; };
  const auto rays = random_rays(14, 3000);
  for (DeviceTracer* tracer : {&wide(), &scalar()}) {
    tracer->upload(scene.nodes, scene.leaves, {}, scene.tree.root);
    int hit = 0;
    for (const HitRecord& h : tracer->closest(rays)) {
      if (h.slot == CAPLET_NONE) continue;
      hit++;
      std::size_t i = 0;
      while (slot(i) != h.slot) i++;
      i %= once.size();
      EXPECT_EQ(h.slot, slot(i + 2 * once.size()));
    }
    EXPECT_GT(hit, 200);
  }
}

// Entries of the stack order by the bits of where the ray enters: a zero with a sign must not get
// there. Rays begin within boxes, and in the planes of their faces through the world's origin.
TEST_P(Trace, ZerosOfEitherSignAreTheSame) {
  const auto primitives = random_scene(15, GetParam(), 400, 0.6f);
  const Encoded scene = encode(primitives);
  std::vector<RayRecord> plus = random_rays(16, 3000);
  for (std::size_t i = 0; i < plus.size(); ++i) {
    RayRecord& r = plus[i];
    if (i % 2 == 0) r.ox *= 0.1f, r.oy *= 0.1f, r.oz *= 0.1f;
    if (i % 3 == 0) r.ox = 0;
    if (i % 4 == 0) r.oy = 0;
    if (i % 5 == 0) r.oz = 0;
    if (i % 7 == 0) r.dx = 0;
    r.t_min = 0;
  }
  std::vector<RayRecord> minus = plus;
  for (RayRecord& r : minus) {
    r.t_min = -0.0f;
    for (float* x : {&r.ox, &r.oy, &r.oz, &r.dx, &r.dy, &r.dz})
      if (*x == 0) *x = -0.0f;
  }
  for (DeviceTracer* tracer : {&wide(), &scalar()}) {
    tracer->upload(scene.nodes, scene.leaves, {}, scene.tree.root);
    const auto of_plus = tracer->closest(plus), of_minus = tracer->closest(minus);
    const auto any_of_plus = tracer->any(plus), any_of_minus = tracer->any(minus);
    int hit = 0;
    for (std::size_t i = 0; i < plus.size(); ++i) {
      hit += of_plus[i].slot != CAPLET_NONE;
      EXPECT_EQ(of_plus[i].slot, of_minus[i].slot) << i;
      EXPECT_EQ(of_plus[i].t, of_minus[i].t) << i;
      EXPECT_EQ(any_of_plus[i], any_of_minus[i]) << i;
    }
    EXPECT_GT(hit, 1000);
  }
}

TEST_P(Trace, InvalidRaysMiss) {
  const auto primitives = random_scene(4, GetParam(), 100, 0.5f);
  const Encoded scene = encode(primitives);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<RayRecord> rays;
  for (const float bad : {nan, inf, -inf}) {
    rays.push_back({bad, 0, 0, 0, 0, 0, 1, inf});
    rays.push_back({0, 0, 0, 0, bad, 0, 1, inf});
    rays.push_back({0, bad, 0, 0, 0, bad, 1, inf});
  }
  rays.push_back({0, 0, 0, 0, 0, 0, 0, inf});       // zero direction
  rays.push_back({0, 0, 0, nan, 1, 0, 0, nan});     // no interval
  rays.push_back({0, 0, 0, 2, 1, 0, 0, 1});         // empty interval
  rays.push_back({0, 0, 0, 0, 1e-30f, 0, 0, inf});  // |d|^2 underflows
  for (DeviceTracer* tracer : {&wide(), &scalar()}) {
    tracer->upload(scene.nodes, scene.leaves, {}, scene.tree.root);
    const auto hits = tracer->closest(rays);
    const auto any = tracer->any(rays);
    for (std::size_t i = 0; i < rays.size(); i++) {
      EXPECT_EQ(hits[i].slot, CAPLET_NONE) << i;
      EXPECT_TRUE(std::isinf(hits[i].t)) << i;
      EXPECT_EQ(any[i], 0) << i;
    }
  }
}

}  // namespace
}  // namespace caplet::test::trace_test
