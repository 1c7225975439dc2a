// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Every sampler of area lights against its density, and both against the surface by the test's own
// parametrisation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <numbers>
#include <set>

#include "light_bench.h"
#include "support/chi_square.h"
#include "support/kinds.h"

namespace caplet::test::area_test {

namespace {

using glm::dvec3;

using std::numbers::pi;
constexpr std::size_t sample_count = 60000;

struct AreaCase {
  std::string name;
  Shape shape;
  glm::dvec3 p;
  std::size_t points = 300000;  // of the surface, for the expectations
  bool may_miss = false;        // the sampler knows nothing of what faces p
  friend void PrintTo(const AreaCase& c, std::ostream* out) { *out << c.name; }
};

Shape emissive(decltype(Shape::geometry) geometry, const glm::dmat4& m = glm::dmat4(1),
               bool two_sided = false) {
  Shape shape;
  shape.geometry = std::move(geometry);
  shape.world_from_object = m;
  shape.emission = AreaEmission{};
  shape.emission->two_sided = two_sided;
  return shape;
}

CapsulesShape capsule(glm::vec3 a, glm::vec3 b, float ra, float rb) {
  CapsulesShape shape;
  shape.p0 = {a};
  shape.p1 = {b};
  shape.radius0 = {ra};
  if (ra != rb) shape.radius1 = {rb};
  return shape;
}

TriangleMeshShape triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  TriangleMeshShape mesh;
  mesh.positions = {a, b, c};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

glm::dmat4 moved(double x, double y, double z) { return glm::translate(glm::dmat4(1), {x, y, z}); }

Scene scene_of(const Shape& shape) {
  Scene scene;
  scene.materials.emplace_back();
  scene.shapes = {shape};
  return scene;
}

glm::dmat4 sheared() {
  glm::dmat4 m(1);
  m[1][0] = 0.7;
  m[2][1] = -0.4;
  m[0][0] = 1.5;
  m[3] = glm::dvec4(0.2, 0.1, -0.3, 1);
  return m;
}

std::vector<AreaCase> cases() {
  const glm::vec3 a(-1, 0.2f, 0), b(1, -0.1f, 0.5f);
  const auto level = capsule({0, 0, -1}, {0, 0, 1}, 0.5f, 0.5f);
  const auto thin = capsule({-2.5f, 0, 0}, {2.5f, 0, 0}, 0.02f, 0.02f);
  const auto cone = capsule(a, b, 0.7f, 0.2f);
  const auto needle = capsule({0, 0, 0}, {0, 0, 3}, 0.5f, 0.f);
  const glm::dmat4 squash = glm::scale(moved(0.5, 0, 0), {1.0, 2.0, 0.4});
  const glm::dmat4 mirror = glm::scale(glm::dmat4(1), {-1.5, 1.0, 0.5});
  const auto triangle_low = triangle({-1, -1, 2}, {1, -1, 2.5f}, {0.2f, 1, 2});
  Shape reversed = emissive(DiskShape{1.5, 0.8});
  reversed.reverse_orientation = true;
  const auto turned = [](Shape shape) {
    shape.reverse_orientation = true;
    return shape;
  };
  const CylinderShape tube{{0, 0, -1}, {0.25, 0, 1}, 0.75},
      pipe{{0, 0, -1}, {0, 0, 1}, 0.75, {Cap::flat, Cap::open}};
  const BoxShape box{{-1, -0.5, -0.25}, {1, 0.75, 0.5}};
  const ConeShape frustum{{0, 0, -1}, {0.25, 0, 1}, {0.75, 0.25}},
      point_up{{0, 0, 0}, {0, 0, 1}, {0.5, 0}};
  // A tetrahedron with a corner cut off.
  const PolyhedronShape crystal{
      {dvec3(-1, 0, 0), dvec3(0, -1, 0), dvec3(0, 0, -1), dvec3(0.5, 0.5, 0.5), dvec3(0.75, 0, 0)},
      {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {1, 1, 1}, {1, 0, 0}}};
  const PartialSphereShape dome{1, -0.5, 0.75, 4};
  const OpenCylinderShape gutter{0.75, -1, 1, 5};
  const DiskShape washer{0.5, 1, 0.4, 4};
  BilinearMeshShape saddle;
  saddle.positions = {{-1, -1, 0}, {1, -1, 0.25f}, {-1, 1, 0.25f}, {1, 1, -0.125f}};
  saddle.patches = {{0, 1, 2, 3}};
  const auto balls = [](CsgShape::Operation operation) {
    CsgShape csg{operation, {}};
    for (const double x : {-0.5, 0.25}) {
      Shape ball;
      ball.geometry = SphereShape{1};
      ball.world_from_object = moved(x, 0, 0);
      csg.operands.push_back(std::make_shared<const Shape>(ball));
    }
    return csg;
  };
  Shape dark_end = emissive(tube);
  dark_end.emission->surfaces = {0, 2};
  std::vector<AreaCase> all = {
      {"sphere_turned_inside", turned(emissive(SphereShape{2})), {0.5, 0.25, -1}},
      {"ellipsoid_turned_inside", turned(emissive(SphereShape{1}, squash)), {0.75, 0.5, 0.125}},
      {"capsule_turned_inside", turned(emissive(level, mirror)), {0.125, 0.25, 0.25}},
      {"tapered_turned_inside", turned(emissive(cone)), {-0.5, 0.25, 0.25}},
      {"sphere_far", emissive(SphereShape{0.5}, moved(1, 2, 3)), {20, -3, 4}},
      {"sphere_medium", emissive(SphereShape{1}, moved(1, 2, 3)), {2, 3.5, 2}},
      {"sphere_near", emissive(SphereShape{1}), {1, 0, 1}},
      {"sphere_inside", emissive(SphereShape{2}, glm::dmat4(1), true), {0.5, 0.25, -1}},
      {"ellipsoid_medium", emissive(SphereShape{1}, squash), {2, 1, 2}},
      {"ellipsoid_near", emissive(SphereShape{1}, squash), {0.625, 0.25, 0.75}},
      {"ellipsoid_inside", emissive(SphereShape{1}, squash, true), {0.75, 0.5, 0.125}},
      {"capsule_side", emissive(level), {1.5, 0.5, 0.25}},
      {"capsule_close", emissive(level), {0.625, 0.125, 0.25}},
      {"capsule_end", emissive(level), {0, 0, 3}},
      {"capsule_end_oblique", emissive(level), {0.25, 0.25, 2}},
      {"capsule_beyond", emissive(level), {1, -0.5, 2}},
      {"capsule_far", emissive(level), {10, 20, -5}},
      {"capsule_inside", emissive(level, glm::dmat4(1), true), {0.125, 0.25, 0.5}},
      {"thin_capsule_close", emissive(thin), {1, 0.5, 0.25}, 1000000},
      {"thin_capsule_far", emissive(thin), {3, 40, 5}},
      {"tapered_side", emissive(cone), {0.5, 1.5, 1}},
      {"tapered_thick_end", emissive(cone), {-3, 1, -1}},
      {"tapered_thin_end", emissive(cone), {2, -0.25, 0.75}},
      {"tapered_inside", emissive(cone, glm::dmat4(1), true), {-0.5, 0.25, 0.25}},
      {"needle_side", emissive(needle), {1, 0.5, 2}},
      {"needle_tip", emissive(needle), {0.125, 0, 3.5}},
      {"one_sphere_in_the_other", emissive(capsule({0, 0, 0}, {0.2f, 0, 0}, 1, 0.5f)), {2, 1, 0}},
      {"sheared_tapered", emissive(cone, sheared()), {1, 2, 1.5}},
      {"mirrored_capsule", emissive(level, mirror), {1.5, 1, 1}},
      {"triangle_large", emissive(triangle_low), {0.25, 0.125, 2.75}},
      {"triangle_medium", emissive(triangle_low), {0.5, -2, 6}},
      {"triangle_small", emissive(triangle_low), {10, 20, 30}},
      {"triangle_grazing", emissive(triangle_low), {4, 0, 3.5}},
      {"triangle_mirrored", emissive(triangle_low, mirror), {0.5, 0, 2}},
      {"triangle_two_sided", emissive(triangle_low, glm::dmat4(1), true), {0.5, 0.25, 0.5}},
      {"disk_medium", emissive(DiskShape{1.5, 0.8}), {1, 0.5, 2.5}},
      {"disk_close", emissive(DiskShape{1.5, 0.8}), {0.25, 0.5, 1.75}},
      {"disk_reversed", reversed, {1, 0.5, 0.5}},
      {"disk_sheared", emissive(DiskShape{0.2, 1}, sheared()), {1, 0, 3}},
      {"cylinder_side", emissive(tube), {1.5, 0.5, 0.25}, 300000, true},
      {"cylinder_end", emissive(tube), {0.5, 0.25, 2.5}, 300000, true},
      {"cylinder_inside", turned(emissive(tube)), {0.125, 0.25, 0.25}},
      {"cylinder_dark_end", dark_end, {1.5, 0.25, -2}, 300000, true},
      {"cylinder_open_end", emissive(pipe, glm::dmat4(1), true), {0.25, 0.5, 3}, 300000, true},
      {"cylinder_sheared", emissive(tube, sheared()), {1, 2, 2}, 300000, true},
      {"box_medium", emissive(box), {2, 1, 3}, 100000, true},
      {"box_inside_ball", emissive(box), {0.25, 0.5, 0.75}, 100000, true},
      {"box_sheared", emissive(box, sheared()), {3, 1, 2}, 100000, true},
      {"box_turned_inside", turned(emissive(box)), {0.25, 0.125, 0.25}, 100000},
      {"cone_side", emissive(frustum), {1.5, 0.5, 0.25}, 300000, true},
      {"cone_end", emissive(point_up), {0.25, 0.125, -1}, 300000, true},
      {"cone_sheared", emissive(frustum, sheared()), {1, 2, 2}, 300000, true},
      {"polyhedron_medium", emissive(crystal), {2, 2, 1}, 300000, true},
      {"polyhedron_turned_inside", turned(emissive(crystal)), {0.25, 0.125, 0.25}, 300000},
      {"partial_sphere_medium", emissive(dome), {2, 2, 1}, 300000, true},
      {"partial_sphere_turned", turned(emissive(dome)), {0.25, -0.25, 0}, 300000, true},
      {"open_cylinder_side", emissive(gutter), {1.5, 0.5, 0.25}, 300000, true},
      {"open_cylinder_sheared", emissive(gutter, sheared()), {1, 3, 2}, 300000, true},
      {"partial_disk_medium", emissive(washer), {1, 0.5, 2.5}, 300000, true},
      {"partial_disk_sheared", emissive(washer, sheared()), {1, 0, 3}, 300000, true},
      {"bilinear_medium", emissive(saddle), {0.5, 0.25, 3}, 300000, true},
      {"bilinear_mirrored", emissive(saddle, mirror), {0.5, 0.25, 3}, 300000, true},
      {"molecular_ball",
       emissive(make_molecule({{0.25f, 0, 0}}, {0.75f}, 1)),
       {1.5, 0.5, 0.25},
       300000,
       true},
      {"molecular_ball_sheared",
       emissive(make_molecule({{0.25f, 0, 0}}, {0.75f}, 1), sheared()),
       {1, 2, 2},
       300000,
       true},
      {"csg_lens",
       emissive(balls(CsgShape::Operation::set_intersection)),
       {1.5, 1, 1},
       300000,
       true},
      {"csg_turned_inside",
       turned(emissive(balls(CsgShape::Operation::set_intersection))),
       {0.125, 0.25, 0.25},
       300000},
  };
  return all;
}

/// The kind that the case's shape is lowered to.
int kind_of(const AreaCase& c) {
  return static_cast<int>(lower(scene_of(c.shape)).geometries.at(0).shape);
}

class AreaLight : public testing::TestWithParam<AreaCase> {};

/// Cells of directions about an axis: equal steps of the square of the polar angle up to `limit`,
/// and of azimuth.
struct Cells {
  glm::dvec3 z, x, y;
  double limit;
  static constexpr int rings = 10, sectors = 16, count = rings * sectors;
  Cells(const glm::dvec3& axis, double widest) : z(axis), limit(widest) {
    x = glm::normalize(
        glm::cross(z, std::abs(z.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    y = glm::cross(z, x);
  }
  std::size_t at(const glm::dvec3& d) const {
    const double polar =
        std::atan2(std::hypot(glm::dot(d, x), glm::dot(d, y)), glm::dot(d, z)) / limit;
    const double turn = std::atan2(glm::dot(d, y), glm::dot(d, x)) / (2 * pi) + 0.5;
    const int ring = std::min(static_cast<int>(polar * polar * rings), rings - 1);
    return static_cast<std::size_t>(ring * sectors +
                                    std::min(static_cast<int>(turn * sectors), sectors - 1));
  }
};

struct Moments {
  double mean = 0, error = 0;
};
template <class F>
Moments moments(const std::vector<SampledLight>& samples, F f) {
  double sum = 0, squares = 0;
  for (const SampledLight& s : samples) {
    const double x = s.pdf > 0 ? f(s) : 0;
    sum += x;
    squares += x * x;
  }
  const auto n = static_cast<double>(samples.size());
  return {sum / n, std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n)) / n)};
}

}  // namespace

TEST_P(AreaLight, SamplesFollowTheDensityAndSeeNothingInBetween) {
  const AreaCase& c = GetParam();
  const Scene scene = scene_of(c.shape);
  const FlatScene flat = lower(scene);
  ASSERT_EQ(flat.lights.size(), 1u);
  LightBench bench(flat);
  const std::vector<SampledLight> samples = bench.sample(c.p, sample_count);
  const bool both = c.shape.emission->two_sided;

  // The seen surface: its solid angle, the irradiance it gives, the density's integral, and the
  // expected counts.
  std::vector<SurfacePoint> seen;
  for (const SurfacePoint& point : surface_points(c.shape, c.points))
    if (both || glm::dot(c.p - point.p, point.n) > 0) seen.push_back(point);
  ASSERT_FALSE(seen.empty());
  const std::vector<double> pdf = bench.area_pdf(0, c.p, seen);
  glm::dvec3 axis(0);
  const glm::dvec3 receiver = glm::normalize(glm::dvec3(0.3, -0.5, 0.8));
  std::vector<double> solid(seen.size());
  std::vector<glm::dvec3> directions(seen.size());
  double solid_angle = 0, irradiance = 0, total = 0, widest = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const glm::dvec3 away = seen[i].p - c.p;
    const double distance = glm::length(away);
    directions[i] = away / distance;
    solid[i] = std::abs(glm::dot(directions[i], seen[i].n)) / (distance * distance) * seen[i].area;
    axis += directions[i] * solid[i];
    solid_angle += solid[i];
    irradiance += solid[i] * std::max(0.0, glm::dot(directions[i], receiver));
    total += solid[i] * pdf[i];
  }
  axis = glm::length(axis) > 0.05 * solid_angle ? glm::normalize(axis) : glm::dvec3(0, 0, 1);
  for (const glm::dvec3& d : directions)
    widest = std::max(widest, std::acos(std::clamp(glm::dot(d, axis), -1.0, 1.0)));
  const Cells cells(axis, widest);
  std::vector<double> expected(Cells::count + 1, 0),
      observed(Cells::count + 1, 0);  // the last: samples that miss
  for (std::size_t i = 0; i < seen.size(); ++i)
    expected[cells.at(directions[i])] += solid[i] * pdf[i] * sample_count;
  // A low-discrepancy mean over n points of what jumps along a curve is off by about n^(-3/4), 1e-4
  // here; of what grows like one over the root of the distance from that curve (the caps' density
  // at the silhouette), ten times that.
  if (c.may_miss) {
    EXPECT_LT(total, 1 + 2e-3) << "the density's integral";
    expected.back() = std::max(0.0, 1 - total) * sample_count;
  } else {
    EXPECT_NEAR(total, 1, 2e-3) << "the density's integral";
  }

