// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/area.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "lower/detail/flat_shapes.h"
#include "lower/detail/shapes.h"

namespace caplet {

namespace {

using glm::dvec3;

using std::numbers::pi;

/// GaussRule holds nodes and weights of Gauss's rule of 2^k points on [-1, 1], by Newton's method
/// on Legendre's polynomials.
struct GaussRule {
  std::vector<double> x, w;
  explicit GaussRule(int n) {
    for (int i = 0; i < n; ++i) {
      double at = std::cos(pi * (i + 0.75) / (n + 0.5)), slope = 1;
      for (int step = 0; step < 100; ++step) {
        double last = 1, value = at;
        for (int k = 2; k <= n; ++k) {
          const double next = ((2 * k - 1) * at * value - (k - 1) * last) / k;
          last = value;
          value = next;
        }
        slope = n * (at * value - last) / (at * at - 1);
        const double move = value / slope;
        at -= move;
        if (std::abs(move) < 1e-15) break;
      }
      x.push_back(at);
      w.push_back(2 / ((1 - at * at) * slope * slope));
    }
  }
};
constexpr int least_points = 8, most_points = 512;
const GaussRule& gauss_rule(int points) {
  static const std::vector<GaussRule> rules = [] {
    std::vector<GaussRule> all;
    for (int n = least_points; n <= most_points; n *= 2) all.emplace_back(n);
    return all;
  }();
  return rules[static_cast<std::size_t>(
      std::countr_zero(static_cast<unsigned>(points / least_points)))];
}

/// Returns the area of a piece's image by `points` directions around the axis: trapezoids around
/// the whole circle, whose error falls geometrically for periodic analytic functions, and Gauss's
/// rule elsewhere.
double round_area(const Piece& piece, const glm::dmat3& cofactor, int points) {
  const dvec3 s =
      piece.start != dvec3(0)
          ? piece.start
          : glm::normalize(glm::cross(
                piece.axis, std::abs(piece.axis.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
  const dvec3 axis = cofactor * piece.axis, x = cofactor * s,
              y = cofactor * glm::cross(piece.axis, s);
  const GaussRule& rule = gauss_rule(points);
  const double from = std::acos(piece.high), to = std::acos(piece.low);
  // Returns the integral over the piece's unit normals at phi, or their mean.
  const auto along = [&](const dvec3& across) {
    if (piece.kind == Piece::side)
      return glm::length(piece.low * axis + std::sqrt(1 - piece.low * piece.low) * across);
    double sum = 0;
    for (std::size_t i = 0; i < rule.x.size(); ++i) {
      const double theta = 0.5 * (from + to + (to - from) * rule.x[i]), sine = std::sin(theta);
      sum += rule.w[i] * sine * glm::length(std::cos(theta) * axis + sine * across);
    }
    return 0.5 * (to - from) * sum;
  };
  const bool whole = piece.phi_max >= full_turn * (1 - 1e-6);
  double sum = 0;
  for (int j = 0; j < points; ++j) {
    const auto i = static_cast<std::size_t>(j);
    const double phi = whole ? 2 * pi * j / points : 0.5 * piece.phi_max * (1 + rule.x[i]);
    sum += (whole ? 1.0 / points : 0.5 * rule.w[i]) * along(std::cos(phi) * x + std::sin(phi) * y);
  }
  return piece.amount * sum * (piece.kind == Piece::zone ? std::min(piece.phi_max, 2 * pi) : 1);
}

double image_area(const Piece& piece, const glm::dmat3& cofactor) {
  if (piece.kind == Piece::flat) return glm::length(cofactor * piece.axis);
  double last = round_area(piece, cofactor, least_points);
  for (int points = 2 * least_points; points <= most_points; points *= 2) {
    const double next = round_area(piece, cofactor, points);
    if (std::abs(next - last) <= 1e-10 * next) return next;
    last = next;
  }
  return last;
}

Pieces pieces_of(const FlatPrimitive& p, const std::vector<float>& leaves) {
  Pieces pieces;
  switch (p.shape) {
#define SHAPE(name, traits)                                                       \
  case shape_##name:                                                              \
    if constexpr (((traits)&trait_linked) == 0) name##_pieces(p, leaves, pieces); \
    break;
#define COMPOUND(name, traits)
#include "shared/shapes.def"
#undef SHAPE
    default:
      break;
  }
  return pieces;
}

}  // namespace

double primitive_area(const FlatPrimitive& p, const std::vector<float>& leaves) {
  switch (p.shape) {
#define SHAPE(name, traits)                                                    \
  case shape_##name:                                                           \
    if constexpr (((traits)&trait_linked) == 0) return name##_area(p, leaves); \
    return 0;
#define COMPOUND(name, traits)
#include "shared/shapes.def"
#undef SHAPE
    default:
      return 0;
  }
}

AreaMap::AreaMap(const glm::dmat4& map) : m(map), similarity(similarity_scale(map)) {}

double placed_area(const FlatPrimitive& p, const std::vector<float>& leaves, const AreaMap& map,
                   std::span<const std::uint32_t> surfaces) {
  if (map.similarity > 0 && surfaces.empty())
    return primitive_area(p, leaves) * (map.similarity * map.similarity);
  const glm::dmat3 a(map.m);
  const auto counted = [&](std::uint32_t surface) {
    return surfaces.empty() || std::ranges::find(surfaces, surface) != surfaces.end();
  };
  if (p.shape == shape_bilinear) return counted(0) ? bilinear_area(p.data, a) : 0;
  const glm::dmat3 cofactor = glm::transpose(glm::inverse(a)) * std::abs(glm::determinant(a));
  if (p.shape == shape_molecular_patch)
    return counted(0) ? molecular_patch_area(&leaves[molecular_patch_begin(p.data)], cofactor) : 0;
  const Pieces pieces = pieces_of(p, leaves);
  double area = 0;
  for (const Piece& piece : pieces.all())
    if (counted(piece.surface)) area += image_area(piece, cofactor);
  return area;
}

}  // namespace caplet
