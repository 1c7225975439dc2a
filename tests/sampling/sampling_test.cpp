// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Random numbers, pixel filter and camera rays, as the device computes them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include "camera_rays.h"
#include "device/device.h"
#include "lower/camera.h"
#include "lower/detail/filter.h"
#include "lower/lower.h"
#include "support/filters.h"
#include "support/test_device.h"

namespace caplet::test::sampling_test {

namespace {

const char* const kernel_text = R"(
#include "camera/camera.cl"
#include "math/filter.cl"
#include "samplers/samplers.cl"

__kernel void numbers(__global const ViewRecord* view, uint x, uint y, uint dimension, __global float* out, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  const PathSample at = sample_of_pixel(view, x, y, i);
  vstore2(sampler_2d(at, dimension), i, out);
  out[2 * count + i] = sampler_1d(at, dimension);
}
__kernel void units(__global float* out) {
  out[0] = unit_float(0u);
  out[1] = unit_float(0xffffffffu);
}
__kernel void seeds(__global uint* out, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i < count) out[i] = pixel_seed(i % 256u, i / 256u, 3u);
}
__kernel void hashes(__global uint* out, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i < count) out[i] = hash_combine(i / 64u, i % 64u);
}
__kernel void filters(__global const ViewRecord* view, __global const float* table, __global const float* u,
                      __global float* out, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  float weight;
  vstore2(filter_sample(table, view->filter_width, view->filter_height, vload2(i, u), &weight), 0, out + 3 * i);
  out[3 * i + 2] = weight;
}
__kernel void rays(__global const CameraRecord* camera, __global const float* table, __global const float* in,
                   __global RayRecord* out, __global float* weights, uint count) {
  const uint i = (uint)get_global_id(0);
  float weight;
  if (i >= count) return;
  out[i] = camera_ray(camera, table, vload2(2 * i, in), vload2(2 * i + 1, in), &weight);
  weights[i] = weight;
}
__kernel void spread(__global const CameraRecord* camera, __global const float* table, float x, float y,
                     __global float* out) {
  vstore2(camera_spread(camera, table, (float2)(x, y)), 0, out);
}
)";

struct Bench {
  Device device = test_device();
  Program program = Program::from_source(device, "sampling_test", flatten_kernels(kernel_text), "");
};
Bench& bench() {
  static Bench built;
  return built;
}

struct Numbers {
  std::vector<glm::dvec2> pairs;
  std::vector<double> singles;
};
/// Returns numbers of pixel `pixel` of an image that is 256 pixels wide.
Numbers numbers(std::uint32_t pixel, std::uint32_t pair, std::uint32_t count,
                const SamplerSettings& sampler = {}) {
  Scene scene;
  scene.view.film.width = scene.view.film.height = 256;
  scene.view.sampler = sampler;
  const FlatView flat = lower_view(scene);
  const Buffer<ViewRecord> view(bench().device, std::span(&flat.view, 1));
  Buffer<float> out(bench().device, 3 * count);
  cl::Kernel kernel = bench().program.kernel("numbers");
  kernel.setArg(0, view.handle());
  kernel.setArg(1, pixel % 256);
  kernel.setArg(2, pixel / 256);
  kernel.setArg(3, pair);
  kernel.setArg(4, out.handle());
  kernel.setArg(5, count);
  launch(bench().device, kernel, count, 1);
  const std::vector<float> values = out.read();
  Numbers result;
  for (std::size_t i = 0; i < count; ++i) {
    result.pairs.emplace_back(values[2 * i], values[2 * i + 1]);
    result.singles.push_back(values[2 * count + i]);
  }
  return result;
}

std::vector<std::uint32_t> hashed(const char* name, std::uint32_t count) {
  Buffer<std::uint32_t> out(bench().device, count);
  cl::Kernel kernel = bench().program.kernel(name);
  kernel.setArg(0, out.handle());
  kernel.setArg(1, count);
  launch(bench().device, kernel, count, 1);
  return out.read();
}

double correlation(const std::vector<glm::dvec2>& a, const std::vector<glm::dvec2>& b, int i,
                   int j) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k][i] - 0.5) * (b[k][j] - 0.5);
  return 12 * sum / static_cast<double>(a.size());
}

struct FilterSamples {
  std::vector<glm::dvec2> offsets;
  std::vector<double> weights;
};
FilterSamples filter_samples(const PixelFilter& filter, std::size_t count) {
  FlatView flat;
  lower_filter(filter, flat);
  std::mt19937 engine(17);
  std::vector<float> u(2 * count);
  for (float& x : u) x = static_cast<float>(engine() >> 8) * 0x1p-24f;
  const Buffer<ViewRecord> view(bench().device, std::span<const ViewRecord>(&flat.view, 1));
  const Buffer<float> table(bench().device, std::span<const float>(flat.filter_table));
  const Buffer<float> in(bench().device, std::span<const float>(u));
  Buffer<float> out(bench().device, 3 * count);
  cl::Kernel kernel = bench().program.kernel("filters");
  kernel.setArg(0, view.handle());
  kernel.setArg(1, table.handle());
  kernel.setArg(2, in.handle());
  kernel.setArg(3, out.handle());
  kernel.setArg(4, static_cast<cl_uint>(count));
  launch(bench().device, kernel, count, 1);
  FilterSamples samples;
  const std::vector<float> values = out.read();
  for (std::size_t i = 0; i < count; ++i) {
    samples.offsets.emplace_back(values[3 * i], values[3 * i + 1]);
    samples.weights.push_back(values[3 * i + 2]);
  }
  return samples;
}

}  // namespace