  std::size_t occluded = 0, missing = 0;
  for (const SampledLight& s : samples) {
    if (!(s.pdf > 0)) {
      ++missing;
      continue;
    }
    observed[cells.at(s.wi)] += 1;
    EXPECT_NEAR(s.radiance, 1, 1e-5);
    EXPECT_FALSE(s.infinite);
    EXPECT_FALSE(s.delta);
    occluded += s.occluded;
  }
  // Samples at the very rim, where rounding decides.
  if (c.may_miss)
    observed.back() = static_cast<double>(missing);
  else
    EXPECT_LE(missing, sample_count / 1000);
  EXPECT_EQ(occluded, 0u) << "shadow rays that the light itself stops";
  const ChiSquareResult chi = chi_square(observed, expected);
  EXPECT_GT(chi.p_value, sidak(0.01, static_cast<int>(cases().size())))
      << chi.statistic << " / " << chi.degrees_of_freedom;

  const Moments angle = moments(samples, [](const SampledLight& s) { return 1 / s.pdf; });
  EXPECT_NEAR(angle.mean, solid_angle, 4 * angle.error + 1e-3 * solid_angle);
  const Moments light = moments(samples, [&](const SampledLight& s) {
    return s.radiance * std::max(0.0, glm::dot(s.wi, receiver)) / s.pdf;
  });
  EXPECT_NEAR(light.mean, irradiance, 4 * light.error + 1e-3 * irradiance);
}

