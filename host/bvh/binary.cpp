// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Top-down binned surface area heuristic (Wald 2007). Parallel over subtrees and, near the root, over ranges; minima, maxima and
// counts do not depend on the order they are taken in, and partitions are stable, so neither does the tree.
#include "bvh/detail/binary.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include <atomic>
#include <bit>
#include <cmath>

namespace caplet::bvh {
namespace {

constexpr std::size_t max_bins = 32;
constexpr std::uint32_t parallel_threshold = 4096;  // references below which a subtree is one task
constexpr std::uint32_t chunk = 16384;              // references a task near the root

float centroid(const Reference& r, std::size_t axis) { return 0.5f * r.min[axis] + 0.5f * r.max[axis]; }

struct Bounds {
  Box box, centroids;
  bool mixed = false;
  std::uint32_t group = 0;
  bool empty = true;

  void add(const Reference& r) {
    box.extend(r);
    for (std::size_t k = 0; k < 3; k++) {
      const float c = centroid(r, k);
      centroids.min[k] = std::min(centroids.min[k], c);
      centroids.max[k] = std::max(centroids.max[k], c);
    }
    if (empty) group = r.group;
    mixed = mixed || r.group != group;
    empty = false;
  }
  void add(const Bounds& b) {
    if (b.empty) return;
    box.extend(b.box);
    centroids.extend(b.centroids);
    if (empty) group = b.group;
    mixed = mixed || b.mixed || b.group != group;
    empty = false;
  }
};

struct Bins {
  std::array<std::array<Box, max_bins>, 3> box;
  std::array<std::array<std::uint32_t, max_bins>, 3> count{};
};

/// Maps centroids to bins; an axis without extent has scale 0 and is not split.
struct Binning {
  std::array<float, 3> origin{}, scale{};
  std::size_t bins = 0;

  Binning(const Box& centroids, std::uint32_t count) : bins(count < 64 ? 8 : count < 1024 ? 16 : max_bins) {
    for (std::size_t k = 0; k < 3; k++) {
      const float extent = centroids.max[k] - centroids.min[k];
      const float per = static_cast<float>(bins) / extent;
      origin[k] = centroids.min[k];
      scale[k] = extent > 0 && std::isfinite(per) && per > 0 ? per : 0;
    }
  }
  std::size_t bin(const Reference& r, std::size_t axis) const {
    const float x = (centroid(r, axis) - origin[axis]) * scale[axis];
    return std::min(static_cast<std::size_t>(static_cast<std::uint32_t>(x)), bins - 1);
  }
};

/// Leaf blocks that `count` references will probably fill: a block costs the same however many of its lanes are used, and leaves
/// of a finished tree are about three quarters full.
double blocks(std::uint32_t count) { return count <= width ? 1.0 : static_cast<double>(count) / (0.75 * width); }

struct Split {
  double cost = std::numeric_limits<double>::infinity();
  std::size_t axis = 0, bin = 0;  // bins below `bin` go left
};

class Builder {
 public:
  Builder(BinaryTree& tree, std::uint32_t single_group) : tree_(tree), scratch_(tree.items.size()), single_group_(single_group) {}

  void run() {
    next_ = 1;
    build(0, 0, static_cast<std::uint32_t>(tree_.items.size()), 0);
    tree_.node_count = next_;
  }

 private:
  std::span<Reference> items(std::uint32_t first, std::uint32_t count) { return std::span(tree_.items).subspan(first, count); }

  Bounds bounds(std::uint32_t first, std::uint32_t count) {
    const auto range = items(first, count);
    const auto over = [&](const tbb::blocked_range<std::uint32_t>& r, Bounds b) {
      for (std::uint32_t i = r.begin(); i < r.end(); i++) b.add(range[i]);
      return b;
    };
    if (count < 2 * chunk) return over({0, count}, {});
    return tbb::parallel_reduce(tbb::blocked_range<std::uint32_t>(0, count, chunk), Bounds{}, over,
                                [](Bounds a, const Bounds& b) {
                                  a.add(b);
                                  return a;
                                });
  }

  Bins fill_bins(std::uint32_t first, std::uint32_t count, const Binning& binning) {
    const auto range = items(first, count);
    const auto over = [&](const tbb::blocked_range<std::uint32_t>& r, Bins bins) {
      for (std::uint32_t i = r.begin(); i < r.end(); i++)
        for (std::size_t axis = 0; axis < 3; axis++) {
          const std::size_t b = binning.bin(range[i], axis);
          bins.box[axis][b].extend(range[i]);
          bins.count[axis][b]++;
        }
      return bins;
    };
    if (count < 2 * chunk) return over({0, count}, {});
    return tbb::parallel_reduce(tbb::blocked_range<std::uint32_t>(0, count, chunk), Bins{}, over, [](Bins a, const Bins& b) {
      for (std::size_t axis = 0; axis < 3; axis++)
        for (std::size_t i = 0; i < max_bins; i++) {
          a.box[axis][i].extend(b.box[axis][i]);
          a.count[axis][i] += b.count[axis][i];
        }
      return a;
    });
  }

