// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/light_tree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "base/check.h"
#include "bvh/bvh.h"

namespace caplet {

namespace {

using glm::dvec3;

constexpr int width = bvh::width;
constexpr double cells = 65535;  // of the grid, along each axis
static_assert(CAPLET_LIGHT_NODE == 7 * width);

/// normal_bits of kernels/lights/tree.cl.
std::uint32_t octahedral_bits(const dvec3& n) {
  const double scale = 1 / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
  double x = n.x * scale, y = n.y * scale;
  if (n.z < 0) {
    const double fold = (1 - std::abs(y)) * (x < 0 ? -1 : 1);
    y = (1 - std::abs(x)) * (y < 0 ? -1 : 1);
    x = fold;
  }
  const auto low = static_cast<std::uint32_t>(x * 32767 + 32767.5), high = static_cast<std::uint32_t>(y * 32767 + 32767.5);
  return low | high << 16;
}

/// Of the angle by which octahedral_bits may turn a direction: half a step of each coordinate of the octahedron, which is at
/// least 1/sqrt(3) away.
constexpr double axis_error = 1e-4;

/// In 65535ths of [-1, 1], of an angle that is `more` greater: never above the cosine that is meant.
std::uint32_t cosine_bits(double cosine, double more) {
  const double angle = std::min(std::acos(std::clamp(cosine, -1.0, 1.0)) + more, std::numbers::pi);
  return static_cast<std::uint32_t>(std::clamp(std::floor((std::cos(angle) + 1) * 0.5 * 65535), 0.0, 65535.0));
}

/// The grid of the boxes' ends.
struct Grid {
  dvec3 min, cell;

  Grid(const dvec3& low, const dvec3& high) {
    for (int k = 0; k < 3; ++k) {
      // Floats, as the kernel has them; the last cell ends beyond the box.
      min[k] = std::nextafter(static_cast<float>(low[k]), -INFINITY);
      cell[k] = std::nextafter(static_cast<float>((high[k] - min[k]) / cells), INFINITY);
      while (min[k] + cell[k] * cells < high[k]) cell[k] = std::nextafter(static_cast<float>(cell[k]), INFINITY);
    }
  }
  std::uint32_t ends(int k, double low, double high) const {
    const auto down = static_cast<std::uint32_t>(std::clamp(std::floor((low - min[k]) / cell[k]), 0.0, cells));
    const auto up = static_cast<std::uint32_t>(std::clamp(std::ceil((high - min[k]) / cell[k]), 0.0, cells));
    return down | up << 16;
  }
};

}  // namespace

LightBounds united(const LightBounds& a, const LightBounds& b) {
  LightBounds out;
  out.min = glm::min(a.min, b.min);
  out.max = glm::max(a.max, b.max);
  out.intensity = a.intensity + b.intensity;
  out.cos_reach = std::min(a.cos_reach, b.cos_reach);
  const LightBounds &wide = a.cos_cone < b.cos_cone ? a : b, &narrow = a.cos_cone < b.cos_cone ? b : a;
  if (wide.cos_cone <= -1) {  // as capsules are, all around: nothing to turn
    out.axis = wide.axis;
    out.cos_cone = wide.cos_cone;
    return out;
  }
  const double theta_wide = std::acos(std::clamp(wide.cos_cone, -1.0, 1.0)),
               theta_narrow = std::acos(std::clamp(narrow.cos_cone, -1.0, 1.0));
  const double between = std::acos(std::clamp(glm::dot(a.axis, b.axis), -1.0, 1.0));
  out.axis = wide.axis;
  out.cos_cone = wide.cos_cone;
  if (std::min(between + theta_narrow, std::numbers::pi) <= theta_wide) return out;
  const double theta = 0.5 * (theta_wide + between + theta_narrow);
  const dvec3 across = narrow.axis - wide.axis * glm::dot(narrow.axis, wide.axis);
  const double length = glm::length(across);
  if (theta >= std::numbers::pi || length < 1e-9) {
    out.cos_cone = -1;
    return out;
  }
  const double turn = theta - theta_wide;
  out.axis = glm::normalize(wide.axis * std::cos(turn) + across * (std::sin(turn) / length));
  out.cos_cone = std::cos(theta);
  return out;
}

void lower_light_tree(std::span<const TreeLight> lights, std::size_t light_count, FlatScene& out) {
  out.light_nodes.clear();
  out.light_places.clear();
  LightingRecord& record = out.lighting;
  record.tree_nodes = 0;
  for (int k = 0; k < 3; ++k) record.tree_min[k] = record.tree_cell[k] = 0;
  if (lights.empty()) return;

  std::vector<bvh::Reference> boxes(lights.size());
  tbb::parallel_for(std::size_t{0}, lights.size(), [&](std::size_t i) {
    const LightBounds& of = lights[i].bounds;
    for (int k = 0; k < 3; ++k) {
      boxes[i].min[k] = std::nextafter(static_cast<float>(of.min[k]), -INFINITY);
      boxes[i].max[k] = std::nextafter(static_cast<float>(of.max[k]), INFINITY);
    }
    boxes[i].primitive = static_cast<std::uint32_t>(i);
    boxes[i].group = 0;
  });
  const bvh::Tree tree = bvh::build(boxes);

  // Leaves of several lights become nodes, behind the others.
  std::vector<std::int32_t> node_of_leaf(tree.leaves.size(), -1);
  std::size_t count = tree.nodes.size();
  for (std::size_t i = 0; i < tree.leaves.size(); ++i)
    if (tree.leaves[i].count > 1) node_of_leaf[i] = narrow<std::int32_t>(count++);

  std::vector<LightBounds> bounds(count);
  const auto bounds_of = [&](std::uint32_t ordered) -> const LightBounds& { return lights[tree.order[ordered]].bounds; };
  tbb::parallel_for(std::size_t{0}, tree.leaves.size(), [&](std::size_t i) {
    if (node_of_leaf[i] < 0) return;
    const bvh::Leaf& leaf = tree.leaves[i];
    LightBounds all = bounds_of(leaf.first);
    for (std::uint32_t k = 1; k < leaf.count; ++k) all = united(all, bounds_of(leaf.first + k));
    bounds[static_cast<std::size_t>(node_of_leaf[i])] = all;
  });
  struct Child {
    LightBounds bounds;
    std::uint32_t reference = CAPLET_NONE;
  };
  const auto child_of = [&](const bvh::Node& node, int slot) -> Child {
    if (node.min[0][slot] > node.max[0][slot]) return {};
    const std::int32_t child = node.child[slot];
    if (child >= 0) return {bounds[static_cast<std::size_t>(child)], static_cast<std::uint32_t>(child)};
    const auto leaf = static_cast<std::uint32_t>(~child);
    if (node_of_leaf[leaf] >= 0)
      return {bounds[static_cast<std::size_t>(node_of_leaf[leaf])], static_cast<std::uint32_t>(node_of_leaf[leaf])};
    const std::uint32_t first = tree.leaves[leaf].first;
    return {bounds_of(first), lights[tree.order[first]].light | CAPLET_LIGHT_LEAF};
  };
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    bool some = false;
    for (int slot = 0; slot < width; ++slot)
      if (const Child child = child_of(tree.nodes[i], slot); child.reference != CAPLET_NONE) {
        bounds[i] = some ? united(bounds[i], child.bounds) : child.bounds;
        some = true;
      }
  }

