// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/shapes/capsule_motion.h"

#include <algorithm>
#include <cmath>

namespace caplet {

namespace {

/// Returns the capsules of one of their times, without materials and u.
CapsulesShape at_key(const CapsulesShape& of, std::size_t key) {
  const std::size_t count = count_of(of);
  const auto part = [&](const auto& list) {
    const auto begin = list.begin() + static_cast<std::ptrdiff_t>(key * count);
    return std::remove_cvref_t<decltype(list)>(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  return {part(of.p0),
          part(of.p1),
          part(of.radius0),
          part(of.radius1.empty() ? of.radius0 : of.radius1),
          {}};
}

/// Returns a + u (b - a) of all ends and radii. `mix` does it for two floats.
template <class Mix>
CapsulesShape between(const CapsulesShape& a, const CapsulesShape& b, const Mix& mix) {
  CapsulesShape out = a;
  for (std::size_t i = 0; i < a.p0.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      out.p0[i][k] = mix(a.p0[i][k], b.p0[i][k]);
      out.p1[i][k] = mix(a.p1[i][k], b.p1[i][k]);
    }
    out.radius0[i] = mix(a.radius0[i], b.radius0[i]);
    out.radius1[i] = mix(a.radius1[i], b.radius1[i]);
  }
  return out;
}

/// Interpolates in double and rounds once.
CapsulesShape rounded_at(const CapsulesShape& of, double time) {
  const std::vector<double>& times = of.times;
  if (!(time > times.front())) return at_key(of, 0);
  if (!(time < times.back())) return at_key(of, times.size() - 1);
  const auto after = static_cast<std::size_t>(std::ranges::upper_bound(times, time) -
                                              times.begin());  // times[after - 1] <= time
  const double u = (time - times[after - 1]) / (times[after] - times[after - 1]);
  if (u == 0) return at_key(of, after - 1);
  return between(at_key(of, after - 1), at_key(of, after), [u](float a, float b) {
    return static_cast<float>(double{a} + u * (double{b} - double{a}));
  });
}

CapsulesShape with_rest(CapsulesShape ends, const CapsulesShape& of) {
  ends.materials = of.materials;
  ends.u = of.u;
  if (ends.radius1 == ends.radius0) ends.radius1.clear();
  return ends;
}

}  // namespace

CapsulesShape at_time(const CapsulesShape& capsules, double time) {
  return with_rest(rounded_at(capsules, time), capsules);
}

CapsuleMotion::CapsuleMotion(const CapsulesShape& capsules, double open, double open_time)
    : capsules_(capsules) {
  std::vector<double> ends{0};
  keys_.push_back(rounded_at(capsules, open));
  for (std::size_t i = 0; i < capsules.times.size(); ++i) {
    const double time = (capsules.times[i] - open) / open_time;
    // As floats, segments have a length.
    if (static_cast<float>(time) <= static_cast<float>(ends.back()) ||
        static_cast<float>(time) >= 1)
      continue;
    ends.push_back(time);
    keys_.push_back(at_key(capsules, i));
  }
  ends.push_back(1);
  keys_.push_back(rounded_at(capsules, open + open_time));
  for (std::size_t i = 1; i < ends.size(); ++i) {
    pairs_.push_back(static_cast<float>(ends[i - 1]));
    pairs_.push_back(static_cast<float>(1 / (ends[i] - ends[i - 1])));
  }
}

bool CapsuleMotion::rests() const {
  return std::ranges::all_of(keys_, [&](const CapsulesShape& key) {
    return key.p0 == keys_[0].p0 && key.p1 == keys_[0].p1 && key.radius0 == keys_[0].radius0 &&
           key.radius1 == keys_[0].radius1;
  });
}

std::array<float, 8> CapsuleMotion::key(std::size_t capsule, std::size_t key) const {
  const CapsulesShape& of = keys_.at(key);
  const glm::vec3 &p0 = of.p0.at(capsule), &p1 = of.p1[capsule];
  return {p0.x, p0.y, p0.z, of.radius0[capsule], p1.x, p1.y, p1.z, of.radius1[capsule]};
}

CapsulesShape CapsuleMotion::at(float time) const {
  std::size_t segment = 0;
  while (segment + 1 < segments() && pairs_[2 * segment + 2] <= time) ++segment;
  const float u = std::min((time - pairs_[2 * segment]) * pairs_[2 * segment + 1], 1.0f);
  return with_rest(between(keys_[segment], keys_[segment + 1],
                           [u](float a, float b) { return std::fma(u, b - a, a); }),
                   capsules_);
}

}  // namespace caplet
