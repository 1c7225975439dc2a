// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/packed_nodes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/check.h"
#include "lower/detail/floats.h"

namespace caplet {

namespace {

constexpr double slack = 0x1p-13;  // of a step
constexpr int least_exponent =
    -100;  // of a step: what is lost where subnormal numbers are zeros is little of it
constexpr float farthest = 0x1p126f;  // of coordinates that kernels compute with
constexpr std::uint32_t not_looked_at = 255;

/// PackedAxis is one axis of eight boxes.
struct PackedAxis {
  float origin = 0;
  std::uint32_t exponent = not_looked_at;  // as floats have it
  std::array<std::uint8_t, CAPLET_WIDTH> low{}, high{};
};

/// Returns false if they do not fit into bytes of steps of this size.
bool quantise(const float* low, const float* high, std::uint32_t children, int exponent,
              PackedAxis& out) {
  const double step = std::ldexp(1.0, exponent);
  float least = inf;
  for (std::uint32_t i = 0; i < CAPLET_WIDTH; ++i)
    if (children >> i & 1) least = std::min(least, low[i]);
  out.origin = static_cast<float>(double(least) - 2 * slack * step);
  if (double(out.origin) > double(least) - 2 * slack * step)
    out.origin = std::nextafter(out.origin, -inf);
  out.exponent = static_cast<std::uint32_t>(exponent + 127);
  for (std::uint32_t i = 0; i < CAPLET_WIDTH; ++i) {
    out.low[i] = out.high[i] = 0;
    if ((children >> i & 1) == 0) continue;
    // Both are in double to 2^-44 of a step, for which the slack has room.
    const double from = std::floor((double(low[i]) - double(out.origin)) / step - slack);
    const double to = std::ceil((double(high[i]) - double(out.origin)) / step + slack);
    if (!(from >= 0 && to <= 255)) return false;
    out.low[i] = static_cast<std::uint8_t>(from);
    out.high[i] = static_cast<std::uint8_t>(to);
  }
  return true;
}

PackedAxis pack_axis(const float* low, const float* high, std::uint32_t children) {
  float least = inf, greatest = -inf;
  for (std::uint32_t i = 0; i < CAPLET_WIDTH; ++i)
    if (children >> i & 1) {
      least = std::min(least, low[i]);
      greatest = std::max(greatest, high[i]);
    }
  PackedAxis out;
  if (children == 0) return out;
  if (!(least >= -farthest && greatest <= farthest)) return out;
  const auto exponent_of = [](double x) { return x > 0 ? std::ilogb(x) : least_exponent; };
  const int last_place =
      exponent_of(std::max(std::abs(double(least)), std::abs(double(greatest)))) - 23;
  int exponent =
      std::max({exponent_of((double(greatest) - double(least)) / 255), last_place, least_exponent});
  while (!quantise(low, high, children, exponent, out)) ++exponent;
  return out;
}

}  // namespace

void pack_node(std::span<const float, CAPLET_NODE_FLOATS> node,
               std::span<float, CAPLET_PACKED_NODE_FLOATS> packed) {
  std::uint32_t children = 0;
  for (std::uint32_t i = 0; i < CAPLET_WIDTH; ++i)
    if (std::bit_cast<std::uint32_t>(node[CAPLET_NODE_CHILDREN + i]) != no_child)
      children |= 1u << i;
  std::array<std::uint32_t, CAPLET_PACKED_NODE_FLOATS> words{};
  words[3] = children << 24;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const PackedAxis axis = pack_axis(&node[8 * k], &node[24 + 8 * k], children);
    words[k] = std::bit_cast<std::uint32_t>(axis.origin);
    words[3] |= axis.exponent << (8 * k);
    for (std::uint32_t i = 0; i < CAPLET_WIDTH; ++i) {
      words[4 + 2 * k + i / 4] |= std::uint32_t{axis.low[i]} << (8 * (i % 4));
      words[10 + 2 * k + i / 4] |= std::uint32_t{axis.high[i]} << (8 * (i % 4));
    }
  }
  for (std::uint32_t i = 0; i < CAPLET_WIDTH; ++i)
    words[16 + i] = std::bit_cast<std::uint32_t>(node[CAPLET_NODE_CHILDREN + i]);
  std::ranges::transform(words, packed.begin(),
                         [](std::uint32_t word) { return std::bit_cast<float>(word); });
}

std::vector<float> packed_nodes(std::span<const float> nodes) {
  CHECK_EQ_(nodes.size() % CAPLET_NODE_FLOATS, std::size_t{0});
  const std::size_t count = nodes.size() / CAPLET_NODE_FLOATS;
  std::vector<float> out(count * CAPLET_PACKED_NODE_FLOATS);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    pack_node(
        nodes.subspan(i * CAPLET_NODE_FLOATS).first<CAPLET_NODE_FLOATS>(),
        std::span(out).subspan(i * CAPLET_PACKED_NODE_FLOATS).first<CAPLET_PACKED_NODE_FLOATS>());
  });
  return out;
}

}  // namespace caplet
