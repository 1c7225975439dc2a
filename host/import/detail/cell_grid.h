// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Points in cells, whose neighbours are found in time proportional to their number.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace caplet {

/// Cells of one size, sorted by their keys: by x, then y, then z.
class CellGrid {
 public:
  /// `size`: the edge of a cell, in the unit of the points.
  CellGrid(std::span<const glm::vec3> points, float size) {
    glm::vec3 low(std::numeric_limits<float>::infinity());
    for (const glm::vec3& point : points) low = glm::min(low, point);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      std::array<std::int64_t, 3> at{};
      for (int axis = 0; axis < 3; ++axis)
        at.at(static_cast<std::size_t>(axis)) =
            std::min(static_cast<std::int64_t>((points[i][axis] - low[axis]) / size), most_cells) +
            1;
      keys[i] = {key_of(at[0], at[1], at[2]), i};
    }
    std::ranges::sort(keys);
    order_.reserve(keys.size());
    for (const auto& [key, point] : keys) {
      if (cells_.empty() || cells_.back().key != key)
        cells_.push_back({key, static_cast<std::uint32_t>(order_.size()),
                          static_cast<std::uint32_t>(order_.size())});
      order_.push_back(point);
      ++cells_.back().end;
    }
  }

  /// Returns the number of points in the fullest cell.
  std::size_t fullest() const {
    std::size_t most = 0;
    for (const Cell& cell : cells_) most = std::max<std::size_t>(most, cell.end - cell.begin);
    return most;
  }

  /// Calls work(i, j) once for each pair of points in one cell or in two neighbouring cells.
  template <class Work>
  void pairs(const Work& work) const {
    // Offsets of the keys of the neighbouring columns that come "after" this one; each has three
    // neighbours along z.
    constexpr std::uint64_t y = std::uint64_t{1} << 21, x = y << 21;
    constexpr std::array<std::uint64_t, 4> columns = {y, x - y, x, x + y};
    std::array<std::size_t, 4>
        from{};  // cells before these indices precede the column's first; the indices only increase
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      const Cell& cell = cells_[c];
      for (std::uint32_t i = cell.begin; i < cell.end; ++i)
        for (std::uint32_t j = i + 1; j < cell.end; ++j) work(order_[i], order_[j]);
      if (c + 1 < cells_.size() && cells_[c + 1].key == cell.key + 1)
        across(cell, cells_[c + 1], work);
      for (std::size_t k = 0; k < columns.size(); ++k) {
        const std::uint64_t first = cell.key + columns.at(k) - 1;
        std::size_t& at = from.at(k);
        while (at < cells_.size() && cells_[at].key < first) ++at;
        for (std::size_t d = at; d < cells_.size() && cells_[d].key <= first + 2; ++d)
          across(cell, cells_[d], work);
      }
    }
  }

 private:
  static constexpr std::int64_t most_cells = 1 << 20;  // along an axis: points further out share a
                                                       // cell, and are compared like all others

  struct Cell {
    std::uint64_t key = 0;
    std::uint32_t begin = 0, end = 0;  // a range of `order_`
  };

  static std::uint64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z) {
    constexpr int bits = 21;
    return static_cast<std::uint64_t>(x) << 2 * bits | static_cast<std::uint64_t>(y) << bits |
           static_cast<std::uint64_t>(z);
  }

  template <class Work>
  void across(const Cell& a, const Cell& b, const Work& work) const {
    for (std::uint32_t i = a.begin; i < a.end; ++i)
      for (std::uint32_t j = b.begin; j < b.end; ++j) work(order_[i], order_[j]);
  }

  std::vector<std::uint32_t> order_;
  std::vector<Cell> cells_;
};

}  // namespace caplet
