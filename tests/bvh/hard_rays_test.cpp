// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The rays and shapes that naive formulas get wrong.
#include <gtest/gtest.h>

#include <cmath>

#include "brute.h"
#include "device_tracer.h"
#include "random_scene.h"
#include "shared/kinds.h"
#include "support/test_device.h"

namespace caplet::test::hard_rays_test {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

class HardRays : public testing::TestWithParam<int> {
 protected:
  DeviceTracer tracer_{test_device(), GetParam()};

  /// Traces and compares with brute force; returns how many rays hit.
  int check(const std::vector<FlatPrimitive>& primitives, const std::vector<RayRecord>& rays) {
    const Encoded scene = encode(primitives);
    tracer_.upload(scene.nodes, scene.leaves, {}, scene.tree.root);
    const auto hits = tracer_.closest(rays);
    int hit = 0, wrong = 0;
    for (std::size_t i = 0; i < rays.size(); i++) {
      const std::string text = disagreement(primitives, scene.tree.slots, rays[i], hits[i]);
      if (!text.empty() && wrong++ < 5) ADD_FAILURE() << "ray " << i << ": " << text;
      hit += hits[i].slot != CAPLET_NONE ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0) << "of " << rays.size();
    return hit;
  }
};
INSTANTIATE_TEST_SUITE_P(Widths, HardRays, testing::Values(8, 1));

FlatPrimitive capsule(float ax, float ay, float az, float bx, float by, float bz, float r) {
  return {shape_capsule, 0, {ax, ay, az, bx, by, bz, r, 0, 0}};
}

TEST_P(HardRays, AlongAxesWithZeroAndNegativeZeroComponents) {
  for (const unsigned shape : random_kinds) {
    const auto primitives = random_scene(41 + shape, shape, 100, 0.6f);
    Random random(42);
    std::vector<RayRecord> rays;
    for (int i = 0; i < 600; i++) {
      const float zero = i % 2 == 0 ? 0.0f : -0.0f, sign = i % 4 < 2 ? 1.0f : -1.0f;
      float o[3] = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)},
            d[3] = {zero, zero, zero};
      d[i % 3] = sign;
      o[i % 3] = -2 * sign;
      if (i % 5 == 0) d[(i + 1) % 3] = 0.5f;
      if (i % 7 == 0) o[(i + 2) % 3] = 0;
      rays.push_back({o[0], o[1], o[2], 0, d[0], d[1], d[2], inf});
    }
    EXPECT_GT(check(primitives, rays), 20);
  }
}

TEST_P(HardRays, ParallelToTheCapsule) {
  std::vector<FlatPrimitive> primitives = {capsule(0.1f, -1, 0.2f, 0.1f, 1, 0.2f, 0.25f)};
  std::vector<RayRecord> rays;
  Random random(43);
  for (int i = 0; i < 2000; i++) {
    const float tilt =
        i % 2 == 0 ? 0.0f : random.uniform(-1, 1) * std::exp2(random.uniform(-40, -2));
    const float x = random.uniform(-0.3f, 0.5f), z = random.uniform(-0.2f, 0.6f),
                y = i % 3 == 0 ? random.uniform(-1, 1) : -3.0f;
    rays.push_back({x, y, z, 0, tilt, 1, -tilt * 0.5f, inf});
  }
  EXPECT_GT(check(primitives, rays), 500);
  primitives[0].shape = shape_tapered_capsule;
  primitives[0].data[7] = 0.1f;
  EXPECT_GT(check(primitives, rays), 500);
}

TEST_P(HardRays, GrazingASilhouette) {
  std::vector<RayRecord> rays;
  Random random(44);
  for (int i = 0; i < 3000; i++) {
    const float off =
        0.25f * (1 + (i % 2 == 0 ? 1.0f : -1.0f) * std::exp2(random.uniform(-26, -8)));
    rays.push_back({-2, random.uniform(-1, 1), off, 0, 1, random.uniform(-0.3f, 0.3f), 0, inf});
  }
  for (const unsigned shape : {unsigned(shape_capsule), unsigned(shape_tapered_capsule)}) {
    FlatPrimitive p = capsule(0, -1, 0, 0, 1, 0, 0.25f);
    p.shape = shape;
    p.data[7] = 0.25f;
    EXPECT_GT(check({p}, rays), 500);
  }
}

TEST_P(HardRays, OriginInsideReportsLeaving) {
  for (const unsigned shape :
       {unsigned(shape_sphere), unsigned(shape_capsule), unsigned(shape_tapered_capsule)}) {
    FlatPrimitive p = capsule(0, -1, 0, 0, 1, 0, 0.25f);
    p.shape = shape;
    p.data[7] = 0.2f;
    if (shape == shape_sphere) p.data[1] = 0, p.data[3] = 0.5f;
    const Encoded scene = encode({p});
    tracer_.upload(scene.nodes, scene.leaves, {}, scene.tree.root);
    Random random(45);
    std::vector<RayRecord> rays;
    for (int i = 0; i < 500; i++)
      rays.push_back({random.uniform(-0.1f, 0.1f), random.uniform(-0.1f, 0.1f),
                      random.uniform(-0.1f, 0.1f), 0, random.uniform(-1, 1), random.uniform(-1, 1),
                      random.uniform(-1, 1), inf});
    EXPECT_EQ(check({p}, rays), 500);
    for (const HitRecord& h : tracer_.closest(rays)) EXPECT_EQ(h.surface, 1u << 16);
  }
}

