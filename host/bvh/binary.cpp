// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Builds a binary tree top-down by the binned surface area heuristic (Wald 2007). With many
// references the upper levels are built over the cells of a grid that the references are sorted
// into first, as if each cell were one reference; only below are references used one by one. The
// build is parallel over subtrees and, near the root, over ranges. Minima, maxima and counts do not
// depend on the order they are taken in, and partitions are stable, so the tree does not depend on
// it either.
#include "bvh/detail/binary.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <numeric>
#include <span>
#include <utility>

namespace caplet::bvh {
namespace {

constexpr std::size_t max_bins = 32;
constexpr std::uint32_t parallel_threshold = 4096;  // references below which a subtree is one task
constexpr std::uint32_t chunk = 16384;              // references a task near the root
constexpr std::uint32_t grid_pays_from = 65536;     // references
constexpr int max_cell_bits = 6;                    // an axis

/// Cells is the range over which large trees use the grid.
struct Cells {
  std::uint32_t references;  // a cell, roughly
  std::size_t least;         // a subtree of fewer cells is split by its references
};
constexpr Cells cells_of(Effort effort) {
  return effort == Effort::full ? Cells{32, 64} : Cells{8, 8};
}

// The lanes are x, y, z and an unused fourth one, which instructions of four lanes have anyway.
typedef float Float4 __attribute__((vector_size(16)));
typedef std::int32_t Int4 __attribute__((vector_size(16)));

Float4 least(Float4 a, Float4 b) { return b < a ? b : a; }
Float4 greatest(Float4 a, Float4 b) { return a < b ? b : a; }

/// The fourth lane is 0: other bits there might be a number that CPUs are slow with.
Float4 corner(const float* at) {
  const Int4 mask = {-1, -1, -1, 0};
  Int4 bits;
  std::memcpy(&bits, at, sizeof bits);
  bits &= mask;
  return std::bit_cast<Float4>(bits);
}

/// LaneBox is a Box in lanes.
struct LaneBox {
  Float4 min = {Box::inf, Box::inf, Box::inf, Box::inf}, max = -min;

  void extend(Float4 low, Float4 high) {
    min = least(min, low);
    max = greatest(max, high);
  }
  void extend(const LaneBox& b) { extend(b.min, b.max); }
  Box box() const { return {{min[0], min[1], min[2]}, {max[0], max[1], max[2]}}; }
};

Float4 centroid(Float4 low, Float4 high) { return 0.5f * low + 0.5f * high; }

/// Bounds holds the box of some references and that of their centroids.
struct Bounds {
  LaneBox box, centroids;
  bool mixed = false;  // of several groups

  void add(const Bounds& b) {
    box.extend(b.box);
    centroids.extend(b.centroids);
    mixed = mixed || b.mixed;
  }
};

struct Bins {
  std::array<std::array<Float4, max_bins>, 3> min, max;
  std::array<std::array<std::uint32_t, max_bins>, 3> count;

  /// Empties the first `bins` of each axis; the others are not used.
  explicit Bins(std::size_t bins) {
    const LaneBox nothing;
    for (std::size_t axis = 0; axis < 3; axis++)
      for (std::size_t i = 0; i < bins; i++) {
        min[axis][i] = nothing.min;
        max[axis][i] = nothing.max;
        count[axis][i] = 0;
      }
  }
  LaneBox box(std::size_t axis, std::size_t bin) const { return {min[axis][bin], max[axis][bin]}; }
  void extend(std::size_t axis, std::size_t bin, Float4 low, Float4 high, std::uint32_t by) {
    min[axis][bin] = least(min[axis][bin], low);
    max[axis][bin] = greatest(max[axis][bin], high);
    count[axis][bin] += by;
  }
};

std::size_t bins_for(std::uint32_t count) { return count < 64 ? 8 : count < 1024 ? 16 : max_bins; }

/// Maps centroids to bins; an axis without extent has scale 0 and is not split.
struct Binning {
  Float4 origin{}, scale{};
  std::size_t bins = 0;

