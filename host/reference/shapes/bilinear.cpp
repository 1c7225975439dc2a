// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds the point of a bilinear patch nearest to x by the rulings of either family, each a segment.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "reference/detail/angles.h"
#include "reference/detail/parts.h"

namespace caplet::reference {

using glm::dvec2;
using glm::dvec3;

namespace {

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

/// Polynomial has degree N, the constant first.
template <int N>
using Polynomial = std::array<double, N + 1>;

template <int N>
double at(const Polynomial<N>& p, double x) {
  double out = p[N];
  for (int i = N - 1; i >= 0; --i) out = out * x + p[static_cast<std::size_t>(i)];
  return out;
}

/// Adds where p changes sign within [0, 1], and where its derivatives do: between those p is
/// monotone.
template <int N>
void add_roots(const Polynomial<N>& p, std::vector<double>& out) {
  if constexpr (N > 1) {
    Polynomial<N - 1> derivative;
    for (int i = 0; i < N; ++i)
      derivative[static_cast<std::size_t>(i)] = (i + 1) * p[static_cast<std::size_t>(i) + 1];
    add_roots<N - 1>(derivative, out);
  }
  std::ranges::sort(out);
  const std::size_t stations = out.size();
  for (std::size_t i = 0; i <= stations; ++i) {
    double low = i == 0 ? 0 : out[i - 1], high = i == stations ? 1 : out[i];
    const bool positive = at<N>(p, low) > 0;
    if (positive == (at<N>(p, high) > 0)) continue;
    for (;;) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      ((at<N>(p, middle) > 0) == positive ? low : high) = middle;
    }
    out.push_back(0.5 * (low + high));
  }
}

/// Returns the nearest of two sets of points: those nearest on the line of their ruling, and those
/// of the edges that are rulings. The squared distance from x to the line of a ruling is |(a - x) x
/// r|^2 / |r|^2 with a and r linear in u, a quartic over a quadratic: its extremes are the roots of
/// a quintic.
Nearest nearest_by_u(const Bilinear& b, const dvec3& x) {
  const dvec3 a0 = b.p00 - x, a1 = b.p10 - b.p00, r0 = b.p01 - b.p00, r1 = (b.p11 - b.p10) - r0;
  const dvec3 c0 = glm::cross(a0, r0), c1 = glm::cross(a0, r1) + glm::cross(a1, r0),
              c2 = glm::cross(a1, r1);
  const Polynomial<4> n = {glm::dot(c0, c0), 2 * glm::dot(c0, c1),
                           glm::dot(c1, c1) + 2 * glm::dot(c0, c2), 2 * glm::dot(c1, c2),
                           glm::dot(c2, c2)};
  const Polynomial<2> d = {glm::dot(r0, r0), 2 * glm::dot(r0, r1), glm::dot(r1, r1)};
  Polynomial<5> slope{};  // n' d - n d'
  for (std::size_t i = 0; i <= 4; ++i)
    for (std::size_t k = 0; k <= 2; ++k)
      if (i + k > 0)
        slope[i + k - 1] += (static_cast<double>(i) - static_cast<double>(k)) * n[i] * d[k];
  // Where rounding merges two roots, a root of the derivative is as near.
  std::vector<double> candidates;
  add_roots<5>(slope, candidates);
  candidates.push_back(0);
  candidates.push_back(1);
  Nearest best;
  for (const double u : candidates)
    if (const Nearest found = nearest_on_ruling(b, u, x); found.distance < best.distance)
      best = found;
  return best;
}

/// Returns the patch's point nearest to x. It lies on an edge, which is a ruling of one family, or
/// is nearest on both its rulings.
Nearest nearest_of(const Bilinear& b, const dvec3& x) {
  const Nearest by_u = nearest_by_u(b, x);
  const Nearest by_v = nearest_by_u({b.p00, b.p01, b.p10, b.p11}, x);
  return by_u.distance <= by_v.distance ? by_u : Nearest{by_v.distance, {by_v.uv.y, by_v.uv.x}};
}

}  // namespace

double value_of(const Bilinear& b, const dvec3& x) { return nearest_of(b, x).distance; }

dvec2 parameters_of(const Bilinear& b, const dvec3& x) {
  dvec2 uv = nearest_of(b, x).uv;
  // A search for a minimum finds parameters only to the square root of the distance's precision;
  // two Gauss-Newton steps find the rest.
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

dvec3 sheet_normal(const Bilinear& b, const dvec3& x) {
  const dvec2 uv = nearest_of(b, x).uv;
  const dvec3 du = (1 - uv.y) * (b.p10 - b.p00) + uv.y * (b.p11 - b.p01);
  const dvec3 dv = (1 - uv.x) * (b.p01 - b.p00) + uv.x * (b.p11 - b.p10);
  return glm::normalize(glm::cross(du, dv));
}

bool has_inside(const Bilinear&) { return false; }

Ball ball_of(const Bilinear& b) {
  const dvec3 center = 0.25 * (b.p00 + b.p10 + b.p01 + b.p11);
  double radius = 0;
  for (const dvec3* corner : {&b.p00, &b.p10, &b.p01, &b.p11})
    radius = std::max(radius, glm::length(*corner - center));
  return {center, radius};
}

std::vector<Curve> boundary_of(const Bilinear& b) {
  return {segment(b.p00, b.p10), segment(b.p10, b.p11), segment(b.p11, b.p01),
          segment(b.p01, b.p00)};
}

dvec2 uv_of(const Bilinear& b, const dvec3& x, int) { return parameters_of(b, x); }

std::vector<Primitive> references_of(const BilinearMeshShape& mesh) {
  std::vector<Primitive> out;
  for (const auto& p : mesh.patches)
    out.push_back(Bilinear{dvec3(mesh.positions[p[0]]), dvec3(mesh.positions[p[1]]),
                           dvec3(mesh.positions[p[2]]), dvec3(mesh.positions[p[3]])});
  return out;
}

}  // namespace caplet::reference