/// Length to radius 1e4 at any angle: the quadratic's discriminant would lose everything (eps L^2 /
/// r = 6 r).
TEST_P(HardRays, ThinCapsules) {
  std::vector<FlatPrimitive> primitives;
  std::vector<RayRecord> rays;
  Random random(46);
  for (int i = 0; i < 100 * test_scale(); i++) {
    FlatPrimitive p =
        random_primitive(random, i % 2 == 0 ? shape_capsule : shape_tapered_capsule, 1);
    p.data[6] = p.data[7] = 1e-4f;
    if (i % 4 == 1) p.data[7] = 3e-5f;
    primitives.push_back(p);
    for (int j = 0; j < 20; j++) {
      const float s = random.uniform(0, 1), reach = random.uniform(0.1f, 3);
      float to[3], from[3];
      for (int k = 0; k < 3; k++) {
        to[k] = p.data[k] + s * (p.data[3 + k] - p.data[k]) + random.uniform(-1, 1) * 1e-4f;
        from[k] = to[k] + random.uniform(-1, 1) * reach;
      }
      rays.push_back(
          {from[0], from[1], from[2], 0, to[0] - from[0], to[1] - from[1], to[2] - from[2], inf});
    }
  }
  EXPECT_GT(check(primitives, rays), 1000);
}

TEST_P(HardRays, FarOrigin) {
  for (const unsigned shape :
       {unsigned(shape_sphere), unsigned(shape_capsule), unsigned(shape_tapered_capsule)}) {
    const auto primitives = random_scene(47, shape, 50, 0.5f);
    Random random(48);
    std::vector<RayRecord> rays;
    for (int i = 0; i < 2000; i++) {
      float o[3], d[3];
      for (int k = 0; k < 3; k++) {
        o[k] = random.uniform(-1, 1) * 2e4f;
        d[k] = random.uniform(-1, 1) - o[k];
      }
      rays.push_back({o[0], o[1], o[2], 0, d[0], d[1], d[2], inf});
    }
    EXPECT_GT(check(primitives, rays), 100);
  }
}

TEST_P(HardRays, FarFromTheWorldsOrigin) {
  for (const unsigned shape : random_kinds) {
    auto primitives = random_scene(49, shape, 50, 0.5f);
    auto rays = random_rays(50, 1000);
    const float shift[3] = {148376, 1234, -223423};
    for (FlatPrimitive& p : primitives)
      for (int k = 0; k < 3; k++) {
        p.data[k] += shift[k];
        if (shape != shape_sphere && shape != shape_disk) p.data[3 + k] += shift[k];
        if (shape == shape_triangle) p.data[6 + k] += shift[k];
      }
    for (RayRecord& r : rays) r.ox += shift[0], r.oy += shift[1], r.oz += shift[2];
    EXPECT_GT(check(primitives, rays), 50);
  }
}

TEST_P(HardRays, DegenerateShapes) {
  const std::vector<FlatPrimitive> primitives = {
      capsule(0, 0, 0, 0, 0, 0, 0.3f),                                // no axis: a sphere
      {shape_tapered_capsule, 0, {1, 0, 0, 1, 0, 0, 0.2f, 0.3f, 0}},  // likewise
      {shape_tapered_capsule,
       0,
       {0, 1, 0, 0.1f, 1, 0, 0.5f, 0.1f, 0}},                        // one sphere inside the other
      {shape_tapered_capsule, 0, {-1, 0, 0, -1, 1, 0, 0.2f, 0, 0}},  // a pointed end
      capsule(-1, -1, 0, 1, -1, 0, 1e-20f)};  // thinner than any ray can resolve
  EXPECT_GT(check(primitives, random_rays(51, 3000 * test_scale())), 300);
}

TEST_P(HardRays, DegenerateTrianglesNeverReportNan) {
  std::vector<FlatPrimitive> primitives = {{shape_triangle, 0, {0, 0, 0, 0, 0, 0, 0, 0, 0}},
                                           {shape_triangle, 1, {-1, 0, 0, 0, 0, 0, 1, 0, 0}},
                                           {shape_triangle, 2, {0, 0.5f, 0, 0, 0.5f, 0, 0, 1, 0}}};
  const Encoded scene = encode(primitives);
  tracer_.upload(scene.nodes, scene.leaves, {}, scene.tree.root);
  auto rays = random_rays(52, 500);
  for (const float x : {-0.5f, 0.0f, 0.25f}) rays.push_back({x, 0, -1, 0, 0, 0, 1, inf});
  for (const HitRecord& h : tracer_.closest(rays)) EXPECT_FALSE(std::isnan(h.t));
}