namespace {

/// The table, or a number in its place: buffers have at least one.
std::vector<float> table_of(const FlatView& flat) {
  return flat.camera_table.empty() ? std::vector<float>{0} : flat.camera_table;
}

}  // namespace

std::vector<WeighedRay> camera_rays(const Scene& scene, const std::vector<glm::vec4>& samples) {
  FlatView flat;
  lower_camera(scene, flat);
  const std::vector<CameraRecord> record = {flat.camera};
  const std::vector<float> table_values = table_of(flat);
  std::vector<float> in;
  for (const glm::vec4& of : samples) in.insert(in.end(), {of.x, of.y, of.z, of.w});
  const Buffer<CameraRecord> camera(bench().device, std::span<const CameraRecord>(record));
  const Buffer<float> table(bench().device, std::span<const float>(table_values)),
      input(bench().device, std::span<const float>(in));
  Buffer<RayRecord> out(bench().device, samples.size());
  Buffer<float> weights(bench().device, samples.size());
  cl::Kernel kernel = bench().program.kernel("rays");
  kernel.setArg(0, camera.handle());
  kernel.setArg(1, table.handle());
  kernel.setArg(2, input.handle());
  kernel.setArg(3, out.handle());
  kernel.setArg(4, weights.handle());
  kernel.setArg(5, static_cast<cl_uint>(samples.size()));
  launch(bench().device, kernel, samples.size(), 1);
  const std::vector<RayRecord> rays = out.read();
  const std::vector<float> weighs = weights.read();
  std::vector<WeighedRay> both;
  for (std::size_t i = 0; i < rays.size(); ++i) both.push_back({rays[i], weighs[i]});
  return both;
}

RayRecord camera_ray(const Scene& scene, glm::vec2 raster, glm::vec2 lens) {
  return camera_rays(scene, {glm::vec4(raster, lens)})[0].ray;
}

std::vector<float> camera_spread(const Scene& scene, glm::vec2 raster) {
  FlatView flat;
  lower_camera(scene, flat);
  const std::vector<CameraRecord> record = {flat.camera};
  const std::vector<float> table_values = table_of(flat);
  const Buffer<CameraRecord> camera(bench().device, std::span<const CameraRecord>(record));
  const Buffer<float> table(bench().device, std::span<const float>(table_values));
  Buffer<float> out(bench().device, 2);
  cl::Kernel kernel = bench().program.kernel("spread");
  kernel.setArg(0, camera.handle());
  kernel.setArg(1, table.handle());
  kernel.setArg(2, raster.x);
  kernel.setArg(3, raster.y);
  kernel.setArg(4, out.handle());
  launch(bench().device, kernel, 1, 1);
  return out.read();
}

namespace {}  // namespace

TEST(Sampler, EveryPowerOfTwoPrefixIsANet) {
  for (std::uint32_t seed : {0u, 1u, 0xbeefu}) {
    const Numbers all = numbers(seed, seed % 7, 1024);
    for (int m = 0; m <= 10; ++m) {
      for (int k = 0; k <= m; ++k) {
        // 2^k columns times 2^(m-k) rows: each of the 2^m boxes holds one of the first 2^m points.
        std::set<std::pair<int, int>> boxes;
        for (int i = 0; i < 1 << m; ++i) {
          const glm::dvec2 p = all.pairs[static_cast<std::size_t>(i)];
          boxes.emplace(static_cast<int>(p.x * (1 << k)), static_cast<int>(p.y * (1 << (m - k))));
        }
        EXPECT_EQ(boxes.size(), std::size_t{1} << m) << "seed " << seed << " m " << m << " k " << k;
      }
      std::set<int> strata;
      for (int i = 0; i < 1 << m; ++i)
        strata.insert(static_cast<int>(all.singles[static_cast<std::size_t>(i)] * (1 << m)));
      EXPECT_EQ(strata.size(), std::size_t{1} << m);
    }
  }
}

TEST(Sampler, NumbersAreInTheHalfOpenUnitInterval) {
  const Numbers all = numbers(5, 3, 1u << 20);
  for (std::size_t i = 0; i < all.pairs.size(); ++i) {
    const bool inside = all.pairs[i].x >= 0 && all.pairs[i].x < 1 && all.pairs[i].y >= 0 &&
                        all.pairs[i].y < 1 && all.singles[i] >= 0 && all.singles[i] < 1;
    ASSERT_TRUE(inside) << i;
  }
  Buffer<float> ends(bench().device, 2);
  cl::Kernel kernel = bench().program.kernel("units");
  set_arguments(bench().device, kernel, ends);
  launch(bench().device, kernel, 1, 1);
  EXPECT_EQ(ends.read()[0], 0);
  EXPECT_LT(ends.read()[1], 1);
}

