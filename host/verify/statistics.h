// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Counts and distributions that many threads collect and that are then added up.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "verify/compare.h"
#include "verify/rays.h"

namespace caplet::verify {

/// A distribution of numbers >= 0, stored logarithmically: percentiles are within 5 %.
class Distribution {
 public:
  void add(double value);
  void add(const Distribution& other);
  std::uint64_t count() const { return count_; }
  double worst() const { return worst_; }
  /// Returns the value that a share of 0 to 1 of all do not exceed; 0 when there are none.
  double percentile(double share) const;

 private:
  static constexpr int steps = 16, lowest = -40, highest = 24;          // octaves, in steps
  std::array<std::uint64_t, (highest - lowest) * steps + 2> counts_{};  // first: below; last: above
  std::uint64_t count_ = 0;
  double worst_ = 0;
};

/// The counts for one kind of shape.
struct KindStatistics {
  std::uint64_t rays = 0;    // rays whose line hits the ball of a primitive of this kind
  std::uint64_t hits = 0;    // crossings that were compared
  std::uint64_t grazed = 0;  // rays that graze one: both answers are right
  std::uint64_t disagreements = 0;
  struct Quantity {
    Distribution in_bounds, in_ulps;
  };
  std::array<Quantity, quantity_names.size()> quantities;
  double worst() const;  // of all quantities, in bounds
  void add(const KindStatistics& other);
};

struct Statistics {
  std::uint64_t rays = 0, hits = 0;  // rays; those whose nearest crossing was found
  std::uint64_t disagreements = 0;   // rays with at least one
  std::array<std::uint64_t, fault_names.size()> faults{};
  std::array<std::uint64_t, family_names.size()> family_rays{}, family_disagreements{};
  std::vector<KindStatistics> kinds;  // in the order of reference::kind_names
  Statistics();
  void add(const Statistics& other);
  double worst() const;
};

}  // namespace caplet::verify
