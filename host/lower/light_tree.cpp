// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/light_tree.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "base/check.h"
#include "bvh/bvh.h"
#include "lower/detail/floats.h"

namespace caplet {

namespace {

using glm::dvec3;

constexpr int width = bvh::width;
constexpr std::uint32_t ahead =
    24;  // lights that are asked for before they are needed: they lie anywhere
constexpr double cells = 65535;  // of the grid, along each axis
static_assert(CAPLET_LIGHT_NODE == 7 * width);

/// Computes normal_bits of kernels/lights/tree.cl.
std::uint32_t octahedral_bits(const dvec3& n) {
  const double scale = 1 / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
  double x = n.x * scale, y = n.y * scale;
  if (n.z < 0) {
    const double fold = (1 - std::abs(y)) * (x < 0 ? -1 : 1);
    y = (1 - std::abs(x)) * (y < 0 ? -1 : 1);
    x = fold;
  }
  const auto low = static_cast<std::uint32_t>(x * 32767 + 32767.5),
             high = static_cast<std::uint32_t>(y * 32767 + 32767.5);
  return low | high << 16;
}

/// octahedral_bits may turn a direction by at most this angle: half a step of each coordinate of
/// the octahedron, which is at least 1/sqrt(3) away.
constexpr double axis_error = 1e-4;

/// Returns the cosine, in 65535ths of [-1, 1], of an angle that is axis_error greater: it is never
/// above the exact cosine. Neighbours mostly have the same cosine, so the last result is kept.
class CosineBits {
 public:
  std::uint32_t operator()(double cosine) {
    if (cosine != cosine_) {
      cosine_ = cosine;
      const double angle =
          std::min(std::acos(std::clamp(cosine, -1.0, 1.0)) + axis_error, std::numbers::pi);
      bits_ = static_cast<std::uint32_t>(
          std::clamp(std::floor((std::cos(angle) + 1) * 0.5 * 65535), 0.0, 65535.0));
    }
    return bits_;
  }

 private:
  double cosine_ = std::numeric_limits<double>::quiet_NaN();
  std::uint32_t bits_ = 0;
};

/// Grid is the grid of the boxes' ends.
struct Grid {
  dvec3 min, cell;

  Grid(const dvec3& low, const dvec3& high) {
    for (int k = 0; k < 3; ++k) {
      // These are floats, as the kernel has them; the last cell ends beyond the box.
      min[k] = std::nextafter(static_cast<float>(low[k]), -INFINITY);
      cell[k] = std::nextafter(static_cast<float>((high[k] - min[k]) / cells), INFINITY);
      while (min[k] + cell[k] * cells < high[k])
        cell[k] = std::nextafter(static_cast<float>(cell[k]), INFINITY);
    }
  }
  std::uint32_t ends(int k, double low, double high) const {
    const double above = (high - min[k]) / cell[k];
    const std::uint32_t down = whole((low - min[k]) / cell[k]), whole_above = whole(above);
    return down | (whole_above + (whole_above < above && whole_above < cells ? 1 : 0)) << 16;
  }

