// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The traversal's stack against the deepest trees that the host may hand it: 2 x
// CAPLET_TREE_DEPTH_MAX nodes, all eight children of each met by the ray, the one that leads on
// first.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "device/device.h"
#include "lower/packed_nodes.h"
#include "shared/kinds.h"
#include "shared/records.h"
#include "support/test_device.h"

namespace caplet::test::nodes_test {
namespace {

constexpr std::size_t spare = 16;  // entries beyond the stack, to see whether they are written to
constexpr float inf = std::numeric_limits<float>::infinity();

const char* const kernel = R"(
#include "trace/trace.cl"
__attribute__((vec_type_hint(float8))) __kernel void meet(__global const float* nodes, __global const RayRecord* rays, uint count, __global uint* out) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  const RayRecord r = rays[i];
#if CAPLET_REAL_WIDTH == 8
  const SlabRay slab = slab_ray((float3)(r.ox, r.oy, r.oz), (float3)(r.dx, r.dy, r.dz));
  float enter[8];
  out[i] = node_hits(nodes + (size_t)i * CAPLET_NODE_FLOATS, &slab, r.t_min, MAXFLOAT, enter);
#else
  const BoxRay box = box_ray((float3)(r.ox, r.oy, r.oz), (float3)(r.dx, r.dy, r.dz));
  const uint bits = packed_node_hits(nodes, i, &box, r.ox, r.oy, r.oz, r.t_min, MAXFLOAT);
  out[i] = 0;
  for (uint child = 0; child < CAPLET_WIDTH; ++child) out[i] |= (bits >> (child ^ box.octant) & 1u) << child;
#endif
}
#if CAPLET_REAL_WIDTH == 8
__attribute__((vec_type_hint(float8))) __kernel void descend(__global const float* nodes, uint depth, uint spare, __global uint* out) {
  ulong stack[CAPLET_STACK_SIZE + 16];
  for (int i = 0; i < CAPLET_STACK_SIZE + 16; ++i) stack[i] = ~0ul;
  const SlabRay slab = slab_ray((float3)(0.0f, 0.0f, 0.0f), (float3)(1.0f, 0.0f, 0.0f));
  int top = 0;
  for (int tree = 0; tree < 2; ++tree) {
    int next = 0;
    for (uint level = 0; level < depth; ++level)
      if (!visit_node(nodes + (uint)next * CAPLET_NODE_FLOATS, &slab, 0.0f, MAXFLOAT, stack, &top, &next)) out[2] += 1;
  }
  out[0] = (uint)top;
  for (uint i = 0; i < spare; ++i)
    if (stack[CAPLET_STACK_SIZE + i] != ~0ul) out[1] += 1;
}
#endif
)";

/// The deepest tree that the host may hand over, all eight children of each node met by the ray,
/// the one that leads on first. A chain: child 7 is the next node, from x = 1; the others are
/// leaves, from x = 2.
std::vector<float> deepest_tree() {
  std::vector<float> nodes(std::size_t(CAPLET_TREE_DEPTH_MAX) * CAPLET_NODE_FLOATS);
  for (std::size_t level = 0; level < CAPLET_TREE_DEPTH_MAX; ++level)
    for (std::size_t i = 0; i < CAPLET_WIDTH; ++i) {
      float* node = &nodes[level * CAPLET_NODE_FLOATS];
      const bool leads_on = i == CAPLET_WIDTH - 1;
      const float low[3] = {leads_on ? 1.0f : 2.0f, -1, -1}, high[3] = {3, 1, 1};
      for (std::size_t k = 0; k < 3; ++k) {
        node[8 * k + i] = low[k];
        node[24 + 8 * k + i] = high[k];
      }
      node[48 + i] = std::bit_cast<float>(leads_on && level + 1 < CAPLET_TREE_DEPTH_MAX
                                              ? static_cast<std::uint32_t>(level + 1)
                                              : 0x80000000u | std::uint32_t(i));
    }
  return nodes;
}