  Binning(const Box& centroids, std::uint32_t count) : Binning(centroids, bins_for(count)) {}
  Binning(const Box& centroids, std::size_t bins_an_axis) : bins(bins_an_axis) {
    for (std::size_t k = 0; k < 3; k++) {
      const float extent = centroids.max[k] - centroids.min[k];
      const float per = static_cast<float>(bins) / extent;
      origin[k] = centroids.min[k];
      scale[k] = extent > 0 && std::isfinite(per) && per > 0 ? per : 0;
    }
  }
  /// Returns the bins along all axes; along an axis without extent it is some bin.
  Int4 bin(Float4 center) const {
    const float last = static_cast<float>(bins) - 0.5f;
    const Float4 x = (center - origin) * scale, most = {last, last, last, last};
    return __builtin_convertvector(x < most ? x : most, Int4);
  }
};

/// Returns the number of leaf blocks that `count` references will probably fill: a block costs the
/// same however many of its lanes are used, and leaves of a finished tree are about three quarters
/// full.
double blocks(std::uint32_t count) {
  return count <= width ? 1.0 : static_cast<double>(count) / (0.75 * width);
}

struct Split {
  double cost = std::numeric_limits<double>::infinity();
  std::size_t axis = 0, bin = 0;  // bins below `bin` go left
};

class Builder {
 public:
  Builder(BinaryTree& tree, std::uint64_t single_groups, Effort effort)
      : tree_(tree),
        count_(static_cast<std::uint32_t>(tree.items.size())),
        scratch_(std::make_unique_for_overwrite<Reference[]>(count_)),
        single_groups_(single_groups),
        cell_size_(cells_of(effort)) {}

  void run() {
    next_ = 1;
    const Bounds all = bounds(0, count_);
    if (count_ >= grid_pays_from) {
      build_by_cells(all);
    } else {
      for (std::uint32_t i = 0; i < count_; i++) tree_.items[i].primitive = i;
      build(0, 0, count_, 0, all);
    }
    tree_.node_count = next_;
  }

 private:
  std::span<Reference> items(std::uint32_t first, std::uint32_t count) {
    return {tree_.items.data() + first, count};
  }
  Bounds bounds(std::uint32_t first, std::uint32_t count) { return bounds(items(first, count)); }

  static Bounds bounds(std::span<const Reference> range) {
    const auto count = static_cast<std::uint32_t>(range.size());
    const std::uint32_t group = range[0].group;
    const auto over = [&](const tbb::blocked_range<std::uint32_t>& r, Bounds b) {
      for (std::uint32_t i = r.begin(); i < r.end(); i++) {
        const Float4 low = corner(range[i].min), high = corner(range[i].max),
                     center = centroid(low, high);
        b.box.extend(low, high);
        b.centroids.extend(center, center);
        b.mixed = b.mixed || range[i].group != group;
      }
      return b;
    };
    if (count < 2 * chunk) return over({0, count}, {});
    return tbb::parallel_reduce(tbb::blocked_range<std::uint32_t>(0, count, chunk), Bounds{}, over,
                                [](Bounds a, const Bounds& b) {
                                  a.add(b);
                                  return a;
                                });
  }

  void fill_bins(std::uint32_t first, std::uint32_t count, const Binning& binning, Bins& bins) {
    const auto range = items(first, count);
    const auto over = [&](const tbb::blocked_range<std::uint32_t>& r, Bins& to) {
      for (std::uint32_t i = r.begin(); i < r.end(); i++) {
        const Float4 low = corner(range[i].min), high = corner(range[i].max);
        const Int4 bin = binning.bin(centroid(low, high));
        for (std::size_t axis = 0; axis < 3; axis++)
          to.extend(axis, static_cast<std::size_t>(bin[axis]), low, high, 1);
      }
    };
    if (count < 2 * chunk) return over({0, count}, bins);
    bins = tbb::parallel_reduce(
        tbb::blocked_range<std::uint32_t>(0, count, chunk), bins,
        [&](const tbb::blocked_range<std::uint32_t>& r, Bins to) {
          over(r, to);
          return to;
        },
        [&](Bins a, const Bins& b) {
          for (std::size_t axis = 0; axis < 3; axis++)
            for (std::size_t i = 0; i < binning.bins; i++)
              a.extend(axis, i, b.min[axis][i], b.max[axis][i], b.count[axis][i]);
          return a;
        });
  }

