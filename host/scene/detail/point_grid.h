// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Points in cells, to find those that are near a place.
#pragma once

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <utility>
#include <vector>

#include "scene/bounds.h"

namespace caplet {

/// Points sorted by cubic cells.
class PointGrid {
 public:
  /// Points at most `reach` apart, which is positive, are to be found.
  PointGrid(std::span<const glm::dvec3> points, double reach) {
    Bounds box;
    for (const glm::dvec3& p : points) box.extend(p);
    if (points.empty()) box.extend(glm::dvec3(0));
    const glm::dvec3 size = box.max - box.min;
    // A cell is larger than the reach by more than the quotients' roundings, and there are at most
    // 2^20 along an axis, so that three numbers fit a key.
    cell_ = 1.000001 * std::max({reach, size.x * 0x1p-20, size.y * 0x1p-20, size.z * 0x1p-20});
    origin_ = box.min;
    points_.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      points_.emplace_back(key_of(cell_of(points[i])), static_cast<std::uint32_t>(i));
    tbb::parallel_sort(points_.begin(), points_.end());
  }

  /// Calls `found` with the numbers of at least the points within reach of one of the points.
  template <class Found>
  void near(const glm::dvec3& p, const Found& found) const {
    const Cell at = cell_of(p);
    for (std::uint64_t x = at.x - 1; x <= at.x + 1; ++x)
      for (std::uint64_t y = at.y - 1; y <= at.y + 1; ++y) {
        const std::uint64_t last = key_of({x, y, at.z + 1});
        auto entry = std::lower_bound(points_.begin(), points_.end(),
                                      std::pair(key_of({x, y, at.z - 1}), std::uint32_t{0}));
        for (; entry != points_.end() && entry->first <= last; ++entry) found(entry->second);
      }
  }

 private:
  struct Cell {
    std::uint64_t x, y, z;
  };
  Cell cell_of(const glm::dvec3& p) const {
    const glm::dvec3 cell = glm::floor((p - origin_) / cell_) + 1.0;
    return {static_cast<std::uint64_t>(cell.x), static_cast<std::uint64_t>(cell.y),
            static_cast<std::uint64_t>(cell.z)};
  }
  static std::uint64_t key_of(const Cell& cell) { return cell.x << 42 | cell.y << 21 | cell.z; }

  double cell_;
  glm::dvec3 origin_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> points_;
};

}  // namespace caplet