INSTANTIATE_TEST_SUITE_P(Cases, AreaLight, testing::ValuesIn(cases()),
                         [](const testing::TestParamInfo<AreaCase>& row) {
                           return row.param.name;
                         });

TEST(AreaLightCases, EveryShapeIsOnTrial) {
  std::set<int> tried;
  for (const AreaCase& c : cases()) tried.insert(kind_of(c));
  for (const ShapeKind& kind : shape_kinds()) EXPECT_TRUE(tried.contains(kind.shape)) << kind.name;
}

TEST(AreaLightClosedForm, SphereIrradiance) {
  // E = pi L (r / d)^2 cos, for a sphere wholly above the horizon.
  const FlatScene flat = lower(scene_of(emissive(SphereShape{0.75}, moved(1, 2, 3))));
  LightBench bench(flat);
  const glm::dvec3 p(0.5, 0, 0);
  const glm::dvec3 away = glm::dvec3(1, 2, 3) - p;
  const Moments e =
      moments(bench.sample(p, sample_count), [](const SampledLight& s) { return s.wi.z / s.pdf; });
  const double expected = pi * 0.75 * 0.75 / glm::dot(away, away) * away.z / glm::length(away);
  EXPECT_NEAR(e.mean, expected, 3 * e.error + 1e-5 * expected);
  EXPECT_LT(e.error, 0.005 * expected);
}