  static Split best_split(const Bins& bins, const Binning& binning) {
    Split best;
    for (std::size_t axis = 0; axis < 3; axis++) {
      if (binning.scale[axis] == 0) continue;
      std::array<double, max_bins> right_cost;
      LaneBox box;
      std::uint32_t count = 0;
      for (std::size_t b = binning.bins - 1; b > 0; b--) {
        box.extend(bins.box(axis, b));
        count += bins.count[axis][b];
        right_cost[b] =
            count == 0 ? std::numeric_limits<double>::infinity() : box.box().area() * blocks(count);
      }
      box = {};
      count = 0;
      for (std::size_t b = 1; b < binning.bins; b++) {
        box.extend(bins.box(axis, b - 1));
        count += bins.count[axis][b - 1];
        if (count == 0) continue;
        const double cost = box.box().area() * blocks(count) + right_cost[b];
        if (cost < best.cost) best = {cost, axis, b};
      }
    }
    return best;
  }

  /// Halves says how many went left, and the bounds of both sides' centroids: left, right.
  struct Halves {
    std::uint32_t left = 0;
    std::array<LaneBox, 2> centroids;
  };

  /// The partition is stable.
  template <class Left>
  Halves partition(std::uint32_t first, std::uint32_t count, const Left& left) {
    const auto range = items(first, count);
    const std::span<Reference> spare(scratch_.get() + first, count);
    Halves halves;
    const auto center_of = [](const Reference& r) {
      return centroid(corner(r.min), corner(r.max));
    };
    if (count < 4 * chunk) {
      std::uint32_t kept = 0;
      for (std::uint32_t i = 0; i < count; i++) {
        // Each reference is written to both sides and kept on one, so that there is no branch to
        // mispredict.
        const Reference r = range[i];
        const std::uint32_t is_left = left(r) ? 1 : 0;
        const Float4 center = center_of(r);
        range[kept] = spare[i - kept] = r;
        kept += is_left;
        halves.centroids[1 - is_left].extend(center, center);
      }
      std::copy(spare.begin(), spare.begin() + (count - kept), range.begin() + kept);
      halves.left = kept;
      return halves;
    }
    const std::uint32_t chunks = (count + chunk - 1) / chunk;
    std::vector<std::uint32_t> lefts(chunks + 1, 0);
    std::vector<std::array<LaneBox, 2>> centroids(chunks);
    const auto end = [&](std::uint32_t c) { return std::min(count, (c + 1) * chunk); };
    tbb::parallel_for(0u, chunks, [&](std::uint32_t c) {
      std::uint32_t n = 0;
      for (std::uint32_t i = c * chunk; i < end(c); i++) n += left(range[i]) ? 1 : 0;
      lefts[c + 1] = n;
    });
    for (std::uint32_t c = 0; c < chunks; c++) lefts[c + 1] += lefts[c];
    halves.left = lefts[chunks];
    tbb::parallel_for(0u, chunks, [&](std::uint32_t c) {
      std::uint32_t to[2] = {lefts[c], halves.left + c * chunk - lefts[c]};
      for (std::uint32_t i = c * chunk; i < end(c); i++) {
        const std::uint32_t side = left(range[i]) ? 0 : 1;
        const Float4 center = center_of(range[i]);
        centroids[c][side].extend(center, center);
        spare[to[side]++] = range[i];
      }
    });
    tbb::parallel_for(0u, chunks, [&](std::uint32_t c) {
      std::copy(spare.begin() + c * chunk, spare.begin() + end(c), range.begin() + c * chunk);
    });
    for (const auto& sides : centroids)
      for (std::size_t side = 0; side < 2; side++) halves.centroids[side].extend(sides[side]);
    return halves;
  }

