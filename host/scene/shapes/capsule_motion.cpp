// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/shapes/capsule_motion.h"

#include <algorithm>

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
CapsulesShape rounded_at(const CapsulesShape& of, const BetweenKeys& place) {
  if (place.share == 0) return at_key(of, place.before);
  return between(at_key(of, place.before), at_key(of, place.after), rounded_between(place.share));
}

CapsulesShape with_rest(CapsulesShape ends, const CapsulesShape& of) {
  ends.materials = of.materials;
  ends.u = of.u;
  if (ends.radius1 == ends.radius0) ends.radius1.clear();
  return ends;
}

}  // namespace

bool add_key(CapsulesShape& capsules, std::size_t keys, CapsulesShape next) {
  if (capsules.p0.size() != keys * next.p0.size() ||
      capsules.materials.size() != next.materials.size() || capsules.u.size() != next.u.size())
    return false;
  for (CapsulesShape* one : {&capsules, &next})
    if (one->radius1.empty()) one->radius1 = one->radius0;
  const auto append = [](auto& to, const auto& more) {
    to.insert(to.end(), more.begin(), more.end());
  };
  append(capsules.p0, next.p0);
  append(capsules.p1, next.p1);
  append(capsules.radius0, next.radius0);
  append(capsules.radius1, next.radius1);
  if (capsules.radius1 == capsules.radius0) capsules.radius1.clear();
  return true;
}

CapsulesShape at_time(const CapsulesShape& capsules, double time) {
  return with_rest(rounded_at(capsules, between_keys(capsules.times, time)), capsules);
}

CapsuleMotion::CapsuleMotion(const CapsulesShape& capsules, double open, double open_time)
    : capsules_(capsules), times_(capsules.times, open, open_time) {
  for (const BetweenKeys& key : times_.keys()) keys_.push_back(rounded_at(capsules, key));
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
  const ShutterKeys::Place place = times_.at(time);
  return with_rest(between(keys_[place.segment], keys_[place.segment + 1], fused_between(place.u)),
                   capsules_);
}

}  // namespace caplet
