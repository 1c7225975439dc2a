// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Emissive solids that overlap, touch or coincide give the light of their union: neither that of
// hidden surfaces, nor twice that of surfaces at one place. The irradiance of the union is known by
// quadrature over directions, in double, by distances of rays from axes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <optional>

#include "light_bench.h"
#include "lower/detail/covered_ends.h"
#include "support/thorough.h"

namespace caplet::test::chains_test {

namespace {

using glm::dvec3;

using std::numbers::pi;

/// The union of the balls along an axis, with a radius that goes from r0 to r1.
struct RoundSolid {
  dvec3 p0, p1;
  double r0, r1;
};

double distance_to_ray(const dvec3& o, const dvec3& d, const dvec3& p) {
  return glm::length(p - o - d * std::max(0.0, glm::dot(p - o, d)));
}

/// Whether the ray (d a unit vector) comes to a ball of the axis: the distance minus the radius is
/// convex along the axis, and its least value is found by golden sections: 40 of them leave 4e-9 of
/// the axis.
bool meets(const dvec3& o, const dvec3& d, const RoundSolid& solid) {
  const dvec3 middle = 0.5 * (solid.p0 + solid.p1);
  if (distance_to_ray(o, d, middle) >
      0.5 * glm::length(solid.p1 - solid.p0) + std::max(solid.r0, solid.r1))
    return false;
  const auto gap = [&](double s) {
    return distance_to_ray(o, d, glm::mix(solid.p0, solid.p1, s)) -
           (solid.r0 + s * (solid.r1 - solid.r0));
  };
  constexpr double section = 0.6180339887498949;
  double low = 0, high = 1, a = 1 - section, b = section, at_a = gap(a), at_b = gap(b);
  for (int i = 0; i < 40 && at_a > 0 && at_b > 0; ++i) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - section * (high - low);
      at_a = gap(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + section * (high - low);
      at_b = gap(b);
    }
  }
  return at_a <= 0 || at_b <= 0 || gap(low) <= 0 || gap(high) <= 0;
}

/// Irradiance of a plane with normal +z at p under solids of radiance 1: pi times the share of
/// directions, spread by the cosine, that meet one. The points of Roberts's R2 sequence: 2^21 of
/// them are off by about 2e-4 of a share of 0.04, and fewer by as much more as they are fewer.
double irradiance(const dvec3& p, const std::vector<RoundSolid>& solids) {
  const int count = 1 << (thorough() ? 21 : 19);
  double x = 0.5, y = 0.5;
  int met = 0;
  for (int i = 0; i < count; ++i) {
    x = std::fmod(x + 0.7548776662466927, 1.0);
    y = std::fmod(y + 0.5698402909980532, 1.0);
    const double r = std::sqrt(x), phi = 2 * pi * y;
    const dvec3 d(r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - x));
    met += std::ranges::any_of(solids, [&](const RoundSolid& solid) { return meets(p, d, solid); });
  }
  return pi * met / count;
}

struct ChainCase {
  std::string name;
  std::vector<RoundSolid> pieces;
  std::vector<RoundSolid> solids;  // of the same union as the pieces; empty: the pieces
  std::size_t samples = std::size_t{1} << (thorough() ? 20 : 18);
  friend void PrintTo(const ChainCase& c, std::ostream* out) { *out << c.name; }
};

/// A polyline of capsules: the radius is that of its corners.
std::vector<RoundSolid> along(const std::function<dvec3(double)>& place,
                              const std::function<double(double)>& radius, int count) {
  std::vector<RoundSolid> out;
  for (int i = 0; i < count; ++i) {
    const double a = double(i) / count, b = double(i + 1) / count;
    out.push_back({place(a), place(b), radius(a), radius(b)});
  }
  return out;
}