TEST(Sampler, NumbersDependOnTheirAddressAlone) {
  const Numbers many = numbers(9, 2, 777), few = numbers(9, 2, 100);
  for (std::size_t i = 0; i < few.pairs.size(); ++i) {
    EXPECT_EQ(many.pairs[i], few.pairs[i]);
    EXPECT_EQ(many.singles[i], few.singles[i]);
  }
}

TEST(Sampler, PixelsAndPairsAreUncorrelated) {
  constexpr std::uint32_t n = 4096;
  std::vector<std::vector<glm::dvec2>> sets;
  for (std::uint32_t pair = 0; pair < 6; ++pair) sets.push_back(numbers(77, pair, n).pairs);
  for (std::uint32_t pixel = 0; pixel < 4; ++pixel) sets.push_back(numbers(pixel, 0, n).pairs);
  for (std::size_t a = 0; a < sets.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
          EXPECT_LT(std::abs(correlation(sets[a], sets[b], i, j)), 4 / std::sqrt(n))
              << a << ' ' << b << ' ' << i << ' ' << j;
}

TEST(Sampler, FirstSamplesOfPixelsAreUniform) {
  // Across pixels the first sample is a hash: mean 1/2 with standard error 1 / sqrt(12 n), and no
  // correlation of the coordinates.
  const std::vector<std::uint32_t> seeds = hashed("seeds", 512);
  EXPECT_EQ(std::set<std::uint32_t>(seeds.begin(), seeds.end()).size(), seeds.size());
  std::vector<glm::dvec2> firsts;
  glm::dvec2 mean(0);
  for (std::uint32_t pixel = 0; pixel < 512; ++pixel) {
    firsts.push_back(numbers(pixel, 1, 1).pairs[0]);
    mean += firsts.back() / 512.0;
  }
  EXPECT_NEAR(mean.x, 0.5, 4 / std::sqrt(12 * 512.0));
  EXPECT_NEAR(mean.y, 0.5, 4 / std::sqrt(12 * 512.0));
  EXPECT_LT(std::abs(correlation(firsts, firsts, 0, 1)), 4 / std::sqrt(512.0));
}

TEST(Sampler, HashFlipsHalfOfTheBits) {
  const std::vector<std::uint32_t> values = hashed("hashes", 64 * 64);
  EXPECT_EQ(std::set<std::uint32_t>(values.begin(), values.end()).size(), values.size());
  double flips_a = 0, flips_b = 0;
  for (std::uint32_t a = 0; a < 63; ++a)
    for (std::uint32_t b = 0; b < 63; ++b) {
      flips_a += __builtin_popcount(values[a * 64 + b] ^ values[(a + 1) * 64 + b]);
      flips_b += __builtin_popcount(values[a * 64 + b] ^ values[a * 64 + b + 1]);
    }
  // The mean of 63^2 times 32 fair bits: standard error 0.5 sqrt(32) / 63.
  EXPECT_NEAR(flips_a / (63 * 63), 16, 4 * 0.5 * std::sqrt(32) / 63);
  EXPECT_NEAR(flips_b / (63 * 63), 16, 4 * 0.5 * std::sqrt(32) / 63);
}

TEST(Sampler, SmoothIntegralsConvergeFasterThanAtRandom) {
  // f = exp(-x - y): random sampling has variance (1 - e^-2)^2 / 4 - (1 - 1/e)^4 = 0.0272 a sample.
  const double exact = std::pow(1 - std::exp(-1), 2);
  constexpr int n = 256, pixels = 64;
  double squares = 0;
  for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
    double sum = 0;
    for (const glm::dvec2& p : numbers(1000 + pixel, 4, n).pairs) sum += std::exp(-p.x - p.y) / n;
    squares += (sum - exact) * (sum - exact) / pixels;
  }
  EXPECT_LT(squares, 0.0272 / n / 50);
}

// --- Spherical cameras ---

Scene spherical_scene(SphericalProjection::Mapping mapping) {
  Scene scene;
  scene.view.film.width = 400;
  scene.view.film.height = 200;
  scene.view.camera.projection = SphericalProjection{mapping};
  return scene;
}

glm::dvec3 direction_of(const RayRecord& ray) { return {ray.dx, ray.dy, ray.dz}; }

// Rows run from +y to -y, and columns from +x by +z.
TEST(SphericalCamera, LooksByLongitudeAndLatitude) {
  const Scene scene = spherical_scene(SphericalProjection::Mapping::equirectangular);
  const std::pair<glm::vec2, glm::dvec3> all[] = {{{0, 100}, {1, 0, 0}},
                                                  {{100, 100}, {0, 0, 1}},
                                                  {{200, 100}, {-1, 0, 0}},
                                                  {{50, 0}, {0, 1, 0}},
                                                  {{50, 200}, {0, -1, 0}}};
  for (const auto& [raster, direction] : all)
    EXPECT_LT(glm::length(direction_of(camera_ray(scene, raster, {0.5f, 0.5f})) - direction), 1e-6)
        << raster.x << ' ' << raster.y;
}

