// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/cubic_chain.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace caplet {

using glm::dvec4;

namespace {

constexpr int deepest = 12;

}  // namespace

void CubicChain::start(const dvec4& p) {
  p_ = glm::vec3(p);
  radius_ = static_cast<float>(p.w);
}

void CubicChain::add(const CubicTube& c, double tolerance, double u0, double u1) {
  u_ = static_cast<float>(u0);
  add(Part{c, u0, u1}, tolerance, 0);
}

// With c(t) the curve and l(t) its chord, c - l = 3 t (1-t)^2 d1 + 3 t^2 (1-t) d2, where d1 and d2
// are the inner control points' offsets from a chord of uniform speed. The weights' sum 3 t (1-t)
// is at most 3/4. Each halving divides d1 and d2 by at least 4 in the limit: from the control
// points' diagonal D, 1e-5 D is reached in 9 to 10 halvings. Radii likewise.
void CubicChain::add(const Part& part, double tolerance, int depth) {
  const CubicTube& c = part.c;
  const dvec4 d1 = c[1] - (2.0 * c[0] + c[3]) / 3.0, d2 = c[2] - (c[0] + 2.0 * c[3]) / 3.0;
  const double apart = std::max(glm::length(glm::dvec3(d1)), glm::length(glm::dvec3(d2)));
  const double wider = std::max(std::abs(d1.w), std::abs(d2.w));
  if (depth == deepest || 0.75 * (apart + wider) <= tolerance) return add_chord(c[3], part.u1);
  const dvec4 a = (c[0] + c[1]) / 2.0, m = (c[1] + c[2]) / 2.0, b = (c[2] + c[3]) / 2.0;
  const dvec4 left = (a + m) / 2.0, right = (m + b) / 2.0, middle = (left + right) / 2.0;
  const double u = 0.5 * (part.u0 + part.u1);
  add(Part{{c[0], a, left, middle}, part.u0, u}, tolerance, depth + 1);
  add(Part{{middle, right, b, c[3]}, u, part.u1}, tolerance, depth + 1);
}

void CubicChain::add_chord(const dvec4& to, double u) {
  const glm::vec3 p(to);
  const auto r = static_cast<float>(std::max(to.w, 0.0));  // rounding may leave a value below 0
  if (p == p_ && r == radius_ && !out_.p0.empty()) return;
  out_.p0.push_back(p_);
  out_.p1.push_back(p);
  out_.radius0.push_back(radius_);
  out_.radius1.push_back(r);
  out_.u.emplace_back(u_, static_cast<float>(u));
  p_ = p;
  radius_ = r;
  u_ = out_.u.back().y;
}

}  // namespace caplet