  const Grid grid(bounds[0].min, bounds[0].max);
  out.light_nodes.assign(count * CAPLET_LIGHT_NODE, 0);
  out.light_places.assign(light_count + count, CAPLET_NONE);
  const auto write = [&](std::size_t node, const std::array<Child, width>& children) {
    uint* const rows = &out.light_nodes[node * CAPLET_LIGHT_NODE];
    for (std::uint32_t slot = 0; slot < width; ++slot) {
      const Child& child = children[slot];
      rows[48 + slot] = child.reference;
      if (child.reference == CAPLET_NONE) continue;
      const LightBounds& of = child.bounds;
      for (int k = 0; k < 3; ++k) rows[static_cast<std::uint32_t>(k) * 8 + slot] = grid.ends(k, of.min[k], of.max[k]);
      rows[24 + slot] = octahedral_bits(of.axis);
      rows[32 + slot] = cosine_bits(of.cos_cone, axis_error) | cosine_bits(of.cos_reach, axis_error) << 16;
      rows[40 + slot] = std::bit_cast<uint>(static_cast<float>(std::clamp(of.intensity, 0x1p-100, 0x1p100)));
      const std::size_t place =
          child.reference & CAPLET_LIGHT_LEAF ? child.reference & ~CAPLET_LIGHT_LEAF : light_count + child.reference;
      out.light_places[place] = narrow<uint>(node * width + slot);
    }
  };
  tbb::parallel_for(std::size_t{0}, tree.nodes.size(), [&](std::size_t i) {
    std::array<Child, width> children;
    for (int slot = 0; slot < width; ++slot) children[static_cast<std::size_t>(slot)] = child_of(tree.nodes[i], slot);
    write(i, children);
  });
  tbb::parallel_for(std::size_t{0}, tree.leaves.size(), [&](std::size_t i) {
    if (node_of_leaf[i] < 0) return;
    std::array<Child, width> children;
    for (std::uint32_t k = 0; k < tree.leaves[i].count; ++k) {
      const TreeLight& light = lights[tree.order[tree.leaves[i].first + k]];
      children[k] = {light.bounds, light.light | CAPLET_LIGHT_LEAF};
    }
    write(static_cast<std::size_t>(node_of_leaf[i]), children);
  });
  for (int k = 0; k < 3; ++k) {
    record.tree_min[k] = static_cast<float>(grid.min[k]);
    record.tree_cell[k] = static_cast<float>(grid.cell[k]);
  }
  record.tree_nodes = narrow<uint>(count);
}

}  // namespace caplet
