// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/shapes/shutter_keys.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace caplet {

bool check_key_times(const std::vector<double>& times, std::size_t points, ShapeCheck& report) {
  if (times.empty()) return true;
  if (times.size() < 2)
    report.error("a shape that moves needs two times or more");
  else if (!std::ranges::all_of(times, [](double time) { return std::isfinite(time); }) ||
           std::ranges::adjacent_find(times, std::greater_equal()) != times.end())
    report.error("the times of a shape that moves must be finite and rise");
  else if (points % times.size() != 0)
    report.error("a shape that moves needs as many points at each of its times");
  else
    return true;
  return false;
}

BetweenKeys between_keys(const std::vector<double>& times, double time) {
  const std::size_t last = times.size() - 1;
  if (!(time > times.front())) return {0, 0, 0};
  if (!(time < times.back())) return {last, last, 0};
  const auto after = static_cast<std::size_t>(std::ranges::upper_bound(times, time) -
                                              times.begin());  // times[after - 1] <= time
  return {after - 1, after, (time - times[after - 1]) / (times[after] - times[after - 1])};
}

ShutterKeys::ShutterKeys(const std::vector<double>& times, double open, double open_time) {
  std::vector<double> ends{0};
  keys_.push_back(between_keys(times, open));
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double time = (times[i] - open) / open_time;
    // As floats, segments have a length.
    if (static_cast<float>(time) <= static_cast<float>(ends.back()) ||
        static_cast<float>(time) >= 1)
      continue;
    ends.push_back(time);
    keys_.push_back({i, i, 0});
  }
  ends.push_back(1);
  keys_.push_back(between_keys(times, open + open_time));
  for (std::size_t i = 1; i < ends.size(); ++i) {
    pairs_.push_back(static_cast<float>(ends[i - 1]));
    pairs_.push_back(static_cast<float>(1 / (ends[i] - ends[i - 1])));
  }
}

ShutterKeys::Place ShutterKeys::at(float time) const {
  std::size_t segment = 0;
  while (segment + 1 < segments() && pairs_[2 * segment + 2] <= time) ++segment;
  return {segment, std::min((time - pairs_[2 * segment]) * pairs_[2 * segment + 1], 1.0f)};
}

}  // namespace caplet