std::vector<ChainCase> cases() {
  std::vector<ChainCase> all;
  const auto straight = [](double t) { return dvec3(-1.475 + 2.95 * t, 0, 1); };
  const auto even = [](double) { return 0.1; };
  const auto taper = [](double t) { return 0.15 - 0.1 * t; };
  for (const int count : {1, 30, 100, 1000, 10000})
    all.push_back({"straight_" + std::to_string(count), along(straight, even, count),
                   along(straight, even, 1),
                   std::size_t{1} << (count > 1000 && thorough() ? 22 : 20)});
  for (const int count : {30, 1000})
    all.push_back({"tapered_" + std::to_string(count), along(straight, taper, count),
                   along(straight, taper, 1)});
  const auto arc = [](double t) { return dvec3(std::cos(pi * t), std::sin(pi * t) - 0.5, 1); };
  all.push_back({"arc", along(arc, even, 20), {}});
  const auto zigzag = [](double t) {
    const int corner = static_cast<int>(std::lround(6 * t));
    return dvec3(0.3 * corner - 0.9, corner % 2 == 0 ? -0.15 : 0.15, 1);
  };
  all.push_back({"zigzag", along(zigzag, even, 6), {}});
  const auto swelling = [](double t) { return 0.08 + 0.06 * std::abs(std::remainder(6 * t, 2.0)); };
  all.push_back({"zigzag_of_two_radii", along(zigzag, swelling, 6), {}});

  std::vector<RoundSolid> sticks = along(straight, even, 5);
  for (int i = 0; i < 6; ++i)
    sticks.push_back({straight(i / 5.0), straight(i / 5.0), i % 2 == 0 ? 0.17 : 0.1, 0});
  for (RoundSolid& solid : sticks)
    if (solid.p0 == solid.p1) solid.r1 = solid.r0;
  all.push_back({"ball_and_stick", sticks, {}});
  const RoundSolid one = along(straight, even, 1).front();
  all.push_back({"twice_the_same", {one, one, {one.p1, one.p0, one.r1, one.r0}}, {one}});
  all.push_back({"thin_into_thick",
                 {{{-1, 0, 1}, {0, 0, 1}, 0.05, 0.05}, {{0, 0, 1}, {0.9, 0.3, 1}, 0.12, 0.12}},
                 {}});
  // More pieces at a point than are looked at for what covers them.
  std::vector<RoundSolid> star;
  for (int i = 0; i < 48; ++i) {
    const double phi = 2 * pi * i / 48;
    star.push_back({{0, 0, 1},
                    {std::cos(phi), std::sin(phi), 1 + 0.1 * (i % 3)},
                    0.08 + 0.001 * (i % 5),
                    0.05});
  }
  all.push_back({"star", star, {}});
  return all;
}

Shape emissive(const std::vector<RoundSolid>& pieces) {
  CapsulesShape capsules;
  for (const RoundSolid& piece : pieces) {
    capsules.p0.emplace_back(piece.p0);
    capsules.p1.emplace_back(piece.p1);
    capsules.radius0.push_back(static_cast<float>(piece.r0));
    capsules.radius1.push_back(static_cast<float>(piece.r1));
  }
  Shape shape;
  shape.geometry = capsules;
  shape.emission = AreaEmission{};
  return shape;
}

Scene scene_of(const std::vector<Shape>& shapes) {
  Scene scene;
  scene.materials.emplace_back();
  scene.shapes = shapes;
  return scene;
}

void expect_irradiance(const Scene& scene, const std::vector<RoundSolid>& solids,
                       std::size_t samples) {
  LightBench bench(lower(scene));
  for (const dvec3& p : {dvec3(0.3, -0.2, 0), dvec3(1.75, 0.5, 0.125)}) {
    SCOPED_TRACE(p.x);
    double sum = 0, squares = 0;
    for (const SampledLight& s : bench.sample(p, samples)) {
      const double x = s.pdf > 0 && !s.occluded ? s.radiance * std::max(0.0, s.wi.z) / s.pdf : 0;
      sum += x;
      squares += x * x;
    }
    const auto n = static_cast<double>(samples);
    const double mean = sum / n, error = std::sqrt((squares / n - mean * mean) / n);
    const double expected = irradiance(p, solids);
    EXPECT_NEAR(mean, expected, 3 * error + (thorough() ? 5e-4 : 1e-3) * expected);
    EXPECT_LT(error, (thorough() ? 2e-3 : 4e-3) * expected) << "too few samples to tell";
  }
}

class EmissiveChain : public testing::TestWithParam<ChainCase> {};

TEST_P(EmissiveChain, GivesTheLightOfItsUnion) {
  const ChainCase& c = GetParam();
  expect_irradiance(scene_of({emissive(c.pieces)}), c.solids.empty() ? c.pieces : c.solids,
                    c.samples);
}