  void build(std::uint32_t index, std::uint32_t first, std::uint32_t count, int depth,
             const Bounds& b) {
    BinaryNode& node = tree_.nodes[index];
    const Box box = b.box.box();
    node = {box.min, box.max, 0, first, count};
    const std::uint32_t group = tree_.items[first].group;
    if (count == 1 || (count <= width && !b.mixed && (single_groups_ >> group & 1) == 0)) return;

    std::uint32_t left = 0;
    std::array<Bounds, 2> sides;
    bool bounded = false;  // `sides` are known
    // A median split needs log2(count) levels below; with separate groups, one more. The heuristic
    // may use the levels beyond that.
    const int needed = static_cast<int>(std::bit_width(count)) + 2;
    if (depth + needed < max_depth) {
      if (count <= width && b.mixed) {
        left = partition(first, count, [&](const Reference& r) { return r.group == group; }).left;
      } else {
        const Binning binning(b.centroids.box(), count);
        Bins bins(binning.bins);
        fill_bins(first, count, binning, bins);
        const Split split = best_split(bins, binning);
        if (std::isfinite(split.cost)) {
          const Halves halves = partition(first, count, [&](const Reference& r) {
            return static_cast<std::size_t>(
                       binning.bin(centroid(corner(r.min), corner(r.max)))[split.axis]) < split.bin;
          });
          left = halves.left;
          bounded = !b.mixed;
          for (std::size_t i = 0; i < binning.bins; i++)
            sides[i < split.bin ? 0 : 1].box.extend(bins.box(split.axis, i));
          for (std::size_t side = 0; side < 2; side++)
            sides[side].centroids = halves.centroids[side];
        }
      }
    }
    if (left == 0 ||
        left == count) {  // nothing tells them apart, or the depth is used up: halve the list
      left = count / 2;
      bounded = false;
    }
    if (!bounded) sides = {bounds(first, left), bounds(first + left, count - left)};

    const std::uint32_t children = next_.fetch_add(2);
    node.left = children;
    const auto go_left = [&] { build(children, first, left, depth + 1, sides[0]); };
    const auto go_right = [&] {
      build(children + 1, first + left, count - left, depth + 1, sides[1]);
    };
    if (count > parallel_threshold) {
      tbb::parallel_invoke(go_left, go_right);
    } else {
      go_left();
      go_right();
    }
  }

  // --- The upper levels of large trees ---

  /// A Cell holds the references whose centroids lie in one cell of the grid.
  struct Cell {
    LaneBox box;
    Float4 center;                       // of its centroids
    std::uint32_t first = 0, count = 0;  // of the references as they are sorted by cells
  };
  /// A Top is a node over cells whose own levels are built from references.
  struct Top {
    std::uint32_t node, first, count;
    int depth;
  };

  void build_by_cells(const Bounds& all) {
    sort_into_cells(all);
    cell_order_.resize(cells_.size());
    std::iota(cell_order_.begin(), cell_order_.end(), 0u);
    build_over_cells(0, 0, static_cast<std::uint32_t>(cells_.size()), 0, 0);
    // The order is that into which the splits have brought the cells.
    std::vector<std::uint32_t> to(cells_.size() + 1, 0);
    for (std::size_t i = 0; i < cells_.size(); i++)
      to[i + 1] = to[i] + cells_[cell_order_[i]].count;
    tbb::parallel_for(std::size_t{0}, cells_.size(), [&](std::size_t i) {
      const Cell& cell = cells_[cell_order_[i]];
      std::copy_n(scratch_.get() + cell.first, cell.count, tree_.items.data() + to[i]);
    });
    tbb::parallel_for(std::size_t{0}, tops_.size(), [&](std::size_t i) {
      const Top& top = tops_[i];
      build(top.node, top.first, top.count, top.depth, bounds(top.first, top.count));
    });
  }

