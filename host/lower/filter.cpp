// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"

namespace caplet {

namespace {

double mitchell(double x, double b, double c) {
  x = std::abs(x);
  if (x <= 1)
    return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b)) / 6;
  if (x <= 2)
    return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x +
            (8 * b + 24 * c)) /
           6;
  return 0;
}

double sinc(double x) {
  const double t = std::numbers::pi * x;
  return t == 0 ? 1 : std::sin(t) / t;
}

/// Returns the right half of the nodes: 0, ..., radius. Zero crossings become nodes.
std::vector<double> half_nodes(const PixelFilter& filter, double radius) {
  if (filter.kind == PixelFilter::Kind::triangle) return {0, radius};
  constexpr int cells = 64;
  std::vector<double> nodes = {0};
  for (int i = 1; i <= cells; ++i) {
    const double a = nodes.back(), b = radius * i / cells;
    const double fa = filter_value(filter, a, radius), fb = filter_value(filter, b, radius);
    if (fa * fb < 0) {
      double low = a, high = b;
      for (int k = 0; k < 60; ++k) {
        const double middle = (low + high) / 2;
        (filter_value(filter, middle, radius) * fa > 0 ? low : high) = middle;
      }
      nodes.push_back(low);
    }
    nodes.push_back(b);
  }
  return nodes;
}

/// Appends one axis; returns its number of cells.
uint append_axis(const PixelFilter& filter, double radius, std::vector<float>& table) {
  std::vector<double> nodes, values;
  if (filter.kind == PixelFilter::Kind::box) {
    nodes = {-radius, radius};
  } else {
    const std::vector<double> half = half_nodes(filter, radius);
    for (std::size_t i = half.size() - 1; i > 0; --i) nodes.push_back(-half[i]);
    nodes.insert(nodes.end(), half.begin(), half.end());
  }
  for (const double x : nodes) {
    const double value = filter_value(filter, x, radius);
    // A node at a zero crossing is exact to bisection only: its value becomes 0, so that its cell
    // does not have both signs.
    values.push_back(std::abs(value) < 1e-12 * std::abs(filter_value(filter, 0, radius)) ? 0
                                                                                         : value);
  }
  std::vector<double> running = {0};
  double integral = 0;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const double cell = (values[i] + values[i + 1]) / 2 * (nodes[i + 1] - nodes[i]);
    integral += cell;
    running.push_back(running.back() + std::abs(cell));
  }
  const double total = running.back();
  for (const double x : nodes) table.push_back(static_cast<float>(x));
  for (const double sum : running) table.push_back(static_cast<float>(sum / total));
  for (const double value : values) table.push_back(static_cast<float>(value));
  table.push_back(static_cast<float>(total / integral));
  return narrow<uint>(nodes.size() - 1);
}

}  // namespace

double filter_value(const PixelFilter& filter, double x, double radius) {
  x = std::abs(x);
  if (x > radius) return 0;
  switch (filter.kind) {
    case PixelFilter::Kind::box:
      return 1;
    case PixelFilter::Kind::triangle:
      return radius - x;
    case PixelFilter::Kind::gaussian: {
      const auto bell = [&](double t) {
        return std::exp(-t * t / (2 * filter.sigma * filter.sigma));
      };
      return std::max(0.0, bell(x) - bell(radius));
    }
    case PixelFilter::Kind::mitchell:
      return mitchell(2 * x / radius, filter.b, filter.c);
    case PixelFilter::Kind::sinc:
      return sinc(x) * sinc(x / filter.tau);
  }
  return 0;
}

void lower_filter(const PixelFilter& filter, FlatView& out) {
  out.filter_table.clear();
  out.view.filter_width = append_axis(filter, filter.radius_x, out.filter_table);
  out.view.filter_height = append_axis(filter, filter.radius_y, out.filter_table);
}

}  // namespace caplet