INSTANTIATE_TEST_SUITE_P(Cases, EmissiveChain, testing::ValuesIn(cases()),
                         [](const testing::TestParamInfo<ChainCase>& row) {
                           return row.param.name;
                         });

// The same chain as two instances, turned and of another size and one of them twice, beside one in
// the world.
TEST(EmissiveChains, GiveTheLightOfTheirUnionInInstances) {
  const auto place = [](double t) { return dvec3(t, 0.1 * std::sin(5 * t), 0); };
  const std::vector<RoundSolid> chain = along(
      place, [](double t) { return 0.08 - 0.03 * t; }, 40);
  Scene scene = scene_of({emissive(
      along([](double t) { return dvec3(-0.5 + t, -0.7, 1); }, [](double) { return 0.05; }, 10))});
  std::vector<RoundSolid> solids = {{{-0.5, -0.7, 1}, {0.5, -0.7, 1}, 0.05, 0.05}};
  Object object;
  object.shapes = {emissive(chain)};
  scene.objects.push_back(object);
  for (const double scale : {0.5, 2.0, 2.0}) {
    glm::dmat4 m = glm::translate(glm::dmat4(1), {-1, 0.5 * scale - 0.5, 1});
    m = glm::rotate(m, 0.25, dvec3(0, 0.6, 0.8));
    m = glm::scale(m, dvec3(scale));
    Instance instance;
    instance.object = 0;
    instance.world_from_object = m;
    scene.instances.push_back(instance);
    for (const RoundSolid& piece : chain)
      solids.push_back({dvec3(m * glm::dvec4(piece.p0, 1)), dvec3(m * glm::dvec4(piece.p1, 1)),
                        scale * piece.r0, scale * piece.r1});
  }
  expect_irradiance(scene, solids, std::size_t{1} << (thorough() ? 21 : 19));
}

/// Heights of the two ends that are left to be sampled, in 255ths, of each light.
std::vector<std::pair<int, int>> open_heights(const Scene& scene) {
  std::vector<std::pair<int, int>> out;
  for (const LightRecord& light : lower(scene).lights)
    out.emplace_back(255 - static_cast<int>(light.flags >> CAPLET_LIGHT_COVER_0 & 255u),
                     255 - static_cast<int>(light.flags >> CAPLET_LIGHT_COVER_1 & 255u));
  return out;
}

// Two equal capsules meet at an angle b. The next one covers normals nearer than a right angle to
// its axis: what is left of an end reaches up to the height sin b. Room for rounding is less than a
// hundredth here; a step is 1 / 255.
TEST(CoveredEnds, ReachAsHighAsTheNextCapsuleLeavesThem) {
  for (const double angle : {0.0, 0.3, 1.0, 1.5, 2.5}) {
    const dvec3 turn(std::cos(angle), std::sin(angle), 0);
    const auto open = open_heights(
        scene_of({emissive({{{-1, 0, 0}, {0, 0, 0}, 0.2, 0.2}, {{0, 0, 0}, turn, 0.2, 0.2}})}));
    ASSERT_EQ(open.size(), 2u);
    const double height = angle < pi / 2 ? std::sin(angle) : 1;
    EXPECT_EQ(open[0].first, 255);
    EXPECT_EQ(open[1].second, 255);
    for (const int end : {open[0].second, open[1].first}) {
      EXPECT_GE(end, 255 * height) << angle;
      EXPECT_LE(end, std::min(255.0, 255 * (height + 0.01) + 1)) << angle;
    }
  }
}

// Where several meet at a point, in whatever order, that one counts which leaves least.
TEST(CoveredEnds, AreOfTheOneThatLeavesLeast) {
  const auto away = [](double angle) {
    return RoundSolid{{0, 0, 0}, {std::cos(angle), std::sin(angle), 0}, 0.2, 0.2};
  };
  std::vector<double> angles = {0.4, 0.9, 1.3};
  do {
    std::vector<RoundSolid> pieces = {{{-1, 0, 0}, {0, 0, 0}, 0.2, 0.2}};
    for (const double angle : angles) pieces.push_back(away(angle));
    const auto open = open_heights(scene_of({emissive(pieces)}));
    ASSERT_EQ(open.size(), 4u);
    EXPECT_GE(open[0].second, 255 * std::sin(0.4)) << angles[0] << ' ' << angles[1];
    EXPECT_LE(open[0].second, 255 * (std::sin(0.4) + 0.01) + 1) << angles[0] << ' ' << angles[1];
  } while (std::ranges::next_permutation(angles).found);
}