// The middle of the square is +y, its corners are -y, and the middles of its sides the horizon.
TEST(SphericalCamera, LooksByTheOctahedralMap) {
  const Scene scene = spherical_scene(SphericalProjection::Mapping::equal_area);
  const std::pair<glm::vec2, glm::dvec3> all[] = {{{200, 100}, {0, 1, 0}},
                                                  {{0, 0}, {0, -1, 0}},
                                                  {{400, 200}, {0, -1, 0}},
                                                  {{400, 100}, {1, 0, 0}},
                                                  {{200, 200}, {0, 0, 1}}};
  for (const auto& [raster, direction] : all)
    EXPECT_LT(glm::length(direction_of(camera_ray(scene, raster, {0.5f, 0.5f})) - direction), 1e-6)
        << raster.x << ' ' << raster.y;
  // Each of equal parts of the square has an equal share of the sphere: the mean of z^2 over it is
  // 1/3.
  double sum = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      const double z =
          unproject(scene.view.camera, scene.view.film, {10 * x + 5, 5 * y + 2.5}).direction.z;
      sum += z * z / 1600;
    }
  EXPECT_NEAR(sum, 1.0 / 3, 1e-3);
}

// Over an edge lies the other half of the edge.
TEST(SphericalCamera, GoesOnBeyondTheImage) {
  const Scene area = spherical_scene(SphericalProjection::Mapping::equal_area);
  const auto at = [](const Scene& scene, float x, float y) {
    return direction_of(camera_ray(scene, {x, y}, {0.5f, 0.5f}));
  };
  EXPECT_LT(glm::length(at(area, -3, 40) - at(area, 3, 160)), 1e-6);
  EXPECT_LT(glm::length(at(area, 403, 40) - at(area, 397, 160)), 1e-6);
  EXPECT_LT(glm::length(at(area, 90, -2) - at(area, 310, 2)), 1e-6);
  EXPECT_LT(glm::length(at(area, 90, 202) - at(area, 310, 198)), 1e-6);
  const Scene around = spherical_scene(SphericalProjection::Mapping::equirectangular);
  EXPECT_LT(glm::length(at(around, -3, 40) - at(around, 397, 40)), 1e-6);
}

// Its rays leave one point, whatever lens a file gives it.
TEST(SphericalCamera, HasNoLens) {
  Scene scene = spherical_scene(SphericalProjection::equirectangular);
  scene.view.camera.lens_radius = 2;
  FlatView out;
  lower_camera(scene, out);
  EXPECT_EQ(out.camera.lens_radius, 0);
  EXPECT_EQ(out.camera.origins, 0u);
  const RayRecord ray = camera_ray(scene, {100, 100}, {0.9f, 0.2f});
  EXPECT_EQ(glm::dvec3(ray.ox, ray.oy, ray.oz), glm::dvec3(0));
}

Scene fisheye_scene(FisheyeProjection::Mapping mapping, double fov) {
  Scene scene;
  scene.view.film.width = 400;
  scene.view.film.height = 200;
  scene.view.camera.projection = FisheyeProjection{mapping, fov};
  return scene;
}

// The field of view is that of the shorter side; by the equidistant map, angles are proportional to
// distances from the middle, to straight behind.
TEST(Fisheye, AnglesAreDistances) {
  const Scene scene = fisheye_scene(FisheyeProjection::equidistant, 180);
  const double half = std::sqrt(0.5);
  const std::pair<glm::vec2, glm::dvec3> all[] = {
      {{200, 100}, {0, 0, 1}},        {{200, 0}, {0, 1, 0}},         {{300, 100}, {1, 0, 0}},
      {{100, 100}, {-1, 0, 0}},       {{250, 100}, {half, 0, half}}, {{200, 150}, {0, -half, half}},
      {{350, 100}, {half, 0, -half}}, {{400, 100}, {0, 0, -1}},      {{400, 0}, {0, 0, -1}}};
  for (const auto& [raster, direction] : all)
    EXPECT_LT(glm::length(direction_of(camera_ray(scene, raster, {0.5f, 0.5f})) - direction), 1e-6)
        << raster.x << ' ' << raster.y;
}

// A disk of the picture whose edge is at the angle a has the solid angle 2 pi (1 - cos a), which is
// in proportion to its area.
TEST(Fisheye, EquisolidAreasAreSolidAngles) {
  const Scene scene = fisheye_scene(FisheyeProjection::equisolid, 240);
  const double at_edge = 1 - std::cos(glm::radians(120.0));
  for (const float radius : {20.0f, 50.0f, 80.0f, 100.0f}) {
    const glm::dvec3 d =
        direction_of(camera_ray(scene, {200 + 0.6f * radius, 100 + 0.8f * radius}, {0.5f, 0.5f}));
    EXPECT_NEAR(1 - d.z, at_edge * radius * radius / 1e4, 1e-5) << radius;
    EXPECT_NEAR(d.x * 0.8 + d.y * 0.6, 0, 1e-6) << radius;
  }
}

