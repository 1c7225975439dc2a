// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "verify/statistics.h"

#include <algorithm>
#include <cmath>

namespace caplet::verify {

void Distribution::add(double value) {
  const double at = value > 0 ? (std::log2(value) - lowest) * steps : -1;
  const double last = static_cast<double>(counts_.size() - 1);
  ++counts_[static_cast<std::size_t>(std::clamp(at + 1, 0.0, last))];
  ++count_;
  worst_ = std::max(worst_, value);
}

void Distribution::add(const Distribution& other) {
  for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
  count_ += other.count_;
  worst_ = std::max(worst_, other.worst_);
}

double Distribution::percentile(double share) const {
  const double wanted = share * static_cast<double>(count_);
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    sum += counts_[i];
    if (sum > 0 && static_cast<double>(sum) >= wanted)
      return i == 0 ? 0
             : i + 1 == counts_.size()
                 ? worst_
                 : std::min(worst_, std::exp2(static_cast<double>(i) / steps + lowest));
  }
  return 0;
}

double KindStatistics::worst() const {
  double out = 0;
  for (const Quantity& q : quantities) out = std::max(out, q.in_bounds.worst());
  return out;
}

void KindStatistics::add(const KindStatistics& other) {
  rays += other.rays;
  hits += other.hits;
  grazed += other.grazed;
  disagreements += other.disagreements;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    quantities[i].in_bounds.add(other.quantities[i].in_bounds);
    quantities[i].in_ulps.add(other.quantities[i].in_ulps);
  }
}

Statistics::Statistics() : kinds(reference::kind_names.size()) {}

void Statistics::add(const Statistics& other) {
  rays += other.rays;
  hits += other.hits;
  disagreements += other.disagreements;
  for (std::size_t i = 0; i < faults.size(); ++i) faults[i] += other.faults[i];
  for (std::size_t i = 0; i < family_rays.size(); ++i) {
    family_rays[i] += other.family_rays[i];
    family_disagreements[i] += other.family_disagreements[i];
  }
  for (std::size_t i = 0; i < kinds.size(); ++i) kinds[i].add(other.kinds[i]);
}

double Statistics::worst() const {
  double out = 0;
  for (const KindStatistics& kind : kinds) out = std::max(out, kind.worst());
  return out;
}

}  // namespace caplet::verify