// A capsule that grows by 0.3 a length covers normals at less than acos(-0.3) from its axis: of an
// end whose outward axis is b from there, what is left reaches up to the cosine of what that is
// more than b. It also covers ends that it turns back from.
TEST(CoveredEnds, ReachLessHighWhereTheNextCapsuleGrows) {
  for (const double angle : {0.5, 1.2, 1.5, 1.7, 1.8, 2.0, 2.8}) {
    const dvec3 turn(std::cos(angle), std::sin(angle), 0);
    const auto open = open_heights(
        scene_of({emissive({{{-1, 0, 0}, {0, 0, 0}, 0.2, 0.2}, {{0, 0, 0}, turn, 0.2, 0.5}})}));
    ASSERT_EQ(open.size(), 2u);
    const double height = std::cos(std::max(0.0, std::acos(-0.3) - angle));
    EXPECT_GE(open[0].second, 255 * height) << angle;
    EXPECT_LE(open[0].second, std::min(255.0, 255 * (height + 0.01) + 1)) << angle;
  }
}

TEST(CoveredEnds, AreThoseThatAThickerOneOrASphereHolds) {
  // Thin into thick, to a ball, to nothing; and a point that differs in the last bit.
  const float next = std::nextafter(1.0f, 2.0f);
  const auto open = open_heights(scene_of({emissive({{{0, 0, 0}, {1, 0, 0}, 0.1, 0.1},
                                                     {{1, 0, 0}, {2, 1, 0}, 0.2, 0.2},
                                                     {{0, 0, 0}, {0, 0, 0}, 0.15, 0.15},
                                                     {{next, 0, 0}, {2, -1, 0}, 0.1, 0.1}})}));
  ASSERT_EQ(open.size(), 4u);
  EXPECT_EQ(open[0], std::pair(1, 1));
  EXPECT_EQ(open[1], std::pair(255, 255));
  EXPECT_EQ(open[3], std::pair(255, 255));
}

// Light samples leave out what the next capsule covers, and so do their densities.
TEST(CoveredEnds, HaveNoDensity) {
  LightBench bench(lower(
      scene_of({emissive({{{-1, 0, 0}, {0, 0, 0}, 0.2, 0.2}, {{0, 0, 0}, {0, 1, 0}, 0.2, 0.2}})})));
  const auto on_the_end = [](double angle) {
    const dvec3 n(std::cos(angle), 0, std::sin(angle));
    return SurfacePoint{0.2 * n, n, 0.2 * 0.2};
  };
  // At a right angle the second capsule holds half of the end, with every height (here x) in the
  // other half.
  const dvec3 p(2, 0, 2);
  for (const double density : bench.area_pdf(0, p, {on_the_end(0.3), on_the_end(1.0)}))
    EXPECT_GT(density, 0);
  LightBench straight(lower(
      scene_of({emissive({{{-1, 0, 0}, {0, 0, 0}, 0.2, 0.2}, {{0, 0, 0}, {1, 0, 0}, 0.2, 0.2}})})));
  for (const double density : straight.area_pdf(0, p, {on_the_end(0.3), on_the_end(1.0)}))
    EXPECT_EQ(density, 0);
}

TEST(CoveredEnds, AreSampledWhereScatteredRaysWouldNotFindThem) {
  const std::vector<RoundSolid> chain = {{{-1, 0, 0}, {0, 0, 0}, 0.2, 0.2},
                                         {{0, 0, 0}, {1, 0, 0}, 0.2, 0.2}};
  const auto all_open = [](const Scene& scene) {
    return std::ranges::all_of(open_heights(scene),
                               [](const auto& ends) { return ends == std::pair(255, 255); });
  };
  EXPECT_FALSE(all_open(scene_of({emissive(chain)})));
  Shape shape = emissive(chain);
  shape.emission->two_sided = true;
  EXPECT_TRUE(all_open(scene_of({shape})));
  shape = emissive(chain);
  shape.reverse_orientation = true;
  EXPECT_TRUE(all_open(scene_of({shape})));
  shape = emissive(chain);
  shape.alpha = TextureOperand{0.0};
  EXPECT_TRUE(all_open(scene_of({shape})));
}

}  // namespace

}  // namespace caplet::test::chains_test