TEST(AreaLightClosedForm, SolidAngleOfANearSphere) {
  // 2 pi (1 - cos), from a hundredth and from ten thousand radii away.
  const FlatScene flat = lower(scene_of(emissive(SphereShape{1})));
  LightBench bench(flat);
  for (const double distance : {1.01, 1e4}) {
    const Moments angle = moments(bench.sample({0, distance, 0}, 1000),
                                  [](const SampledLight& s) { return 1 / s.pdf; });
    const double sine = 1 / distance;
    const double expected = 2 * pi * sine * sine / (1 + std::sqrt(1 - sine * sine));
    // Rounding of the distance (1e-7) in the square root's argument 1 - sin^2, which is 0.02 at the
    // near place.
    EXPECT_NEAR(angle.mean, expected, 1e-5 * expected);
  }
}

TEST(AreaLightClosedForm, DiskIrradianceOnItsAxis) {
  // E = pi L r^2 / (r^2 + h^2).
  Shape disk = emissive(DiskShape{2, 1.5});
  disk.reverse_orientation = true;
  const FlatScene flat = lower(scene_of(disk));
  LightBench bench(flat);
  const Moments e = moments(bench.sample({0, 0, 0}, sample_count),
                            [](const SampledLight& s) { return s.wi.z / s.pdf; });
  const double expected = pi * 2.25 / (2.25 + 4);
  EXPECT_NEAR(e.mean, expected, 3 * e.error + 1e-5 * expected);
  EXPECT_LT(e.error, 0.005 * expected);
}