/// A displaced closed mesh: no ray from the outside through the middle may slip through an edge or
/// a vertex.
TEST_P(HardRays, ClosedMeshIsWatertight) {
  constexpr int n = 48;
  std::vector<float> vertices;
  Random random(53);
  const auto vertex = [&](int i, int j) {
    return static_cast<std::size_t>(3 * (i == 0 ? 0 : i == n ? 1 : 2 + (i - 1) * n + j % n));
  };
  vertices.resize(static_cast<std::size_t>(3 * (2 + (n - 1) * n)));
  for (int i = 0; i <= n; i++)
    for (int j = 0; j < n; j++) {
      const float a = 3.14159265f * static_cast<float>(i) / n,
                  b = 6.2831853f * static_cast<float>(j) / n;
      const float r = (i == 0 || i == n) ? 1.0f : 1 + 0.1f * random.uniform(-1, 1);
      float* v = &vertices[vertex(i, j)];
      v[0] = r * std::sin(a) * std::cos(b);
      v[1] = r * std::sin(a) * std::sin(b);
      v[2] = r * std::cos(a);
    }
  std::vector<FlatPrimitive> primitives;
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    FlatPrimitive p{shape_triangle, static_cast<std::uint32_t>(primitives.size()), {}};
    for (std::size_t k = 0; k < 3; k++) {
      p.data[k] = vertices[a + k];
      p.data[3 + k] = vertices[b + k];
      p.data[6 + k] = vertices[c + k];
    }
    primitives.push_back(p);
  };
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      if (i > 0) add(vertex(i, j), vertex(i + 1, j), vertex(i, j + 1));
      if (i < n - 1) add(vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
  // Aim from inside and outside at points of edges and at vertices, as rounded.
  std::vector<RayRecord> rays;
  for (int i = 0; i < 100000; i++) {
    const FlatPrimitive& p = primitives[random.below(static_cast<unsigned>(primitives.size()))];
    const float s = i % 4 == 0 ? 0.0f : random.uniform(0, 1);
    float o[3], d[3];
    for (int k = 0; k < 3; k++) {
      o[k] = i % 2 == 0 ? random.uniform(-0.3f, 0.3f) : 0.0f;
      d[k] = p.data[k] + s * (p.data[3 + k] - p.data[k]) - o[k];
    }
    rays.push_back({o[0], o[1], o[2], 0, d[0], d[1], d[2], inf});
  }
  const Encoded scene = encode(primitives);
  tracer_.upload(scene.nodes, scene.leaves, {}, scene.tree.root);
  int escaped = 0;
  for (const HitRecord& h : tracer_.closest(rays)) escaped += h.slot == CAPLET_NONE ? 1 : 0;
  EXPECT_EQ(escaped, 0);
}

/// Leaving a surface from a hit point moved outward by the claimed error, in any outward direction,
/// hits nothing of a convex body.
TEST_P(HardRays, NoHitAgainWhenLeaving) {
  const FlatPrimitive p = capsule(0.3f, -1, 0.1f, -0.2f, 1, 0.4f, 0.25f);
  const Encoded scene = encode({p});
  tracer_.upload(scene.nodes, scene.leaves, {}, scene.tree.root);
  const auto rays = random_rays(54, 5000);
  const auto hits = tracer_.closest(rays);
  std::vector<RayRecord> out;
  Random random(55);
  for (std::size_t i = 0; i < rays.size(); i++) {
    if (hits[i].slot == CAPLET_NONE || (hits[i].surface >> 16) != 0) continue;
    const DoubleRay ray = widen(rays[i]);
    Vec x = {ray.o[0] + double(hits[i].t) * ray.d[0], ray.o[1] + double(hits[i].t) * ray.d[1],
             ray.o[2] + double(hits[i].t) * ray.d[2]};
    Vec n{};
    for (std::size_t k = 0; k < 3; k++) {  // gradient of the distance
      Vec above = x, below = x;
      above[k] += 1e-6;
      below[k] -= 1e-6;
      n[k] = (surface_distance(p, above) - surface_distance(p, below)) / 2e-6;
    }
    // Twice the claim: the point's error and that of the ray that leaves it; and the rounding of
    // the point.
    const double off = 2 * claimed_error(p, ray) + 4e-7 - std::min(0.0, surface_distance(p, x));
    Vec d = {double(random.uniform(-1, 1)), double(random.uniform(-1, 1)),
             double(random.uniform(-1, 1))};
    const double side = d[0] * n[0] + d[1] * n[1] + d[2] * n[2];
    for (std::size_t k = 0; k < 3; k++) {
      x[k] += off * n[k];
      if (side < 0) d[k] = -d[k];
    }
    out.push_back({static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2]), 0,
                   static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2]),
                   inf});
  }
  ASSERT_GT(out.size(), 500u);
  for (const HitRecord& h : tracer_.closest(out)) EXPECT_EQ(h.slot, CAPLET_NONE);
}

}  // namespace
}  // namespace caplet::test::hard_rays_test
