// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The exact sums of a film, as the device adds them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "device/device.h"
#include "support/test_device.h"

namespace caplet::test {

namespace {

const char* const kernel_text = R"(
#include "math/exact.cl"

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

/// The words of a sum in two's complement.
__extension__ typedef __int128 Whole;
std::vector<std::uint64_t> words_of(Whole sum, std::size_t words) {
  std::vector<std::uint64_t> out;
  for (std::size_t w = 0; w < words; ++w)
    out.push_back(static_cast<std::uint64_t>(sum >> std::min<std::size_t>(64 * w, 127)));
  return out;
}

/// By component: of the values, of their negatives, of zeros, of the values.
std::array<std::vector<std::uint64_t>, 4> device_sums(const std::vector<float>& values, int unit) {
  static const Device device = test_device();
  static const Program program =
      Program::from_source(device, "film_sums_test", flatten_kernels(kernel_text), "");
  const Buffer<float> in(device, std::span<const float>(values));
  Buffer<std::uint64_t> out(device, std::size_t{24});
  cl::Kernel kernel = program.kernel("sums");
  set_arguments(device, kernel, in, static_cast<cl_uint>(values.size()), cl_int{unit}, out);
  launch(device, kernel, 1, 1);
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

}  // namespace

TEST(Film, SumsAreExactInAnyOrder) {
  std::mt19937 engine(5);
  // Units from those that most values are below to those that all are many of; the sums stay below
  // 2^63 units.
  for (const int unit : {-30, -20, -3, 0, 7}) {
    std::vector<float> values;
    Whole exact = 0;
    for (int i = 0; i < 5000; ++i) {
      const int exponent = static_cast<int>(engine() % 40) - 20;
      const auto value =
          static_cast<float>(std::ldexp(static_cast<double>(engine() >> 8), exponent - 24)) *
          (i % 3 == 0 ? -1 : 1);
      if (std::abs(double{value}) * std::ldexp(1.0, -unit) > 0x1p37) continue;
      values.push_back(value);
      exact += static_cast<Whole>(std::trunc(std::ldexp(double{value}, -unit)));
    }
    values.insert(values.end(), {0.0f, -0.0f, 1e-45f, -1e-45f});
    const std::array expected{expected_sums(exact), expected_sums(-exact), expected_sums(0),
                              expected_sums(exact)};
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