TEST(AreaLightClosedForm, TriangleIrradiance) {
  // Lambert 1760: E = L / 2 times the sum over edges of the angle subtended times the cosine of the
  // edge plane's normal.
  const glm::dvec3 corner[3] = {{-1, -1, 2}, {0.2, 1, 2}, {1, -1, 2.5}};
  const FlatScene flat = lower(scene_of(emissive(triangle(corner[0], corner[1], corner[2]))));
  LightBench bench(flat);
  double expected = 0;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 a = glm::normalize(corner[i]), b = glm::normalize(corner[(i + 1) % 3]);
    expected += 0.5 * std::acos(glm::dot(a, b)) * glm::normalize(glm::cross(a, b)).z;
  }
  const Moments e = moments(bench.sample({0, 0, 0}, sample_count),
                            [](const SampledLight& s) { return s.wi.z / s.pdf; });
  EXPECT_NEAR(e.mean, std::abs(expected), 3 * e.error + 1e-5);
  EXPECT_LT(e.error, 0.005 * std::abs(expected));
}

TEST(AreaLightSides, OneSidedLightsAreDarkFromBehind) {
  for (const Shape& shape :
       {emissive(SphereShape{2}), emissive(triangle({-1, -1, -2}, {1, -1, -2}, {0, 1, -2})),
        emissive(DiskShape{2, 1}), emissive(capsule({0, 0, -1}, {0, 0, 1}, 1, 0.5f))}) {
    const bool faces_away = !std::holds_alternative<TriangleMeshShape>(shape.geometry);
    const FlatScene flat = lower(scene_of(shape));
    LightBench bench(flat);
    const Moments lit =
        moments(bench.sample({0.125, 0.25, 0.125}, 1000), [](const SampledLight&) { return 1.0; });
    EXPECT_EQ(lit.mean, faces_away ? 0 : 1);
  }
}

