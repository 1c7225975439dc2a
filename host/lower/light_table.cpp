// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/light_table.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/check.h"

namespace caplet {

namespace {

constexpr std::uint64_t numbers = std::uint64_t{1} << 32;  // random numbers there are

/// Returns the probabilities that are wanted, before they are made whole numbers; zeros when no
/// light has power.
std::vector<double> wanted_chances(const std::vector<LightShare>& lights) {
  double total = 0;
  std::map<std::uint32_t, double> groups;
  for (const LightShare& light : lights)
    if (light.power > 0) {
      total += light.power;
      groups[light.group] += light.power;
    }
  std::vector<double> chances;
  chances.reserve(lights.size());
  for (const LightShare& light : lights)
    chances.push_back(light.power > 0
                          ? 0.5 * light.power / total + 0.5 * (light.power / groups[light.group]) /
                                                            static_cast<double>(groups.size())
                          : 0);
  return chances;
}

/// Returns how many of `units` each light gets: their sum is `units`, and every light with a
/// probability gets at least one.
std::vector<std::uint64_t> whole_shares(const std::vector<double>& chances, std::uint64_t units) {
  std::vector<std::uint64_t> counts;
  std::uint64_t sum = 0;
  for (const double chance : chances) {
    counts.push_back(chance > 0
                         ? std::max<std::uint64_t>(
                               1, static_cast<std::uint64_t>(chance * static_cast<double>(units)))
                         : 0);
    sum += counts.back();
  }
  if (sum == 0) return counts;
  while (sum != units)
    for (std::uint64_t& count : counts) {
      if (sum < units && count > 0) {
        ++count;
        ++sum;
      } else if (sum > units && count > 1) {
        --count;
        --sum;
      }
    }
  return counts;
}

}  // namespace

std::vector<AliasRecord> light_table(const std::vector<LightShare>& lights) {
  const std::size_t n = lights.size();
  const std::uint64_t unit = n <= 65536 ? 256 : 1;
  std::vector<std::uint64_t> counts = whole_shares(wanted_chances(lights), numbers / unit);
  std::vector<AliasRecord> table(n, AliasRecord{});
  // Number u falls into row u n >> 32: the row's numbers are those from first(i) on, and `keep` is
  // compared with the low half of u n.
  const auto first = [n](std::uint64_t i) { return (i * numbers + n - 1) / n; };
  const auto size = [&](std::uint64_t i) { return first(i + 1) - first(i); };
  std::vector<std::size_t> less, more;
  for (std::size_t i = 0; i < n; ++i) {
    counts[i] *= unit;
    table[i].probability =
        static_cast<float>(static_cast<double>(counts[i]) / static_cast<double>(numbers));
    table[i].keep = 0xffffffffu;
    table[i].alias = narrow<uint>(i);
    (counts[i] < size(i) ? less : more).push_back(i);
  }
  while (!less.empty() && !more.empty()) {
    const std::size_t row = less.back(), donor = more.back();
    less.pop_back();
    table[row].keep = narrow<uint>(first(row) * n - row * numbers + counts[row] * n);
    table[row].alias = narrow<uint>(donor);
    counts[donor] -= size(row) - counts[row];
    if (counts[donor] < size(donor)) {
      more.pop_back();
      less.push_back(donor);
    }
  }
  return table;
}

}  // namespace caplet