// Those of two rays half a pixel apart, outward and around, as far as the pixel is small.
TEST(Fisheye, FootprintsAreDistancesOfRays) {
  for (const auto mapping : {FisheyeProjection::equidistant, FisheyeProjection::equisolid}) {
    const Scene scene = fisheye_scene(mapping, 200);
    const Camera& camera = scene.view.camera;
    for (const glm::dvec2& raster : {glm::dvec2(200.5, 100.5), {260, 40}, {120, 180}, {330, 100}}) {
      const glm::dvec2 from_middle = raster - glm::dvec2(200, 100);
      const glm::dvec2 out = 0.5 * glm::normalize(from_middle), around(-out.y, out.x);
      const auto apart = [&](const glm::dvec2& step) {
        return glm::length(unproject(camera, scene.view.film, raster + step).direction -
                           unproject(camera, scene.view.film, raster - step).direction);
      };
      const glm::dvec3 point = 5.0 * unproject(camera, scene.view.film, raster).direction;
      EXPECT_NEAR(pixel_footprint(camera, scene.view.film, point) / 5,
                  std::min(apart(out), apart(around)), 1e-5);
    }
  }
}

// The angle between neighbours is the mean of that outward and around for fisheyes, of that along
// columns and rows by longitude and latitude; equal areas have equal shares of the sphere.
TEST(Cameras, SpreadIsTheAngleBetweenNeighbours) {
  const auto apart = [](const Scene& scene, const glm::dvec2& at, const glm::dvec2& step) {
    return glm::length(unproject(scene.view.camera, scene.view.film, at + step).direction -
                       unproject(scene.view.camera, scene.view.film, at - step).direction);
  };
  for (const auto mapping : {FisheyeProjection::equidistant, FisheyeProjection::equisolid}) {
    const Scene scene = fisheye_scene(mapping, 200);
    for (const glm::dvec2& at : {glm::dvec2(260, 40), {120, 180}, {300, 100}}) {
      const glm::dvec2 out = 0.5 * glm::normalize(at - glm::dvec2(200, 100)), around(-out.y, out.x);
      const std::vector<float> spread = camera_spread(scene, at);
      EXPECT_EQ(spread[0], 0);
      EXPECT_NEAR(spread[1], (apart(scene, at, out) + apart(scene, at, around)) / 2, 1e-5);
    }
  }
  const Scene around = spherical_scene(SphericalProjection::equirectangular);
  for (const glm::dvec2& at : {glm::dvec2(100, 20), {300, 150}, {10, 100}})
    EXPECT_NEAR(camera_spread(around, at)[1],
                (apart(around, at, {0.5, 0}) + apart(around, at, {0, 0.5})) / 2, 1e-5);
  const double share = camera_spread(spherical_scene(SphericalProjection::equal_area), {9, 9})[1];
  EXPECT_NEAR(share * share, 4 * std::numbers::pi / (400 * 200), 1e-9);
}

// The host's rays are the device's, and points project back to where their ray came from.
TEST(Projections, UndoEachOther) {
  std::vector<Scene> scenes(8);
  scenes[0].view.camera.projection = PerspectiveProjection{0.9};
  scenes[1].view.camera.projection = OrthographicProjection{};
  scenes[2].view.camera.projection = SphericalProjection{SphericalProjection::Mapping::equal_area};
  scenes[3].view.camera.projection =
      SphericalProjection{SphericalProjection::Mapping::equirectangular};
  scenes[4].view.camera.projection = FisheyeProjection{FisheyeProjection::equidistant, 150};
  scenes[5].view.camera.projection = FisheyeProjection{FisheyeProjection::equisolid, 120};
  OpencvProjection distorted;
  distorted.fx = 260, distorted.fy = 250, distorted.cx = 140, distorted.cy = 110;
  distorted.k1 = -0.2, distorted.k2 = 0.05, distorted.p1 = 0.002, distorted.p2 = -0.003;
  scenes[6].view.camera.projection = distorted;
  scenes[7].view.camera.projection = OmnistereoProjection{-0.4};
  std::mt19937 random(5);
  for (Scene& scene : scenes) {
    scene.view.film.width = 300;
    scene.view.film.height = 200;
    for (int i = 0; i < 50; ++i) {
      const glm::dvec2 raster(std::uniform_real_distribution(0.0, 300.0)(random),
                              std::uniform_real_distribution(0.0, 200.0)(random));
      const CameraRay ray = unproject(scene.view.camera, scene.view.film, raster);
      EXPECT_NEAR(glm::length(ray.direction), 1, 1e-14);
      const RayRecord there = camera_ray(scene, raster, {0.5f, 0.5f});
      EXPECT_LT(glm::length(direction_of(there) - ray.direction), 2e-6);
      EXPECT_LT(glm::length(glm::dvec3(there.ox, there.oy, there.oz) - ray.origin), 2e-6);
      const auto back =
          project(scene.view.camera, scene.view.film, ray.origin + 7.0 * ray.direction);
      ASSERT_TRUE(back);
      EXPECT_LT(glm::length(*back - raster), 1e-6) << i;
    }
  }
  EXPECT_FALSE(project(scenes[0].view.camera, scenes[0].view.film, {0, 0, -1}));
  EXPECT_FALSE(project(scenes[2].view.camera, scenes[2].view.film, {0, 0, 0}));
  EXPECT_FALSE(project(scenes[7].view.camera, scenes[7].view.film, {0.2, 1, -0.3}));
}

// --- Other samplers ---

