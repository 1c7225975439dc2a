// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Surface points on the device: on the surface within the claimed error, inside the box, normals and parametrisation against
// differences, and rays that leave a surface without meeting it again.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "cases.h"
#include "shared/kinds.h"

namespace caplet::test {
namespace {

using glm::dvec3;

constexpr double eps = 0x1p-24;
constexpr double two_pi = 6.283185307179586;

const Device& device() {
  static const Device chosen = Device::choose("");
  return chosen;
}

dvec3 point(const float* p) { return {p[0], p[1], p[2]}; }
bool is_hit(const Probed& probed) { return probed.hit.slot != CAPLET_NONE; }

struct ShapeKind {
  int shape;
  const char* name;
};
void PrintTo(const ShapeKind& kind, std::ostream* out) { *out << kind.name; }

class SurfacePoints : public testing::TestWithParam<ShapeKind> {};

// The smallest radius of curvature anywhere on the shape.
double sharpest(const FlatPrimitive& p) {
  if (p.shape == shape_sphere) return p.data[3];
  if (p.shape == shape_capsule) return p.data[6];
  return std::min(p.data[6], p.data[7]);
}

TEST_P(SurfacePoints, LieOnTheSurfaceAndInTheBox) {
  CaseMaker maker(41);
  const CaseSet cases = maker.set(GetParam().shape, true, 1000 * test_scale(), 20);
  const Probe probe(device(), 8, cases.primitives);
  const auto probed = probe.trace(cases.which, cases.rays);
  double worst = 0;
  int hits = 0, normals = 0;
  for (std::size_t i = 0; i < probed.size(); ++i) {
    if (!is_hit(probed[i])) continue;
    ++hits;
    const SurfaceOut& s = probed[i].surface;
    const FlatPrimitive& p = cases.primitives[cases.which[i]];
    const reference::Primitive witness = witness_of(p);
    const dvec3 x = point(s.p), ng = point(s.ng);
    const double distance = std::abs(reference::value(witness, x));
    ASSERT_LE(distance, s.error) << i;
    worst = std::max(worst, distance / double(s.error));
    for (int k = 0; k < 3; ++k) {
      ASSERT_GE(s.p[k], probe.tree(cases.which[i]).min[k]) << i;
      ASSERT_LE(s.p[k], probe.tree(cases.which[i]).max[k]) << i;
    }
    ASSERT_NEAR(glm::length(ng), 1, 8 * eps);
    ASSERT_EQ(s.primitive, cases.which[i]);
    ASSERT_EQ(s.geometry, cases.which[i]);
    ASSERT_EQ(s.leaving, probed[i].hit.surface >> 16);
    ASSERT_EQ(s.light, cases.which[i] % 2 == 0 ? CAPLET_NONE : cases.which[i]);
    ASSERT_TRUE(s.u >= 0 && s.u <= 1 && s.v >= 0 && s.v <= 1) << s.u << " " << s.v;
    // A point that is off by `error` turns the normal by error / radius; central differences over 1e-4 radius have an error of
    // 1e-8.
    if (p.shape <= shape_tapered_capsule) {
      const double radius = sharpest(p);
      if (double(s.error) > 0.01 * radius) continue;
      const dvec3 expected = reference::normal_at(witness, x, 1e-4 * radius);
      // The differences themselves are rounded: 2^-52 of the coordinates over the step.
      ASSERT_LE(glm::length(ng - expected), 4 * double(s.error) / radius + 3e-5 + 0x1p-50 * glm::length(x) / (1e-4 * radius))
          << i;
    } else {
      // The edges of a triangle are rounded: its normal turns by eps |e1| |e2| / (2 area) at most twice.
      double limit = 4 * eps;
      if (p.shape == shape_triangle) {
        const dvec3 e1 = point(p.data + 3) - point(p.data), e2 = point(p.data + 6) - point(p.data);
        limit = 8 * eps * glm::length(e1) * glm::length(e2) / glm::length(glm::cross(e1, e2));
      }
      ASSERT_LE(glm::length(ng - reference::normal_at(witness, x, 1)), limit) << i;
    }
    ++normals;
  }
  std::printf("%d hits, %d normals, worst %.3f of the claimed error\n", hits, normals, worst);
  EXPECT_GT(hits, 4000);
  EXPECT_GT(normals, hits / 4);
}

// Directions: over the hemisphere around +-ng, every fifth one within 1e-4 of grazing, none so near that the rounding of a
// float's scalar product could change its side.
std::array<float, 3> leaving_direction(CaseMaker& maker, const dvec3& n) {
  const dvec3 around = maker.direction();
  const dvec3 across = glm::normalize(around - glm::dot(around, n) * n);
  const double height = maker.uniform(0, 1) < 0.2 ? maker.uniform(1e-6, 1e-4) : maker.uniform(0, 1);
  const dvec3 d = std::sqrt(1 - height * height) * across + height * n;
  std::array<float, 3> out{static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
  // Rounding must not turn it to the other side.
  if (glm::dot(point(out.data()), n) < 0) out = {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
  return out;
}

void expect_clean_exits(const ShapeKind& kind, const Probe& probe, const CaseSet& cases, CaseMaker& maker) {
  const auto probed = probe.trace(cases.which, cases.rays);
  std::vector<std::uint32_t> which;
  std::vector<Probed> from;
  std::vector<std::array<float, 3>> outward, inward;
  for (std::size_t i = 0; i < probed.size(); ++i) {
    if (!is_hit(probed[i])) continue;
    which.push_back(cases.which[i]);
    from.push_back(probed[i]);
    outward.push_back(leaving_direction(maker, point(probed[i].surface.ng)));
    inward.push_back(leaving_direction(maker, -point(probed[i].surface.ng)));
  }
  const auto out = probe.leave(which, from, outward), in = probe.leave(which, from, inward);
  const bool solid = kind.shape <= shape_tapered_capsule;
  int again = 0, lost = 0, thick = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    again += out[i].hit.slot != CAPLET_NONE;
    if (!solid) {
      again += in[i].hit.slot != CAPLET_NONE;
    } else if (double(from[i].surface.error) < 0.01 * sharpest(cases.primitives[which[i]])) {
      ++thick;
      // From inside, the other side of the same solid is the next hit.
      lost += !(in[i].hit.slot != CAPLET_NONE && in[i].hit.surface >> 16 == 1);
    }
  }
  std::printf("%zu exits, %d hit again; %d inward, %d lost\n", from.size(), again, thick, lost);
  EXPECT_EQ(again, 0);
  EXPECT_EQ(lost, 0);
  EXPECT_GT(from.size(), probed.size() / 5);
}

TEST_P(SurfacePoints, AreLeftForGood) {
  CaseMaker maker(42);
  const CaseSet cases = maker.set(GetParam().shape, true, 2000 * test_scale(), 50);
  expect_clean_exits(GetParam(), Probe(device(), 8, cases.primitives), cases, maker);
}

// --- Under affine transforms ---

// Turned inside out, a shape has its normals on the other side and all else as it was.
TEST_P(SurfacePoints, ReversedOrientationTurnsTheNormals) {
  CaseMaker maker(47);
  const CaseSet cases = maker.set(GetParam().shape, false, 100, 20);
  Probe probe(device(), 8, cases.primitives);
  const auto plain = probe.trace(cases.which, cases.rays);
  probe.flags = CAPLET_GEOMETRY_FLIP_NORMAL;
  const auto turned = probe.trace(cases.which, cases.rays);
  int hits = 0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    ASSERT_EQ(is_hit(plain[i]), is_hit(turned[i]));
    if (!is_hit(plain[i])) continue;
    ++hits;
    const SurfaceOut &a = plain[i].surface, &b = turned[i].surface;
    EXPECT_EQ(point(a.p), point(b.p));
    EXPECT_EQ(point(a.ng), -point(b.ng));
    EXPECT_EQ(point(a.ns), -point(b.ns));
    EXPECT_EQ(point(a.dpdu), point(b.dpdu));
    EXPECT_EQ(a.error, b.error);
    EXPECT_EQ(a.leaving, b.leaving);
    // The implicit function still grows outward of the solid.
    if (GetParam().shape <= shape_tapered_capsule) {
      const reference::Primitive witness = witness_of(cases.primitives[cases.which[i]]);
      const double step = 100 * double(a.error);
      if (step > 0.5 * sharpest(cases.primitives[cases.which[i]])) continue;  // not through to the other side
      EXPECT_LT(reference::value(witness, point(b.p) + step * point(b.ng)), reference::value(witness, point(b.p)));
    }
  }
  EXPECT_GT(hits, 400);
}

struct PlacedCases {
  CaseSet cases;
  std::vector<PlacedPrimitive> placed;
  std::vector<glm::dmat4> world_from_object;  // as rounded to float
};

PlacedCases placed_cases(int shape, std::uint32_t seed, CaseMaker& maker) {
  PlacedCases out{maker.set(shape, false, 300, 60), {}, {}};
  CaseMaker random(seed);
  for (const FlatPrimitive& p : out.cases.primitives) {
    glm::dmat4 m = glm::translate(glm::dmat4(1), std::pow(10.0, random.uniform(-1, 3)) * random.direction());
    m = glm::rotate(m, random.uniform(0, two_pi), random.direction());
    m = glm::scale(
        m, dvec3(random.uniform(0.2, 3), random.uniform(0.2, 3), random.uniform(0.2, 3) * (random.uniform(0, 1) < 0.5 ? -1 : 1)));
    m = glm::rotate(m, random.uniform(0, two_pi), random.direction());
    const glm::dmat4 inverse = glm::inverse(m);
    PlacedPrimitive placed{p, true, {}, {}};
    glm::dmat4 rounded(1);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) {
        const auto at = static_cast<std::size_t>(4 * r + c);
        placed.world_from_object[at] = static_cast<float>(m[c][r]);
        placed.object_from_world[at] = static_cast<float>(inverse[c][r]);
        rounded[c][r] = placed.world_from_object[at];
      }
    out.placed.push_back(placed);
    out.world_from_object.push_back(rounded);
  }
  for (std::size_t i = 0; i < out.cases.rays.size(); ++i) {
    RayRecord& r = out.cases.rays[i];
    const glm::dmat4& m = out.world_from_object[out.cases.which[i]];
    r = make_ray(dvec3(m * glm::dvec4(r.ox, r.oy, r.oz, 1)), dvec3(m * glm::dvec4(r.dx, r.dy, r.dz, 0)));
  }
  return out;
}

TEST_P(SurfacePoints, OfInstances) {
  CaseMaker maker(43);
  const PlacedCases placed = placed_cases(GetParam().shape, 44, maker);
  const Probe probe(device(), 8, placed.placed);
  const auto probed = probe.trace(placed.cases.which, placed.cases.rays);
  int hits = 0;
  for (std::size_t i = 0; i < probed.size(); ++i) {
    if (!is_hit(probed[i])) continue;
    ++hits;
    const SurfaceOut& s = probed[i].surface;
    const std::uint32_t which = placed.cases.which[i];
    const FlatPrimitive& p = placed.cases.primitives[which];
    const reference::Primitive witness = witness_of(p);
    const glm::dmat4 object_from_world = glm::inverse(placed.world_from_object[which]);
    const dvec3 x = dvec3(object_from_world * glm::dvec4(point(s.p), 1));
    // An object-space distance f along the normal is f |M^T n| in the world.
    const dvec3 n = point(s.ng);
    const double stretch = glm::length(glm::transpose(glm::dmat3(placed.world_from_object[which])) * n);
    ASSERT_LE(std::abs(reference::value(witness, x)) * stretch, double(s.error)) << i;
    ASSERT_EQ(s.light, which % 2 == 0 ? CAPLET_NONE : 100 + which + 3);
    // The normal is that of the implicit function of the world point; open shapes' winding is that of object space.
    const double radius = p.shape <= shape_tapered_capsule ? sharpest(p) : 1;
    if (p.shape <= shape_tapered_capsule && double(s.error) > 0.01 * radius) continue;
    const dvec3 gradient = reference::normal_at(witness, x, 1e-4 * radius);
    const dvec3 expected = glm::normalize(glm::transpose(glm::dmat3(object_from_world)) * gradient);
    // Condition of the matrices (3 / 0.2) on top of the world-space case.
    ASSERT_LE(glm::length(n - expected), 60 * double(s.error) / radius + 1e-4) << i;
  }
  EXPECT_GT(hits, 4000);
  CaseSet cases = placed.cases;
  CaseMaker directions(45);
  // Thickness is judged in object space: scales below 0.2 do not occur.
  for (FlatPrimitive& p : cases.primitives)
    if (p.shape == shape_tapered_capsule) p.data[6] *= 0.2f, p.data[7] *= 0.2f;
  expect_clean_exits(GetParam(), probe, cases, directions);
}

const ShapeKind kinds[] = {{shape_sphere, "sphere"},
                           {shape_capsule, "capsule"},
                           {shape_tapered_capsule, "tapered_capsule"},
                           {shape_triangle, "triangle"},
                           {shape_disk, "disk"}};
INSTANTIATE_TEST_SUITE_P(Kinds, SurfacePoints, testing::ValuesIn(kinds),
                         [](const auto& instance) { return std::string(instance.param.name); });

// --- Parametrisation ---

// Traces straight down on the surface at x from outside along n.
Probed at(const Probe& probe, const dvec3& x, const dvec3& n, double away) {
  return probe.trace({0}, {make_ray(x + away * n, -n)})[0];
}

struct Parametrised {
  FlatPrimitive primitive;
  double profile;  // length of the profile from v = 0 to v = 1
};

// uv.x runs along dpdu at 1 / |dpdu|, uv.y does not; across it uv.y runs at 1 / profile, up the axis.
TEST(SurfaceParameters, MatchDifferences) {
  const double k = 1.0 / 4, c = std::sqrt(1 - k * k), pi = two_pi / 2;
  const double tapered = 2 * (pi / 2 + std::asin(k)) + 4 * c + 1 * (pi / 2 - std::asin(k));
  const Parametrised shapes[] = {{make_sphere({1, 2, 3}, 2), 2 * pi},
                                 {make_capsule({1, 2, 3}, {2, 0, 5}, 1.5f), 3 + 1.5 * pi},
                                 {make_tapered({0, 0, 0}, {4, 0, 0}, 2, 1), tapered},
                                 {make_disk({1, 2, 3}, {0.6f, 0, 0.8f}, 2), 2}};
  for (const Parametrised& shape : shapes) {
    const Probe probe(device(), 8, std::vector<FlatPrimitive>{shape.primitive});
    CaseMaker maker(46);
    int checked = 0;
    for (int i = 0; i < 60; ++i) {
      const Probed here = probe.trace({0}, {maker.ray(shape.primitive)})[0];
      if (!is_hit(here)) continue;
      const dvec3 x = point(here.surface.p), n = point(here.surface.ng), dpdu = point(here.surface.dpdu);
      const double speed = glm::length(dpdu);
      // Away from the seam and the poles. Steps of 0.01: second differences are 1e-4 relative, rounding 1e-7 / 1e-3.
      if (speed < 3 || here.surface.u < 0.05 || here.surface.u > 0.95) continue;
      EXPECT_NEAR(glm::dot(dpdu, n) / speed, 0, 1e-5);
      constexpr double h = 0.01;
      const dvec3 along = dpdu / speed, up = glm::cross(n, along);
      const Probed before = at(probe, x - h * along, n, 1), after = at(probe, x + h * along, n, 1);
      const Probed below = at(probe, x - h * up, n, 1), above = at(probe, x + h * up, n, 1);
      if (!is_hit(before) || !is_hit(after) || !is_hit(below) || !is_hit(above)) continue;
      EXPECT_NEAR((after.surface.u - before.surface.u) / (2 * h) * speed, 1, 2e-3);
      EXPECT_NEAR(after.surface.v, before.surface.v, 1e-4);
      EXPECT_NEAR(std::abs(above.surface.v - below.surface.v) / (2 * h) * shape.profile, 1, 5e-3);
      EXPECT_NEAR(above.surface.u, below.surface.u, 1e-3);
      ++checked;
    }
    EXPECT_GT(checked, 10);
  }
}

TEST(SurfaceParameters, PolesAndRims) {
  const auto hit = [](const FlatPrimitive& p, const dvec3& o, const dvec3& d) {
    return Probe(device(), 8, std::vector<FlatPrimitive>{p}).trace({0}, {make_ray(o, d)})[0].surface;
  };
  const FlatPrimitive tapered = make_tapered({0, 0, 0}, {4, 0, 0}, 2, 1);
  EXPECT_NEAR(hit(tapered, {-9, 0, 0}, {1, 0, 0}).v, 0, 1e-6);
  EXPECT_NEAR(hit(tapered, {9, 0, 0}, {-1, 0, 0}).v, 1, 1e-6);
  EXPECT_NEAR(hit(make_sphere({0, 0, 0}, 1), {0, 0, 9}, {0, 0, -1}).v, 1, 1e-6);
  EXPECT_NEAR(hit(make_sphere({0, 0, 0}, 1), {0, 9, 0}, {0, -1, 0}).u, 0.25, 1e-6);
  EXPECT_NEAR(hit(make_disk({0, 0, 0}, {0, 0, 1}, 2), {0, 1, 1}, {0, 0, -1}).u, 0.25, 1e-6);
  EXPECT_NEAR(hit(make_disk({0, 0, 0}, {0, 0, 1}, 2), {0, 0.5, 1}, {0, 0, -1}).v, 0.75, 1e-6);
}

TEST(SurfaceParameters, Triangles) {
  const FlatPrimitive triangle = make_triangle({0, 0, 0}, {2, 0, 0}, {0, 4, 0});
  Probe probe(device(), 8, std::vector<FlatPrimitive>{triangle});
  const std::vector<RayRecord> rays = {make_ray({0.5, 1, 1}, {0, 0, -1})};  // barycentric 1/2 1/4 1/4
  const SurfaceOut plain = probe.trace({0}, rays)[0].surface;
  EXPECT_NEAR(plain.u, 0.5, 1e-6);  // vertices at (0 0), (1 0), (1 1)
  EXPECT_NEAR(plain.v, 0.25, 1e-6);
  EXPECT_LT(glm::length(point(plain.dpdu) - dvec3(2, 0, 0)), 1e-6);
  EXPECT_LT(glm::length(point(plain.ng) - dvec3(0, 0, 1)), 1e-6);
  probe.mesh_uvs = {0.5f, 0, 0.5f, 2, 1.5f, 0};  // u along y by 1/4, v along x by 1
  const SurfaceOut own = probe.trace({0}, rays)[0].surface;
  EXPECT_NEAR(own.u, 0.75, 1e-6);
  EXPECT_NEAR(own.v, 0.5, 1e-6);
  EXPECT_LT(glm::length(point(own.dpdu) - dvec3(0, 4, 0)), 1e-6);
}

}  // namespace
}  // namespace caplet::test
