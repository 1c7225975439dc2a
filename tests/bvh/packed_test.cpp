// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Nodes in bytes: the boxes that kernels make of them hold the exact ones, with the room that the
// slab test needs, and are little larger.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "lower/packed_nodes.h"

namespace caplet {
namespace {

constexpr std::uint32_t no_child = 0x7fffffffu;
constexpr float inf = std::numeric_limits<float>::infinity(),
                largest = std::numeric_limits<float>::max();

struct Node {
  std::array<float, CAPLET_NODE_FLOATS> floats{};

  Node() {
    for (std::uint32_t i = 0; i < 8; ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) set(i, k, inf, -inf);
      set_child(i, no_child);
    }
  }
  void set(std::uint32_t i, std::uint32_t k, float low, float high) {
    floats[8 * k + i] = low;
    floats[24 + 8 * k + i] = high;
  }
  void set_child(std::uint32_t i, std::uint32_t reference) {
    floats[48 + i] = std::bit_cast<float>(reference);
  }
  bool has(std::uint32_t i) const {
    return std::bit_cast<std::uint32_t>(floats[48 + i]) != no_child;
  }
};

/// As kernels/trace/packed.cl says, in double.
struct Axis {
  double origin, step;
  bool looked_at;
  std::uint32_t low[8], high[8];
};
Axis axis_of(const std::vector<float>& packed, std::uint32_t k) {
  const auto word = [&](std::uint32_t i) { return std::bit_cast<std::uint32_t>(packed[i]); };
  const std::uint32_t exponent = word(3) >> (8 * k) & 255;
  Axis axis{double(packed[k]), std::ldexp(1.0, int(exponent) - 127), exponent != 255, {}, {}};
  for (std::uint32_t i = 0; i < 8; ++i) {
    axis.low[i] = word(4 + 2 * k + i / 4) >> (8 * (i % 4)) & 255;
    axis.high[i] = word(10 + 2 * k + i / 4) >> (8 * (i % 4)) & 255;
  }
  return axis;
}

/// The distance from |x| to the next float.
double last_place(double x) {
  return std::ldexp(1.0, std::max(std::ilogb(std::max(std::abs(x), 0x1p-126)), -126) - 23);
}

void check(const Node& node) {
  const std::vector<float> packed = packed_nodes(node.floats);
  ASSERT_EQ(packed.size(), std::size_t{24});
  for (std::uint32_t i = 0; i < 8; ++i) {
    EXPECT_EQ(std::bit_cast<std::uint32_t>(packed[3]) >> (24 + i) & 1, node.has(i) ? 1u : 0u);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(packed[16 + i]),
              std::bit_cast<std::uint32_t>(node.floats[48 + i]));
  }
  for (std::uint32_t k = 0; k < 3; ++k) {
    const Axis axis = axis_of(packed, k);
    double least = double(inf), greatest = -double(inf);
    for (std::uint32_t i = 0; i < 8; ++i)
      if (node.has(i)) {
        least = std::min(least, double(node.floats[8 * k + i]));
        greatest = std::max(greatest, double(node.floats[24 + 8 * k + i]));
      }
    if (least > greatest) continue;
    const bool near = least >= -0x1p126 && greatest <= 0x1p126;
    ASSERT_EQ(axis.looked_at, near);
    if (!near) {
      // Infinite steps, none of them: not a number, which the slab test passes over.
      for (std::uint32_t i = 0; i < 8; ++i) EXPECT_EQ(axis.low[i] + axis.high[i], 0u);
      continue;
    }
    const double reach = std::max(std::abs(least), std::abs(greatest));
    EXPECT_LE(axis.step, std::max({(greatest - least) / 120, 4 * last_place(reach), 0x1p-99}))
        << least << " to " << greatest;
    EXPECT_GE(axis.step, 0x1p-100);
    EXPECT_LE(axis.step, 0x1p121);
    for (std::uint32_t i = 0; i < 8; ++i) {
      if (!node.has(i)) continue;
      const double low = double(node.floats[8 * k + i]), high = double(node.floats[24 + 8 * k + i]);
      // 4 eps q s of the test's own rounding (kernels/trace/packed.cl). long double: nothing is
      // lost in the comparison.
      const auto plane = [&](std::uint32_t q) {
        return (long double)(axis.origin) + (long double)(q) * (long double)(axis.step);
      };
      const auto rounding = [&](std::uint32_t q) {
        return 0x1p-22L * (long double)(q) * (long double)(axis.step);
      };
      EXPECT_LE(plane(axis.low[i]) + rounding(axis.low[i]), (long double)(low))
          << "child " << i << " axis " << k;
      EXPECT_GE(plane(axis.high[i]) - rounding(axis.high[i]), (long double)(high))
          << "child " << i << " axis " << k;
      EXPECT_LE((long double)(low)-plane(axis.low[i]), 2.5L * (long double)(axis.step));
      EXPECT_LE(plane(axis.high[i]) - (long double)(high), 2.5L * (long double)(axis.step));
    }
  }
}