 private:
  static std::uint32_t whole(double x) {
    return static_cast<std::uint32_t>(std::clamp(x, 0.0, cells));
  }
};

/// Extent is the box of some lights.
struct Extent {
  dvec3 min{INFINITY}, max{-INFINITY};
  void extend(const dvec3& low, const dvec3& high) {
    min = glm::min(min, low);
    max = glm::max(max, high);
  }
};

}  // namespace

namespace {

/// Sets the smallest cone that holds both.
void unite_cones(LightBounds& out, const LightBounds& b) {
  const LightBounds a = out;
  const LightBounds &wide = a.cos_cone < b.cos_cone ? a : b,
                    &narrow = a.cos_cone < b.cos_cone ? b : a;
  const double theta_wide = std::acos(std::clamp(wide.cos_cone, -1.0, 1.0)),
               theta_narrow = std::acos(std::clamp(narrow.cos_cone, -1.0, 1.0));
  const double between = std::acos(std::clamp(glm::dot(a.axis, b.axis), -1.0, 1.0));
  out.axis = wide.axis;
  out.cos_cone = wide.cos_cone;
  if (std::min(between + theta_narrow, std::numbers::pi) <= theta_wide) return;
  const double theta = 0.5 * (theta_wide + between + theta_narrow);
  const dvec3 across = narrow.axis - wide.axis * glm::dot(narrow.axis, wide.axis);
  const double length = glm::length(across);
  if (theta >= std::numbers::pi || length < 1e-9) {
    out.cos_cone = -1;
    return;
  }
  const double turn = theta - theta_wide;
  out.axis = glm::normalize(wide.axis * std::cos(turn) + across * (std::sin(turn) / length));
  out.cos_cone = std::cos(theta);
}

inline void unite(LightBounds& to, const LightBounds& b) {
  for (int k = 0; k < 3; ++k) {
    to.min[k] = std::min(to.min[k], b.min[k]);
    to.max[k] = std::max(to.max[k], b.max[k]);
  }
  to.intensity += b.intensity;
  to.cos_reach = std::min(to.cos_reach, b.cos_reach);
  if (b.cos_cone <= -1) {  // as capsules are, all around: nothing to turn
    to.axis = b.axis;
    to.cos_cone = b.cos_cone;
  } else if (to.cos_cone > -1) {
    unite_cones(to, b);
  }
}

}  // namespace

LightBounds united(const LightBounds& a, const LightBounds& b) {
  LightBounds out = a;
  unite(out, b);
  return out;
}

void TreeLights::add(std::uint32_t light, const LightBounds& of) {
  One& one = lights.emplace_back(One{{of.min.x, of.min.y, of.min.z},
                                     {of.max.x, of.max.y, of.max.z},
                                     of.intensity,
                                     light,
                                     all_around});
  if (of.cos_cone <= -1 && of.cos_reach == 0) return;
  one.cone = narrow<std::uint32_t>(cones.size());
  cones.push_back({of.axis, of.cos_cone, of.cos_reach});
}

LightBounds TreeLights::bounds_of(const One& light) const {
  LightBounds out;
  out.min = {light.min[0], light.min[1], light.min[2]};
  out.max = {light.max[0], light.max[1], light.max[2]};
  out.intensity = light.intensity;
  if (light.cone != all_around) {
    const Cone& cone = cones[light.cone];
    out.axis = cone.axis;
    out.cos_cone = cone.cos_cone;
    out.cos_reach = cone.cos_reach;
  }
  return out;
}

namespace {

/// Returns the box of each light, for the tree's builder, and the extent of all.
std::pair<std::vector<bvh::Reference>, Extent> boxes_of(
    const std::vector<TreeLights::One>& lights) {
  std::vector<bvh::Reference> boxes(lights.size());
  const Extent extent = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, lights.size(), 4096), Extent{},
      [&](const tbb::blocked_range<std::size_t>& range, Extent all) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          const TreeLights::One& of = lights[i];
          bvh::Reference& box = boxes[i];
          for (int k = 0; k < 3; ++k) {
            box.min[k] = next_down(static_cast<float>(of.min[k]));
            box.max[k] = next_up(static_cast<float>(of.max[k]));
          }
          box.primitive = static_cast<std::uint32_t>(i);
          box.group = 0;
          all.extend({of.min[0], of.min[1], of.min[2]}, {of.max[0], of.max[1], of.max[2]});
        }
        return all;
      },
      [](Extent a, const Extent& b) {
        a.extend(b.min, b.max);
        return a;
      });
  return {std::move(boxes), extent};
}

/// Writes a built tree as nodes of the device. Leaves of several lights become nodes, behind the
/// others.
class LightTreeWriter {
 public:
  LightTreeWriter(const TreeLights& lights, const bvh::Tree& tree, const Grid& grid,
                  std::size_t light_count, FlatScene& out)
      : lights_(lights),
        tree_(tree),
        grid_(grid),
        light_count_(light_count),
        out_(out),
        node_of_leaf_(tree.leaves.size(), CAPLET_NONE) {
    std::size_t count = tree.nodes.size();
    for (std::size_t i = 0; i < tree.leaves.size(); ++i)
      if (tree.leaves[i].count > 1) node_of_leaf_[i] = narrow<std::uint32_t>(count++);
    out.light_nodes.assign(count * CAPLET_LIGHT_NODE, 0);
    out.light_places.assign(light_count + count, CAPLET_NONE);
    bounds_.resize(count);
  }