SamplerSettings sampler_of(SamplerSettings::Kind kind, int samples, int x = 4, int y = 4,
                           bool jitter = true) {
  SamplerSettings out;
  out.kind = kind;
  out.samples_per_pixel = samples;
  out.x_strata = x;
  out.y_strata = y;
  out.jitter = jitter;
  return out;
}

/// How many of the points lie in each of x times y equal parts of the square.
std::vector<int> counts_of(const std::vector<glm::dvec2>& points, int x, int y) {
  std::vector<int> counts(static_cast<std::size_t>(x * y));
  for (const glm::dvec2& p : points)
    ++counts[static_cast<std::size_t>(static_cast<int>(p.y * y) * x + static_cast<int>(p.x * x))];
  return counts;
}

TEST(Stratified, EachPartHasOneSampleInEachRound) {
  for (const auto& [x, y] : {std::pair{4, 4}, {5, 3}, {1, 7}, {1, 1}, {12, 8}}) {
    const int n = x * y;
    const Numbers all = numbers(300, 5, static_cast<std::uint32_t>(3 * n),
                                sampler_of(SamplerSettings::Kind::stratified, n, x, y));
    for (int round = 0; round < 3; ++round) {
      const auto begin = all.pairs.begin() + round * n;
      EXPECT_EQ(counts_of({begin, begin + n}, x, y),
                std::vector<int>(static_cast<std::size_t>(n), 1))
          << x << ' ' << y;
      std::set<int> parts;
      for (int i = round * n; i < (round + 1) * n; ++i)
        parts.insert(static_cast<int>(all.singles[static_cast<std::size_t>(i)] * n));
      EXPECT_EQ(parts.size(), static_cast<std::size_t>(n));
    }
  }
}

// The place within a part is uniform, and the order of the parts is another in each pixel and
// dimension.
TEST(Stratified, IsUniformWithinPartsAndInItsOrder) {
  constexpr int n = 6;
  const SamplerSettings settings = sampler_of(SamplerSettings::Kind::stratified, n, 3, 2);
  std::vector<int> firsts(n), inside(16);
  constexpr std::uint32_t pixels = 1200;
  for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
    const glm::dvec2 p = numbers(pixel, pixel % 5, 1, settings).pairs[0];
    ++firsts[static_cast<std::size_t>(3 * static_cast<int>(2 * p.y) + static_cast<int>(3 * p.x))];
    const glm::dvec2 q = glm::fract(p * glm::dvec2(3, 2));
    ++inside[static_cast<std::size_t>(4 * static_cast<int>(4 * q.y) + static_cast<int>(4 * q.x))];
  }
  // Each count is binomial.
  for (const auto& counts : {firsts, inside})
    for (const int count : counts) {
      const double p = 1.0 / static_cast<double>(counts.size());
      EXPECT_NEAR(count, pixels * p, 4 * std::sqrt(pixels * p * (1 - p)));
    }
}

TEST(Stratified, WithoutJitterSamplesLieInTheMiddles) {
  std::set<std::pair<double, double>> places;
  for (const glm::dvec2& p :
       numbers(9, 1, 6, sampler_of(SamplerSettings::Kind::stratified, 6, 3, 2, false)).pairs)
    places.emplace(std::round(p.x * 6e5) / 1e5, std::round(p.y * 4e5) / 1e5);
  EXPECT_EQ(places,
            (std::set<std::pair<double, double>>{{1, 1}, {3, 1}, {5, 1}, {1, 3}, {3, 3}, {5, 3}}));
}

// As pbrt-v4 divides another number of samples: the nearest to a square.
TEST(Stratified, OtherNumbersOfSamplesAreDivided) {
  EXPECT_EQ(strata_of(sampler_of(SamplerSettings::Kind::stratified, 16)), (std::array{4, 4}));
  EXPECT_EQ(strata_of(sampler_of(SamplerSettings::Kind::stratified, 12)), (std::array{3, 4}));
  EXPECT_EQ(strata_of(sampler_of(SamplerSettings::Kind::stratified, 7)), (std::array{1, 7}));
  EXPECT_EQ(strata_of(sampler_of(SamplerSettings::Kind::stratified, 15, 5, 3)), (std::array{5, 3}));
}

TEST(Independent, CountsAreThoseOfChance) {
  constexpr std::uint32_t n = 1u << 16;
  const Numbers all = numbers(40, 2, n, sampler_of(SamplerSettings::Kind::independent, 16));
  double chi_squared = 0;
  for (const int count : counts_of(all.pairs, 16, 16))
    chi_squared += std::pow(count - n / 256.0, 2) / (n / 256.0);
  // 255 degrees of freedom: mean 255, standard deviation sqrt(510). Stratified points would give
  // almost 0.
  EXPECT_NEAR(chi_squared, 255, 5 * std::sqrt(510.0));
  EXPECT_LT(std::abs(correlation(all.pairs, all.pairs, 0, 1)), 4 / std::sqrt(n));
}