class Packed : public testing::Test {
 protected:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  std::mt19937 engine_{17};
};

TEST_F(Packed, BoxesHoldTheExactOnesAtAllScales) {
  for (int exponent = -149; exponent <= 127; ++exponent)
    for (int n = 0; n < 40; ++n) {
      Node node;
      const double scale = std::ldexp(1.0, exponent),
                   place = n % 4 == 0 ? 0 : std::ldexp(scale, n % 30);
      const std::uint32_t children = n % 5 == 0 ? 1u << (n % 8) : std::uint32_t(engine_()) | 1u;
      for (std::uint32_t i = 0; i < 8; ++i) {
        if ((children >> i & 1) == 0) continue;
        node.set_child(i, std::uint32_t(engine_()) & 0xfffffffeu);
        for (std::uint32_t k = 0; k < 3; ++k) {
          const auto clamped = [](double x) {
            return static_cast<float>(std::clamp(x, -double(largest), double(largest)));
          };
          const float a = clamped((k == 1 ? -place : place) + scale * uniform(-1, 1));
          const float b =
              n % 3 == 0 ? a
                         : clamped(double(a) + scale * uniform(-1, 1) * std::ldexp(1.0, -(n % 12)));
          node.set(i, k, std::min(a, b), std::max(a, b));
        }
      }
      check(node);
    }
}

TEST_F(Packed, BoxesThatAreOdd) {
  const float odd[] = {
      0.0f,    -0.0f,   0x1p-149f, -0x1p-149f, 0x1p-126f, 1.0f,     std::nextafter(1.0f, 2.0f),
      -1.0f,   0x1p24f, -0x1p24f,  0x1p126f,   -0x1p126f, 0x1p127f, largest,
      -largest};
  for (const float a : odd)
    for (const float b : odd)
      for (const float c : odd) {
        Node node;
        for (std::uint32_t i = 0; i < 3; ++i) node.set_child(i, i + 1);
        const float all[] = {a, b, c};
        for (std::uint32_t k = 0; k < 3; ++k)
          for (std::uint32_t i = 0; i < 3; ++i) {
            const float x = all[i], y = all[(i + k) % 3];
            node.set(i, k, std::min(x, y), std::max(x, y));
          }
        check(node);
      }
}

TEST_F(Packed, NodesByTheirNumber) {
  std::vector<float> nodes;
  for (std::uint32_t n = 0; n < 100; ++n) {
    Node node;
    node.set_child(n % 8, 1000 + n);
    for (std::uint32_t k = 0; k < 3; ++k) node.set(n % 8, k, float(n), float(n + k));
    nodes.insert(nodes.end(), node.floats.begin(), node.floats.end());
  }
  const std::vector<float> packed = packed_nodes(nodes);
  ASSERT_EQ(packed.size(), std::size_t{2400});
  for (std::uint32_t n = 0; n < 100; ++n)
    EXPECT_EQ(std::bit_cast<std::uint32_t>(packed[24 * n + 16 + n % 8]), 1000 + n);
}

}  // namespace
}  // namespace caplet