  void write() {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tree_.leaves.size(), 256),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        Cosines cosines;
                        for (std::size_t i = range.begin(); i < range.end(); ++i)
                          if (node_of_leaf_[i] != CAPLET_NONE) write_leaf(i, cosines);
                      });
    Cosines cosines;
    for (std::size_t i = tree_.nodes.size(); i-- > 0;)
      write_node(i, cosines);  // children before parents
  }

 private:
  struct Cosines {
    CosineBits cone, reach;
  };
  /// A slot of a node refers to this, and has the bounds of its lights.
  struct Child {
    std::uint32_t reference;
    LightBounds bounds;
  };

  const TreeLights::One& light(std::size_t ordered) const {
    return lights_.lights[tree_.order[ordered]];
  }
  uint& reference_at(std::size_t node, std::uint32_t slot) {
    return out_
        .light_nodes[node * std::size_t{CAPLET_LIGHT_NODE} + CAPLET_LIGHT_NODE_CHILDREN + slot];
  }
  Child of_light(std::size_t ordered) const {
    const TreeLights::One& one = light(ordered);
    return {one.light | CAPLET_LIGHT_LEAF, lights_.bounds_of(one)};
  }
  Child of_node(const bvh::Node& node, std::uint32_t slot) const {
    if (node.child[slot] >= 0) {
      const auto number = static_cast<std::uint32_t>(node.child[slot]);
      return {number, bounds_[number]};
    }
    const auto leaf = static_cast<std::uint32_t>(~node.child[slot]);
    if (const std::uint32_t number = node_of_leaf_[leaf]; number != CAPLET_NONE)
      return {number, bounds_[number]};
    return of_light(tree_.leaves[leaf].first);
  }

  void write_leaf(std::size_t at, Cosines& cosines) {
    const bvh::Leaf& leaf = tree_.leaves[at];
    const std::uint32_t node = node_of_leaf_[at];
    for (std::uint32_t k = 0; k < width; ++k) {
      if (k >= leaf.count) {
        reference_at(node, k) = CAPLET_NONE;
        continue;
      }
      __builtin_prefetch(
          &light(std::min(leaf.first + k + std::size_t{ahead}, lights_.lights.size() - 1)));
      write_slot(node, k, of_light(leaf.first + k), k == 0, cosines);
    }
  }

  void write_node(std::size_t at, Cosines& cosines) {
    const bvh::Node& node = tree_.nodes[at];
    bool is_first = true;
    for (std::uint32_t slot = 0; slot < width; ++slot) {
      if (node.min[0][slot] > node.max[0][slot]) {
        reference_at(at, slot) = CAPLET_NONE;
        continue;
      }
      write_slot(at, slot, of_node(node, slot), std::exchange(is_first, false), cosines);
    }
  }

  void write_slot(std::size_t node, std::uint32_t slot, const Child& child, bool is_first,
                  Cosines& cosines) {
    const LightBounds& of = child.bounds;
    if (is_first)
      bounds_[node] = of;
    else
      unite(bounds_[node], of);
    uint* const rows = &out_.light_nodes[node * CAPLET_LIGHT_NODE + slot];
    for (int k = 0; k < 3; ++k) rows[8 * k] = grid_.ends(k, of.min[k], of.max[k]);
    rows[24] = octahedral_bits(of.axis);
    rows[32] = cosines.cone(of.cos_cone) | cosines.reach(of.cos_reach) << 16;
    rows[40] = std::bit_cast<uint>(static_cast<float>(std::clamp(of.intensity, 0x1p-100, 0x1p100)));
    rows[CAPLET_LIGHT_NODE_CHILDREN] = child.reference;
    const bool is_light = (child.reference & CAPLET_LIGHT_LEAF) != 0;
    const std::size_t place =
        is_light ? child.reference & ~CAPLET_LIGHT_LEAF : light_count_ + child.reference;
    out_.light_places[place] = narrow<uint>(node * width + slot);
  }

  const TreeLights& lights_;
  const bvh::Tree& tree_;
  const Grid& grid_;
  std::size_t light_count_;
  FlatScene& out_;
  std::vector<std::uint32_t> node_of_leaf_;  // CAPLET_NONE: a single light
  std::vector<LightBounds> bounds_;          // by node
};

}  // namespace

void lower_light_tree(const TreeLights& all_lights, std::size_t light_count, FlatScene& out) {
  const std::vector<TreeLights::One>& lights = all_lights.lights;
  out.light_nodes.clear();
  out.light_places.clear();
  LightingRecord& record = out.lighting;
  for (int k = 0; k < 3; ++k) record.tree_min[k] = record.tree_cell[k] = 0;
  if (lights.empty()) return;
  auto [boxes, extent] = boxes_of(lights);
  const Grid grid(extent.min, extent.max);
  const bvh::Tree tree = bvh::build(std::move(boxes), 0, bvh::Effort::quick);
  LightTreeWriter(all_lights, tree, grid, light_count, out).write();
  for (int k = 0; k < 3; ++k) {
    record.tree_min[k] = static_cast<float>(grid.min[k]);
    record.tree_cell[k] = static_cast<float>(grid.cell[k]);
  }
}

}  // namespace caplet