// The samples of an aligned block of 2^k by 2^k pixels are a net together, as are those of one
// pixel.
TEST(Zsobol, BlocksOfPixelsAreNets) {
  for (const int samples : {1, 2, 4, 8}) {
    const SamplerSettings settings = sampler_of(SamplerSettings::Kind::zsobol, samples);
    for (const std::uint32_t size : {1u, 2u, 4u, 8u})
      for (const std::uint32_t corner : {0u, 16 * 256u + 8u}) {
        std::vector<glm::dvec2> points;
        for (std::uint32_t y = 0; y < size; ++y)
          for (std::uint32_t x = 0; x < size; ++x) {
            const Numbers of =
                numbers(corner + 256 * y + x, 3, static_cast<std::uint32_t>(samples), settings);
            points.insert(points.end(), of.pairs.begin(), of.pairs.end());
          }
        const int n = static_cast<int>(points.size());
        for (int x = 1; x <= n; x *= 2)
          EXPECT_EQ(counts_of(points, x, n / x), std::vector<int>(points.size(), 1))
              << samples << ' ' << size << ' ' << x;
      }
  }
}

// More samples than were asked for are other points.
TEST(Zsobol, GoesOnBeyondItsSamples) {
  const SamplerSettings settings = sampler_of(SamplerSettings::Kind::zsobol, 5);
  std::set<std::pair<double, double>> points;
  for (const glm::dvec2& p : numbers(70, 1, 64, settings).pairs) points.emplace(p.x, p.y);
  EXPECT_EQ(points.size(), 64u);
}

std::vector<PixelFilter> filters() {
  std::vector<PixelFilter> out;
  const auto add = [&](PixelFilter filter) {
    filter.radius_x = 2;
    filter.radius_y = 1.25;
    out.push_back(filter);
  };
  add({.kind = PixelFilter::Kind::box});
  add({.kind = PixelFilter::Kind::triangle});
  add({.kind = PixelFilter::Kind::gaussian});
  add({.kind = PixelFilter::Kind::gaussian,
       .sigma = 1.1});  // far from 0 at the radius: the shift matters
  add({.kind = PixelFilter::Kind::mitchell});
  add({.kind = PixelFilter::Kind::mitchell, .b = 0, .c = 1});
  add({.kind = PixelFilter::Kind::sinc});
  add({.kind = PixelFilter::Kind::sinc, .tau = 1.5});
  return out;
}

// The moments come from the filters' integrals in closed form (support/filters.h).
TEST(Filter, SamplesHaveTheMomentsOfTheFilter) {
  for (const PixelFilter& filter : filters()) {
    const bool negative =
        filter.kind == PixelFilter::Kind::mitchell || filter.kind == PixelFilter::Kind::sinc;
    const FilterSamples samples = filter_samples(filter, 400000);
    double of_both_axes = 1, heaviest_of_all = 0;
    for (int axis = 0; axis < 2; ++axis) {
      const double radius = axis == 0 ? filter.radius_x : filter.radius_y;
      double second = 0, magnitude = 0;
      constexpr int steps = 4000;
      for (int i = 0; i < steps; ++i) {
        const double begin = radius * (2.0 * i / steps - 1),
                     end = radius * (2.0 * (i + 1) / steps - 1), x = (begin + end) / 2;
        const double part = filter_share(filter, end, radius) - filter_share(filter, begin, radius);
        second += part * x * x;
        magnitude += std::abs(part);
      }
      double weight = 0, first = 0, square = 0, farthest = 0, heaviest = 0;
      const auto n = static_cast<double>(samples.offsets.size());
      for (std::size_t i = 0; i < samples.offsets.size(); ++i) {
        const double x = samples.offsets[i][axis];
        weight += samples.weights[i] / n;
        first += samples.weights[i] * x / n;
        square += samples.weights[i] * x * x / n;
        farthest = std::max(farthest, std::abs(x));
        heaviest = std::max(heaviest, std::abs(samples.weights[i]));
      }
      // Standard errors of bounded variables (offsets within the radius) from n samples; the table
      // is linear between 128 nodes: 1e-3 of the maximum.
      const double slack = 4 * heaviest * radius / std::sqrt(n) + 1e-3 * radius;
      EXPECT_NEAR(weight, 1, negative ? slack : 1e-6);
      EXPECT_NEAR(first, 0, slack);
      EXPECT_NEAR(square, second, slack * radius);
      EXPECT_LE(farthest, radius);
      of_both_axes *= magnitude;
      heaviest_of_all = heaviest;
    }
    // Both axes' integrals of |f| over those of f.
    EXPECT_NEAR(heaviest_of_all, of_both_axes, negative ? 2e-3 * heaviest_of_all : 1e-6);
  }
}

