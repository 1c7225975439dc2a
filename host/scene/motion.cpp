// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/motion.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "base/check.h"

namespace caplet {

namespace {

using glm::dmat3;
using glm::dquat;

dquat quaternion_of(const std::array<double, 4>& q) { return {q[0], q[1], q[2], q[3]}; }

/// Returns the rotation of the polar decomposition of `m`, whose determinant is positive: the
/// average of a matrix and its inverse transpose, again and again (Higham 1986).
dmat3 rotation_of(const dmat3& m) {
  // Each step halves a large scale; from near 1 on digits double.
  constexpr int most_steps = 100;
  dmat3 r = m;
  for (int step = 0; step < most_steps; ++step) {
    const dmat3 next = 0.5 * (r + glm::transpose(glm::inverse(r)));
    double change = 0;
    for (int k = 0; k < 3; ++k) change = std::max(change, glm::length(next[k] - r[k]));
    r = next;
    if (change < 1e-14) break;
  }
  return r;
}

}  // namespace

AnimatedTransform::AnimatedTransform(const TransformKeys& keys, const glm::dvec3& pivot)
    : pivot_(pivot) {
  CHECK_LE_(std::size_t{1}, keys.size());
  for (const TransformKey& key : keys) {
    const dmat3 m(key.matrix);
    const double sign = glm::determinant(m) < 0 ? -1 : 1;
    const dmat3 rotation = rotation_of(sign * m);
    dquat q = glm::normalize(glm::quat_cast(rotation));
    if (!keys_.empty() && glm::dot(quaternion_of(keys_.back().rotation), q) < 0) q = -q;
    keys_.push_back({key.time,
                     glm::dvec3(key.matrix[3]) + m * pivot,
                     {q.w, q.x, q.y, q.z},
                     glm::transpose(glm::mat3_cast(q)) * m});
  }
}

glm::dmat4 AnimatedTransform::at(double time) const {
  const auto after = std::upper_bound(keys_.begin() + 1, keys_.end() - (keys_.size() > 1 ? 1 : 0),
                                      time, [](double t, const Key& key) { return t < key.time; });
  const auto i = static_cast<std::size_t>(after - keys_.begin()) - 1;
  const Key& a = keys_[i];
  const Key& b = keys_[std::min(i + 1, keys_.size() - 1)];
  const double length = b.time - a.time,
               u = length > 0 ? std::clamp((time - a.time) / length, 0.0, 1.0) : 0;
  const dquat qa = quaternion_of(a.rotation), qb = quaternion_of(b.rotation);
  // A half angle from its sine and cosine is exact for small ones too.
  const double half = std::atan2(glm::length(qb - qa), glm::length(qb + qa)),  // of the angle of 4D
      sine = std::sin(2 * half);
  const dquat q = glm::normalize(sine > 1e-9 ? std::sin((1 - u) * 2 * half) / sine * qa +
                                                   std::sin(u * 2 * half) / sine * qb
                                             : (1 - u) * qa + u * qb);
  const dmat3 linear = glm::mat3_cast(q) * ((1 - u) * a.stretch + u * b.stretch);
  glm::dmat4 out(linear);
  out[3] = glm::dvec4((1 - u) * a.translation + u * b.translation - linear * pivot_, 1);
  return out;
}

void move(TransformKeys& keys, const glm::dmat4& matrix) {
  for (TransformKey& key : keys) key.matrix = matrix * key.matrix;
}

}  // namespace caplet