  /// Sorts into scratch_, stable within a cell; empty cells are left out of cells_.
  void sort_into_cells(const Bounds& all) {
    const std::vector<Reference>& references = tree_.items;
    const std::uint32_t count = count_;
    const int bits = std::clamp(
        static_cast<int>(std::bit_width(count / cell_size_.references) - 1) / 3, 1, max_cell_bits);
    const Binning grid(all.centroids.box(), std::size_t{1} << bits);
    const std::uint32_t cell_count = 1u << (3 * bits);
    const std::uint32_t parts = std::min<std::uint32_t>(16, (count + chunk - 1) / chunk);
    const auto part_begin = [&](std::uint32_t p) {
      return static_cast<std::uint32_t>(std::uint64_t{count} * p / parts);
    };
    const auto keys = std::make_unique_for_overwrite<std::uint32_t[]>(count);
    std::vector<std::uint32_t> places(
        std::size_t{parts} * cell_count,
        0);  // of each part: references a cell, then where the next goes
    tbb::parallel_for(0u, parts, [&](std::uint32_t p) {
      std::uint32_t* counts = &places[std::size_t{p} * cell_count];
      for (std::uint32_t i = part_begin(p); i < part_begin(p + 1); i++) {
        const Int4 at = grid.bin(centroid(corner(references[i].min), corner(references[i].max)));
        // Cells that are close in space are nearly so in memory: interleaving the bits of the axes
        // would be closer, and slower.
        keys[i] = static_cast<std::uint32_t>((at[2] << bits | at[1]) << bits | at[0]);
        counts[keys[i]]++;
      }
    });
    std::uint32_t next = 0;
    for (std::uint32_t c = 0; c < cell_count; c++) {
      const std::uint32_t first = next;
      for (std::uint32_t p = 0; p < parts; p++)
        next += std::exchange(places[std::size_t{p} * cell_count + c], next);
      if (next == first) continue;
      Cell cell;
      cell.first = first;
      cell.count = next - first;
      cells_.push_back(cell);
    }
    tbb::parallel_for(0u, parts, [&](std::uint32_t p) {
      std::uint32_t* place = &places[std::size_t{p} * cell_count];
      for (std::uint32_t i = part_begin(p); i < part_begin(p + 1); i++) {
        Reference& to = scratch_[place[keys[i]]++];
        to = references[i];
        to.primitive = i;
      }
    });
    tbb::parallel_for(std::size_t{0}, cells_.size(), [&](std::size_t i) {
      Cell& cell = cells_[i];
      const Bounds b = bounds(std::span<const Reference>(scratch_.get() + cell.first, cell.count));
      cell.box = b.box;
      cell.center = centroid(b.centroids.min, b.centroids.max);
    });
  }

  /// Builds the node over cells [begin, end) of cell_order_, whose references begin at `first` of
  /// the items.
  void build_over_cells(std::uint32_t index, std::uint32_t begin, std::uint32_t end,
                        std::uint32_t first, int depth) {
    LaneBox box, centers;
    std::uint32_t count = 0;
    for (std::uint32_t i = begin; i < end; i++) {
      const Cell& cell = cells_[cell_order_[i]];
      box.extend(cell.box);
      centers.extend(cell.center, cell.center);
      count += cell.count;
    }
    const int needed = static_cast<int>(std::bit_width(count)) + 2;
    std::uint32_t middle = begin, left = 0;
    if (end - begin >= cell_size_.least && depth + needed < max_depth) {
      const Binning binning(centers.box(), count);
      Bins bins(binning.bins);
      for (std::uint32_t i = begin; i < end; i++) {
        const Cell& cell = cells_[cell_order_[i]];
        const Int4 bin = binning.bin(cell.center);
        for (std::size_t axis = 0; axis < 3; axis++)
          bins.extend(axis, static_cast<std::size_t>(bin[axis]), cell.box.min, cell.box.max,
                      cell.count);
      }
      const Split split = best_split(bins, binning);
      if (std::isfinite(split.cost)) {
        for (std::size_t b = 0; b < split.bin; b++) left += bins.count[split.axis][b];
        const auto at = std::stable_partition(
            cell_order_.begin() + begin, cell_order_.begin() + end, [&](std::uint32_t c) {
              return static_cast<std::size_t>(binning.bin(cells_[c].center)[split.axis]) <
                     split.bin;
            });
        middle = static_cast<std::uint32_t>(at - cell_order_.begin());
      }
    }
    if (middle == begin || middle == end) {
      tops_.push_back({index, first, count, depth});
      return;
    }
    const Box whole = box.box();
    const std::uint32_t children = next_.fetch_add(2);
    tree_.nodes[index] = {whole.min, whole.max, children, first, count};
    build_over_cells(children, begin, middle, first, depth + 1);
    build_over_cells(children + 1, middle, end, first + left, depth + 1);
  }

  BinaryTree& tree_;
  std::uint32_t count_;
  std::unique_ptr<Reference[]> scratch_;
  std::uint64_t single_groups_;
  Cells cell_size_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> cell_order_;
  std::vector<Top> tops_;
  std::atomic<std::uint32_t> next_ = 0;
};

}  // namespace

BinaryTree build_binary(std::vector<Reference> references, std::uint64_t single_groups,
                        Effort effort) {
  BinaryTree tree;
  tree.items = std::move(references);
  tree.nodes = std::make_unique_for_overwrite<BinaryNode[]>(2 * tree.items.size());
  Builder(tree, single_groups, effort).run();
  return tree;
}

}  // namespace caplet::bvh
