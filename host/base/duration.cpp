// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/duration.h"

#include <charconv>
#include <cmath>

namespace caplet {

std::optional<double> seconds_of(std::string_view text) {
  constexpr std::string_view units = "hms";
  constexpr double seconds[] = {3600, 60, 1};
  const char *at = text.data(), *const end = text.data() + text.size();
  double sum = 0;
  std::size_t next_unit = 0;
  while (at != end) {
    double value = 0;
    const auto [last, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !(value >= 0)) return {};
    if (last == end) {  // a number alone
      if (at != text.data()) return {};
      sum = value;
      break;
    }
    const std::size_t unit = units.find(*last);
    if (unit == units.npos || unit < next_unit) return {};
    sum += value * seconds[unit];
    next_unit = unit + 1;
    at = last + 1;
  }
  if (!(sum > 0) || !std::isfinite(sum)) return {};
  return sum;
}

}  // namespace caplet
