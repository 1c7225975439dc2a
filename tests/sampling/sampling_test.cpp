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
#include <glm/vec2.hpp>
#include <limits>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include "device/device.h"
#include "lower/camera.h"
#include "lower/detail/filter.h"
#include "support/filters.h"
#include "support/test_device.h"

namespace caplet::test {

namespace {

const char* const kernel_text = R"(
#include "math/camera.cl"
#include "math/exact.cl"
#include "math/filter.cl"
#include "math/rng.cl"

__kernel void numbers(uint seed, uint pair, __global float* out, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  vstore2(sampler_2d(seed, i, pair), i, out);
  out[2 * count + i] = sampler_1d(seed, i, pair);
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
__kernel void rays(__global const CameraRecord* camera, __global const float* in, __global RayRecord* out, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i < count) out[i] = camera_ray(camera, vload2(2 * i, in), vload2(2 * i + 1, in));
}
// The same values, and their negatives, added to sums of one word, two words and three.
__kernel void sums(__global const float* values, uint count, int unit, __global ulong* out) {
  ulong4 one[1] = {(ulong4)(0)}, two[2] = {(ulong4)(0), (ulong4)(0)}, three[3] = {(ulong4)(0), (ulong4)(0), (ulong4)(0)};
  for (uint i = 0; i < count; ++i) {
    const float4 v = (float4)(values[i], -values[i], 0.0f, values[i]);
    exact_add(one, 1, v, unit);
    exact_add(two, 2, v, unit);
    exact_add(three, 3, v, unit);
  }
  const ulong4 all[6] = {one[0], two[0], two[1], three[0], three[1], three[2]};
  for (int w = 0; w < 6; ++w) vstore4(all[w], w, out);
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
Numbers numbers(std::uint32_t seed, std::uint32_t pair, std::uint32_t count) {
  Buffer<float> out(bench().device, 3 * count);
  cl::Kernel kernel = bench().program.kernel("numbers");
  kernel.setArg(0, seed);
  kernel.setArg(1, pair);
  kernel.setArg(2, out.handle());
  kernel.setArg(3, count);
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

double correlation(const std::vector<glm::dvec2>& a, const std::vector<glm::dvec2>& b, int i, int j) {
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

RayRecord camera_ray(const Scene& scene, glm::vec2 raster, glm::vec2 lens) {
  FlatView flat;
  lower_camera(scene, flat);
  const std::vector<CameraRecord> record = {flat.camera};
  const std::vector<float> in = {raster.x, raster.y, lens.x, lens.y};
  const Buffer<CameraRecord> camera(bench().device, std::span<const CameraRecord>(record));
  const Buffer<float> input(bench().device, std::span<const float>(in));
  Buffer<RayRecord> out(bench().device, 1);
  cl::Kernel kernel = bench().program.kernel("rays");
  kernel.setArg(0, camera.handle());
  kernel.setArg(1, input.handle());
  kernel.setArg(2, out.handle());
  kernel.setArg(3, cl_uint{1});
  launch(bench().device, kernel, 1, 1);
  return out.read()[0];
}

}  // namespace

TEST(Sampler, EveryPowerOfTwoPrefixIsANet) {
  for (std::uint32_t seed : {0u, 1u, 0xdeadbeefu}) {
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
      for (int i = 0; i < 1 << m; ++i) strata.insert(static_cast<int>(all.singles[static_cast<std::size_t>(i)] * (1 << m)));
      EXPECT_EQ(strata.size(), std::size_t{1} << m);
    }
  }
}

TEST(Sampler, NumbersAreInTheHalfOpenUnitInterval) {
  const Numbers all = numbers(5, 3, 1u << 20);
  for (std::size_t i = 0; i < all.pairs.size(); ++i) {
    const bool inside = all.pairs[i].x >= 0 && all.pairs[i].x < 1 && all.pairs[i].y >= 0 && all.pairs[i].y < 1 &&
                        all.singles[i] >= 0 && all.singles[i] < 1;
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
  for (const std::uint32_t seed : hashed("seeds", 4)) sets.push_back(numbers(seed, 0, n).pairs);
  for (std::size_t a = 0; a < sets.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
          EXPECT_LT(std::abs(correlation(sets[a], sets[b], i, j)), 4 / std::sqrt(n)) << a << ' ' << b << ' ' << i << ' ' << j;
}

TEST(Sampler, FirstSamplesOfPixelsAreUniform) {
  // Across pixels the first sample is a hash: mean 1/2 with standard error 1 / sqrt(12 n), and no correlation of the coordinates.
  const std::vector<std::uint32_t> seeds = hashed("seeds", 512);
  EXPECT_EQ(std::set<std::uint32_t>(seeds.begin(), seeds.end()).size(), seeds.size());
  std::vector<glm::dvec2> firsts;
  glm::dvec2 mean(0);
  for (const std::uint32_t seed : seeds) {
    firsts.push_back(numbers(seed, 1, 1).pairs[0]);
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
  add({.kind = PixelFilter::Kind::gaussian, .sigma = 1.1});  // far from 0 at the radius: the shift matters
  add({.kind = PixelFilter::Kind::mitchell});
  add({.kind = PixelFilter::Kind::mitchell, .b = 0, .c = 1});
  add({.kind = PixelFilter::Kind::sinc});
  add({.kind = PixelFilter::Kind::sinc, .tau = 1.5});
  return out;
}

// The moments come from the filters' integrals in closed form (support/filters.h).
TEST(Filter, SamplesHaveTheMomentsOfTheFilter) {
  for (const PixelFilter& filter : filters()) {
    const bool negative = filter.kind == PixelFilter::Kind::mitchell || filter.kind == PixelFilter::Kind::sinc;
    const FilterSamples samples = filter_samples(filter, 400000);
    double of_both_axes = 1, heaviest_of_all = 0;
    for (int axis = 0; axis < 2; ++axis) {
      const double radius = axis == 0 ? filter.radius_x : filter.radius_y;
      double second = 0, magnitude = 0;
      constexpr int steps = 4000;
      for (int i = 0; i < steps; ++i) {
        const double begin = radius * (2.0 * i / steps - 1), end = radius * (2.0 * (i + 1) / steps - 1), x = (begin + end) / 2;
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
      // Standard errors of bounded variables (offsets within the radius) from n samples; the table is linear between 128 nodes:
      // 1e-3 of the maximum.
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
        const double begin = radius * (2.0 * static_cast<double>(i) / bins - 1), end = begin + 2 * radius / bins;
        const double share = filter_share(filter, end, radius) - filter_share(filter, begin, radius);
        // Of samples that weigh w: five standard deviations of their number, and the table's linear interpolation (1e-3 of the
        // maximum, which is at most 3 / (2 radius)). The other axis's signs make more of them where the filter is small.
        const double count = std::max(std::abs(share), 0.01) * n;
        EXPECT_NEAR(sums[i], share * n, 5 * heaviest * std::sqrt(count) + 3e-3 * n / bins)
            << static_cast<int>(filter.kind) << ' ' << axis << ' ' << i;
      }
    }
  }
}

TEST(Camera, FieldOfViewIsThatOfTheShorterSide) {
  Scene scene;
  scene.camera.fov = std::numbers::pi / 2;
  scene.film.width = 200;
  scene.film.height = 100;
  const RayRecord top = camera_ray(scene, {100, 0}, {0.5f, 0.5f});
  EXPECT_NEAR(top.dy, std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(top.dz, std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(top.dx, 0, 1e-6);
  const RayRecord right = camera_ray(scene, {200, 50}, {0.5f, 0.5f});
  EXPECT_NEAR(right.dx / right.dz, 2, 1e-5);
  EXPECT_EQ(right.t_min, 0);
  EXPECT_TRUE(std::isinf(right.t_max));
  scene.film.width = 50;
  const RayRecord tall = camera_ray(scene, {50, 0}, {0.5f, 0.5f});
  EXPECT_NEAR(tall.dx / tall.dz, 1, 1e-5);
  EXPECT_NEAR(tall.dy / tall.dz, 2, 1e-5);
}

// pbrt-v4's perspective camera: the screen is [-aspect, aspect] x [-1, 1], or for aspects below 1 [-1, 1] x [-1/aspect,
// 1/aspect], times tan(fov / 2); the aspect is the film's unless the file gives one.
TEST(Camera, FrameAspectRatioStretchesTheScreen) {
  Scene scene;
  scene.camera.fov = 2 * std::atan(0.5);
  scene.film.width = scene.film.height = 60;
  for (const double aspect : {1.0, 2.5, 0.4}) {
    scene.camera.frame_aspect_ratio = aspect;
    const RayRecord corner = camera_ray(scene, {0, 0}, {0.5f, 0.5f});
    EXPECT_NEAR(corner.dx / corner.dz, -0.5 * std::max(aspect, 1.0), 1e-5) << aspect;
    EXPECT_NEAR(corner.dy / corner.dz, 0.5 * std::max(1 / aspect, 1.0), 1e-5) << aspect;
  }
}

TEST(Camera, ScreenWindowAndCropAreThoseOfTheFile) {
  Scene scene;
  scene.film.width = 40;
  scene.film.height = 20;
  scene.film.crop = std::array<int, 4>{10, 30, 5, 20};
  scene.camera.screen_window = std::array<double, 4>{-1, 3, -0.5, 1};
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
  scene.camera.lens_radius = 0.5;
  scene.camera.focal_distance = 4;
  scene.camera.world_from_camera[3] = glm::dvec4(1, 2, 3, 1);
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

/// The words of a sum in two's complement.
__extension__ typedef __int128 Whole;
std::vector<std::uint64_t> words_of(Whole sum, std::size_t words) {
  std::vector<std::uint64_t> out;
  for (std::size_t w = 0; w < words; ++w) out.push_back(static_cast<std::uint64_t>(sum >> std::min<std::size_t>(64 * w, 127)));
  return out;
}

/// By component: of the values, of their negatives, of zeros, of the values.
std::array<std::vector<std::uint64_t>, 4> device_sums(const std::vector<float>& values, int unit) {
  const Buffer<float> in(bench().device, std::span<const float>(values));
  Buffer<std::uint64_t> out(bench().device, std::size_t{24});
  cl::Kernel kernel = bench().program.kernel("sums");
  set_arguments(bench().device, kernel, in, static_cast<cl_uint>(values.size()), cl_int{unit}, out);
  launch(bench().device, kernel, 1, 1);
  const std::vector<std::uint64_t> all = out.read();
  std::array<std::vector<std::uint64_t>, 4> sums;
  for (std::size_t i = 0; i < all.size(); ++i) sums[i % 4].push_back(all[i]);
  return sums;
}

/// Those of one word, two words and three that are all `sum`.
std::vector<std::uint64_t> expected_sums(Whole sum) {
  std::vector<std::uint64_t> out;
  for (const std::size_t words : {1u, 2u, 3u})
    for (const std::uint64_t word : words_of(sum, words)) out.push_back(word);
  return out;
}

TEST(Film, SumsAreExactInAnyOrder) {
  std::mt19937 engine(5);
  // Units from those that most values are below to those that all are many of; the sums stay below 2^63 units.
  for (const int unit : {-30, -20, -3, 0, 7}) {
    std::vector<float> values;
    Whole exact = 0;
    for (int i = 0; i < 5000; ++i) {
      const int exponent = static_cast<int>(engine() % 40) - 20;
      const auto value =
          static_cast<float>(std::ldexp(static_cast<double>(engine() >> 8), exponent - 24)) * (i % 3 == 0 ? -1 : 1);
      if (std::abs(double{value}) * std::ldexp(1.0, -unit) > 0x1p37) continue;
      values.push_back(value);
      exact += static_cast<Whole>(std::trunc(std::ldexp(double{value}, -unit)));
    }
    values.insert(values.end(), {0.0f, -0.0f, 1e-45f, -1e-45f});
    const std::array expected{expected_sums(exact), expected_sums(-exact), expected_sums(0), expected_sums(exact)};
    EXPECT_EQ(device_sums(values, unit), expected) << unit;
    std::ranges::shuffle(values, engine);
    EXPECT_EQ(device_sums(values, unit), expected) << unit;
  }
}

TEST(Film, WhatIsTooLargeCountsAsTheLargest) {
  // 2^24 - 1 times 2^(64 words - 50) units, however much it is.
  const float inf = std::numeric_limits<float>::infinity();
  for (const float large : {3e38f, inf}) {
    const auto [sums, negative, zeros, again] = device_sums({large, large}, -20);
    const Whole one = Whole{0x1fffffe} << 14, two = Whole{0x1fffffe} << 78;
    EXPECT_EQ(sums[0], static_cast<std::uint64_t>(one));
    EXPECT_EQ(negative[0], static_cast<std::uint64_t>(-one));
    EXPECT_EQ(std::vector(sums.begin() + 1, sums.begin() + 3), words_of(two, 2));
    if (large == inf) {
      EXPECT_EQ(sums[5], std::uint64_t{0x1fffffe} << 14);
    }
  }
}

}  // namespace caplet::test