TEST(AreaLightSides, SolidsTurnedInsideOutEmitInward) {
  const glm::dmat4 stretched = glm::scale(glm::dmat4(1), {1.0, 1.0, 1.5});
  for (Shape shape : {emissive(SphereShape{2}), emissive(SphereShape{2}, stretched),
                      emissive(capsule({0, 0, -1}, {0, 0, 1}, 2, 2)),
                      emissive(capsule({0, 0, -1}, {0, 0, 1}, 2, 1.5f))}) {
    shape.reverse_orientation = true;
    const FlatScene flat = lower(scene_of(shape));
    LightBench bench(flat);
    // All around p: E = pi L whatever the shape.
    const Moments e =
        moments(bench.sample({0.5, 0.25, -0.5}, sample_count),
                [](const SampledLight& s) { return std::max(0.0, double(s.wi.z)) / s.pdf; });
    EXPECT_NEAR(e.mean, pi, 3 * e.error + 1e-5 * pi);
    EXPECT_LT(e.error, 0.01 * pi);
    for (const glm::dvec3& outside : {glm::dvec3(0.25, 5, 0.5), glm::dvec3(0, 0, 40)}) {
      const Moments lit =
          moments(bench.sample(outside, 1000), [](const SampledLight&) { return 1.0; });
      EXPECT_EQ(lit.mean, 0);
    }
  }
}

TEST(AreaLightEdges, SamplesAreFinitePointsOnTheRimOfTheRange) {
  // Random numbers at both ends of [0, 1) are as good as others: thousands of lights are seen at
  // their worst by the sweep of places on and next to the surface.
  const Shape shape = emissive(capsule({0, 0, -1}, {0, 0, 1}, 0.5f, 0.25f), glm::dmat4(1), true);
  const FlatScene flat = lower(scene_of(shape));
  LightBench bench(flat);
  for (const double off : {-1e-3, -1e-7, 0.0, 1e-7, 1e-3, 1e3}) {
    for (const SurfacePoint& at : surface_points(shape, 18)) {
      for (const SampledLight& s : bench.sample(at.p + off * at.n, 64)) {
        if (!(s.pdf != 0)) continue;
        EXPECT_TRUE(std::isfinite(s.pdf) && s.pdf > 0);
        EXPECT_NEAR(glm::length(s.wi), 1, 1e-5);
        EXPECT_TRUE(std::isfinite(s.target.x + s.target.y + s.target.z));
      }
    }
  }
}

}  // namespace caplet::test::area_test
