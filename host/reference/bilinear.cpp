// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Bilinear patches: the point nearest to x by a search over the rulings of either family, each a segment.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "parts.h"

namespace caplet::reference {

namespace {

using glm::dvec2;
using glm::dvec3;

struct Nearest {
  double distance = HUGE_VAL;
  dvec2 uv{0};
};

Nearest nearest_on_ruling(const Bilinear& b, double u, const dvec3& x) {
  const dvec3 a = b.p00 + u * (b.p10 - b.p00), c = b.p01 + u * (b.p11 - b.p01), ruling = c - a;
  const double squared = glm::dot(ruling, ruling);
  const double v = squared > 0 ? std::clamp(glm::dot(x - a, ruling) / squared, 0.0, 1.0) : 0.0;
  return {glm::length(x - (a + v * ruling)), {u, v}};
}

/// The least of what rulings between two u have, by golden sections, where it is the only minimum.
Nearest least_between(const Bilinear& b, double low, double high, const dvec3& x) {
  constexpr double golden = 0.6180339887498949;
  double left = high - golden * (high - low), right = low + golden * (high - low);
  double at_left = nearest_on_ruling(b, left, x).distance, at_right = nearest_on_ruling(b, right, x).distance;
  while (high - low > 1e-16 && low < left && left < right && right < high) {
    if (at_left <= at_right) {
      high = right;
      right = left;
      at_right = at_left;
      left = high - golden * (high - low);
      at_left = nearest_on_ruling(b, left, x).distance;
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = low + golden * (high - low);
      at_right = nearest_on_ruling(b, right, x).distance;
    }
  }
  Nearest best;
  for (const double u : {low, high, 0.5 * (low + high)})
    if (const Nearest found = nearest_on_ruling(b, u, x); found.distance < best.distance) best = found;
  return best;
}

Nearest nearest_by_u(const Bilinear& b, const dvec3& x) {
  // The squared distance to the ruling's line is a rational function of u of low degree: it has few minima. Where the ruling's
  // ends clamp, two may lie close together: 256 samples, and the other family, part them. No ruling moves faster than its ends,
  // so most of 16 coarse cells are seen to hold nothing less and are not sampled.
  constexpr int coarse = 16, fine = 16;
  const double speed = std::max(glm::length(b.p10 - b.p00), glm::length(b.p11 - b.p01));
  double at[coarse + 1], least = HUGE_VAL;
  for (int i = 0; i <= coarse; ++i) least = std::min(least, at[i] = nearest_on_ruling(b, double(i) / coarse, x).distance);
  Nearest best;
  for (int i = 0; i < coarse; ++i) {
    if (0.5 * (at[i] + at[i + 1] - speed / coarse) > std::min(least, best.distance)) continue;
    double within[fine + 1];
    for (int k = 0; k <= fine; ++k) within[k] = nearest_on_ruling(b, (i + double(k) / fine) / coarse, x).distance;
    for (int k = 0; k <= fine; ++k) {
      if ((k > 0 && within[k - 1] < within[k]) || (k < fine && within[k + 1] < within[k])) continue;
      if (within[k] - speed / (coarse * fine) > best.distance) continue;
      const Nearest found =
          least_between(b, std::max(0.0, (i + (k - 1.0) / fine) / coarse), std::min(1.0, (i + (k + 1.0) / fine) / coarse), x);
      if (found.distance < best.distance) best = found;
    }
  }
  return best;
}

Nearest nearest_of(const Bilinear& b, const dvec3& x) {
  const Nearest by_u = nearest_by_u(b, x);
  const Nearest by_v = nearest_by_u({b.p00, b.p01, b.p10, b.p11}, x);
  return by_u.distance <= by_v.distance ? by_u : Nearest{by_v.distance, {by_v.uv.y, by_v.uv.x}};
}

}  // namespace

double value_of(const Bilinear& b, const dvec3& x) { return nearest_of(b, x).distance; }

dvec2 parameters_of(const Bilinear& b, const dvec3& x) {
  dvec2 uv = nearest_of(b, x).uv;
  // Where the distance has its minimum the search knows the parameters to the root of its precision; two steps of Gauss and
  // Newton bring the rest.
  const dvec3 twist = b.p11 - b.p01 - b.p10 + b.p00;
  for (int i = 0; i < 2; ++i) {
    const dvec3 du = b.p10 - b.p00 + uv.y * twist, dv = b.p01 - b.p00 + uv.x * twist;
    const dvec3 left = x - (b.p00 + uv.x * du + uv.y * (b.p01 - b.p00));
    const double uu = glm::dot(du, du), vv = glm::dot(dv, dv), mixed = glm::dot(du, dv);
    const double determinant = uu * vv - mixed * mixed;
    if (!(determinant > 1e-12 * uu * vv)) break;
    const double a = glm::dot(left, du), c = glm::dot(left, dv);
    uv = glm::clamp(uv + dvec2(a * vv - c * mixed, c * uu - a * mixed) / determinant, 0.0, 1.0);
  }
  return uv;
}

dvec3 normal_of(const Bilinear& b, const dvec3& x) {
  const dvec2 uv = nearest_of(b, x).uv;
  const dvec3 du = (1 - uv.y) * (b.p10 - b.p00) + uv.y * (b.p11 - b.p01);
  const dvec3 dv = (1 - uv.x) * (b.p01 - b.p00) + uv.x * (b.p11 - b.p10);
  return glm::normalize(glm::cross(du, dv));
}

}  // namespace caplet::reference