  static Split best_split(const Bins& bins, const Binning& binning) {
    Split best;
    for (std::size_t axis = 0; axis < 3; axis++) {
      if (binning.scale[axis] == 0) continue;
      std::array<double, max_bins> right_cost{};
      Box box;
      std::uint32_t count = 0;
      for (std::size_t b = binning.bins - 1; b > 0; b--) {
        box.extend(bins.box[axis][b]);
        count += bins.count[axis][b];
        right_cost[b] = count == 0 ? std::numeric_limits<double>::infinity() : box.area() * blocks(count);
      }
      box = {};
      count = 0;
      for (std::size_t b = 1; b < binning.bins; b++) {
        box.extend(bins.box[axis][b - 1]);
        count += bins.count[axis][b - 1];
        if (count == 0) continue;
        const double cost = box.area() * blocks(count) + right_cost[b];
        if (cost < best.cost) best = {cost, axis, b};
      }
    }
    return best;
  }

  /// Stable; returns how many went left.
  template <class Left>
  std::uint32_t partition(std::uint32_t first, std::uint32_t count, const Left& left) {
    const auto range = items(first, count);
    const auto spare = std::span(scratch_).subspan(first, count);
    if (count < 4 * chunk) {
      std::uint32_t kept = 0, moved = 0;
      for (std::uint32_t i = 0; i < count; i++) {
        if (left(range[i]))
          range[kept++] = range[i];
        else
          spare[moved++] = range[i];
      }
      std::copy(spare.begin(), spare.begin() + moved, range.begin() + kept);
      return kept;
    }
    const std::uint32_t chunks = (count + chunk - 1) / chunk;
    std::vector<std::uint32_t> lefts(chunks + 1, 0);
    const auto end = [&](std::uint32_t c) { return std::min(count, (c + 1) * chunk); };
    tbb::parallel_for(0u, chunks, [&](std::uint32_t c) {
      std::uint32_t n = 0;
      for (std::uint32_t i = c * chunk; i < end(c); i++) n += left(range[i]) ? 1 : 0;
      lefts[c + 1] = n;
    });
    for (std::uint32_t c = 0; c < chunks; c++) lefts[c + 1] += lefts[c];
    const std::uint32_t total = lefts[chunks];
    tbb::parallel_for(0u, chunks, [&](std::uint32_t c) {
      std::uint32_t l = lefts[c], r = total + c * chunk - lefts[c];
      for (std::uint32_t i = c * chunk; i < end(c); i++) (left(range[i]) ? spare[l++] : spare[r++]) = range[i];
    });
    tbb::parallel_for(0u, chunks, [&](std::uint32_t c) {
      std::copy(spare.begin() + c * chunk, spare.begin() + end(c), range.begin() + c * chunk);
    });
    return total;
  }

  void build(std::uint32_t index, std::uint32_t first, std::uint32_t count, int depth) {
    const Bounds b = bounds(first, count);
    BinaryNode& node = tree_.nodes[index];
    node = {b.box, 0, 0, first, count};
    if (count == 1 || (count <= width && !b.mixed && b.group != single_group_)) return;

    std::uint32_t left = 0;
    // A median split needs log2(count) levels below; with groups apart, one more. The heuristic may use what is beyond that.
    const int needed = static_cast<int>(std::bit_width(count)) + 2;
    if (depth + needed < max_depth) {
      if (count <= width && b.mixed) {
        left = partition(first, count, [&](const Reference& r) { return r.group == b.group; });
      } else {
        const Binning binning(b.centroids, count);
        const Split split = best_split(fill_bins(first, count, binning), binning);
        if (std::isfinite(split.cost))
          left = partition(first, count, [&](const Reference& r) { return binning.bin(r, split.axis) < split.bin; });
      }
    }
    if (left == 0 || left == count) left = count / 2;  // nothing tells them apart, or the depth is used up: halve the list

    const std::uint32_t children = next_.fetch_add(2);
    node.left = children;
    node.right = children + 1;
    const auto go_left = [&] { build(children, first, left, depth + 1); };
    const auto go_right = [&] { build(children + 1, first + left, count - left, depth + 1); };
    if (count > parallel_threshold) {
      tbb::parallel_invoke(go_left, go_right);
    } else {
      go_left();
      go_right();
    }
  }

  BinaryTree& tree_;
  std::vector<Reference> scratch_;
  std::uint32_t single_group_;
  std::atomic<std::uint32_t> next_ = 0;
};

}  // namespace

BinaryTree build_binary(std::span<const Reference> references, std::uint32_t single_group) {
  BinaryTree tree;
  tree.items.assign(references.begin(), references.end());
  for (std::size_t i = 0; i < tree.items.size(); i++) tree.items[i].primitive = static_cast<std::uint32_t>(i);
  tree.nodes = std::make_unique_for_overwrite<BinaryNode[]>(2 * tree.items.size());
  Builder(tree, single_group).run();
  return tree;
}

}  // namespace caplet::bvh