TEST(Filter, HistogramFollowsTheFilter) {
  constexpr std::size_t n = 400000, bins = 30;
  for (const PixelFilter& filter : filters()) {
    const FilterSamples samples = filter_samples(filter, n);
    for (int axis = 0; axis < 2; ++axis) {
      const double radius = axis == 0 ? filter.radius_x : filter.radius_y;
      std::vector<double> sums(bins, 0);
      double heaviest = 0;
      for (std::size_t i = 0; i < n; ++i) {
        const double at = (samples.offsets[i][axis] / radius + 1) / 2 * bins;
        sums[std::min(static_cast<std::size_t>(std::max(at, 0.0)), bins - 1)] += samples.weights[i];
        heaviest = std::max(heaviest, std::abs(samples.weights[i]));
      }
      for (std::size_t i = 0; i < bins; ++i) {
        const double begin = radius * (2.0 * static_cast<double>(i) / bins - 1),
                     end = begin + 2 * radius / bins;
        const double share =
            filter_share(filter, end, radius) - filter_share(filter, begin, radius);
        // The tolerance for samples that weigh w is five standard deviations of their number, and
        // the table's linear interpolation (1e-3 of the maximum, which is at most 3 / (2 radius)).
        // The other axis's signs make more of them where the filter is small.
        const double count = std::max(std::abs(share), 0.01) * n;
        EXPECT_NEAR(sums[i], share * n, 5 * heaviest * std::sqrt(count) + 3e-3 * n / bins)
            << static_cast<int>(filter.kind) << ' ' << axis << ' ' << i;
      }
    }
  }
}

TEST(Camera, FieldOfViewIsThatOfTheShorterSide) {
  Scene scene;
  scene.view.camera.projection = PerspectiveProjection{std::numbers::pi / 2};
  scene.view.film.width = 200;
  scene.view.film.height = 100;
  const RayRecord top = camera_ray(scene, {100, 0}, {0.5f, 0.5f});
  EXPECT_NEAR(top.dy, std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(top.dz, std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(top.dx, 0, 1e-6);
  const RayRecord right = camera_ray(scene, {200, 50}, {0.5f, 0.5f});
  EXPECT_NEAR(right.dx / right.dz, 2, 1e-5);
  EXPECT_EQ(right.t_min, 0);
  EXPECT_TRUE(std::isinf(right.t_max));
  scene.view.film.width = 50;
  const RayRecord tall = camera_ray(scene, {50, 0}, {0.5f, 0.5f});
  EXPECT_NEAR(tall.dx / tall.dz, 1, 1e-5);
  EXPECT_NEAR(tall.dy / tall.dz, 2, 1e-5);
}

// pbrt-v4's perspective camera: the screen is [-aspect, aspect] x [-1, 1], or for aspects below 1
// [-1, 1] x [-1/aspect, 1/aspect], times tan(fov / 2); the aspect is the film's unless the file
// gives one.
TEST(Camera, FrameAspectRatioStretchesTheScreen) {
  Scene scene;
  scene.view.camera.projection = PerspectiveProjection{2 * std::atan(0.5)};
  scene.view.film.width = scene.view.film.height = 60;
  for (const double aspect : {1.0, 2.5, 0.4}) {
    scene.view.camera.frame_aspect_ratio = aspect;
    const RayRecord corner = camera_ray(scene, {0, 0}, {0.5f, 0.5f});
    EXPECT_NEAR(corner.dx / corner.dz, -0.5 * std::max(aspect, 1.0), 1e-5) << aspect;
    EXPECT_NEAR(corner.dy / corner.dz, 0.5 * std::max(1 / aspect, 1.0), 1e-5) << aspect;
  }
}

TEST(Camera, ScreenWindowAndCropAreThoseOfTheFile) {
  Scene scene;
  scene.view.film.width = 40;
  scene.view.film.height = 20;
  scene.view.film.crop = std::array<int, 4>{10, 30, 5, 20};
  scene.view.camera.screen_window = std::array<double, 4>{-1, 3, -0.5, 1};
  FlatView flat;
  lower_camera(scene, flat);
  EXPECT_EQ(flat.view.crop_x, 10u);
  EXPECT_EQ(flat.view.crop_y, 5u);
  EXPECT_EQ(flat.view.crop_width, 20u);
  EXPECT_EQ(flat.view.crop_height, 15u);
  const RayRecord corner = camera_ray(scene, {40, 20}, {0.5f, 0.5f});
  EXPECT_NEAR(corner.dx / corner.dz, 3, 1e-5);
  EXPECT_NEAR(corner.dy / corner.dz, -0.5, 1e-5);
}

TEST(Camera, RaysOfTheLensMeetInTheFocalPlane) {
  Scene scene;
  scene.view.camera.lens_radius = 0.5;
  scene.view.camera.focal_distance = 4;
  scene.view.camera.world_from_camera[3] = glm::dvec4(1, 2, 3, 1);
  const auto at_focus = [&](glm::vec2 lens) {
    const RayRecord r = camera_ray(scene, {300, 200}, lens);
    EXPECT_LE(std::hypot(r.ox - 1, r.oy - 2), 0.5 + 1e-6);
    EXPECT_NEAR(std::sqrt(r.dx * r.dx + r.dy * r.dy + r.dz * r.dz), 1, 1e-6);
    const double t = 4 / r.dz;
    return glm::dvec3(r.ox + t * r.dx, r.oy + t * r.dy, r.oz + t * r.dz);
  };
  const glm::dvec3 center = at_focus({0.5f, 0.5f});
  for (const glm::vec2 lens : {glm::vec2(0, 0), glm::vec2(0.9f, 0.3f), glm::vec2(0.2f, 0.99f)})
    EXPECT_LT(glm::length(at_focus(lens) - center), 1e-5);
}

}  // namespace caplet::test::sampling_test