// A point of a ray, in double; around it eight boxes of no or little extent that it only just
// touches, moved out by what a shape's own error, 16 eps of the origin's distance, may ask of them.
TEST(Slabs, BoxesThatARayMeetsAreMet) {
  const Device& device = test_device();
  constexpr std::uint32_t count = 20000;
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<float> nodes(count * std::size_t(CAPLET_NODE_FLOATS));
  std::vector<RayRecord> rays;
  for (std::uint32_t i = 0; i < count; ++i) {
    // Far away, and (for what is rounded at the box) next to the world's origin.
    const double far = std::exp2(10 * u(engine) + (i % 3 == 0 ? -30 : 5));
    const float o[3] = {float(far * u(engine)), float(far * u(engine)), float(far * u(engine))};
    float d[3];
    for (std::size_t k = 0; k < 3; ++k) d[k] = static_cast<float>(u(engine) - double(o[k]));
    if (i % 5 == 0) d[i % 3] *= 1e-6f;
    rays.push_back({o[0], o[1], o[2], 0, d[0], d[1], d[2], inf});
    const double reach = std::max({std::abs(o[0]), std::abs(o[1]), std::abs(o[2])});
    for (std::size_t child = 0; child < 8; ++child) {
      const double t = 0.5 + 0.5 * std::abs(u(engine));
      float* node = &nodes[i * std::size_t(CAPLET_NODE_FLOATS)];
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = double(o[k]) + t * double(d[k]);
        // Odd children are touched by the point itself, even ones missed by up to 15 eps of the
        // distance along one axis.
        const double off =
            child % 2 == 0 && k == child / 2 % 3 ? 15 * 0x1p-24 * reach * std::abs(u(engine)) : 0;
        const double size = child < 4 ? 0 : 1e-3 * std::abs(u(engine));
        float low = static_cast<float>(x + off), high = static_cast<float>(x + off + size);
        // Rounded so that the box still holds the point (moved by `off`): what a builder does.
        while (double(low) > x + off) low = std::nextafter(low, -inf);
        while (double(high) < x + off) high = std::nextafter(high, inf);
        node[8 * k + child] = low;
        node[24 + 8 * k + child] = high;
      }
    }
  }
  const Buffer<RayRecord> in(device, std::span<const RayRecord>(rays));
  for (const int width : {8, 1}) {
    const std::vector<float> sent = width == 8 ? nodes : packed_nodes(nodes);
    const Buffer<float> boxes(device, std::span<const float>(sent));
    const Program program = Program::from_source(device, "nodes_test", flatten_kernels(kernel),
                                                 fmt::format("-DCAPLET_REAL_WIDTH={}", width));
    Buffer<cl_uint> out(device, count);
    cl::Kernel meet = program.kernel("meet");
    set_arguments(device, meet, boxes, in, cl_uint(count), out);
    launch(device, meet, count, 64);
    int touched = 0, near = 0;
    for (const cl_uint bits : out.read()) {
      touched += std::popcount(bits & 0xaau);
      near += std::popcount(bits & 0x55u);
    }
    EXPECT_EQ(touched, int(4 * count)) << width;
    EXPECT_EQ(near, int(4 * count)) << width;
  }
}

TEST(Stack, HoldsWhatTheDeepestTreesLeave) {
  const Device& device = test_device();
  const std::vector<float> tree = deepest_tree();
  const Buffer<float> nodes(device, std::span<const float>(tree));
  const Program program =
      Program::from_source(device, "nodes_test", flatten_kernels(kernel), "-DCAPLET_REAL_WIDTH=8");
  Buffer<cl_uint> out(device, std::span<const cl_uint>(std::vector<cl_uint>(3, 0)));
  cl::Kernel descend = program.kernel("descend");
  set_arguments(device, descend, nodes, cl_uint(CAPLET_TREE_DEPTH_MAX), cl_uint(spare), out);
  launch(device, descend, 1, 1);
  // Left behind at each of the nodes: seven; written beyond the stack: nothing; nodes without a
  // child that is met: none.
  EXPECT_THAT(out.read(), testing::ElementsAre(2 * 7 * CAPLET_TREE_DEPTH_MAX, 0, 0));
}

}  // namespace
}  // namespace caplet::test::nodes_test
