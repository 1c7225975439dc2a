// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "present/smooth_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/check.h"

namespace caplet {

namespace {

using Point = SmoothCurve::Point;

double product(const Point& a, const Point& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

double size_of(const Point& a) { return std::sqrt(product(a, a)); }

/// Returns fa a + fb b.
Point sum(double fa, const Point& a, double fb, const Point& b) {
  Point out(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) out[i] = fa * a[i] + fb * b[i];
  return out;
}

}  // namespace

void SmoothCurve::add(double time, Point point) {
  if (!keys_.empty()) {
    CHECK_LT_(keys_.back().time, time);
    CHECK_EQ_(keys_.back().point.size(), point.size());
  }
  keys_.push_back({time, std::move(point)});
}

/// Returns the way from one point to another; on the sphere a tangent at `from` whose length is the
/// angle.
Point SmoothCurve::towards(const Point& from, const Point& to) const {
  if (space_ == Space::line) return sum(1, to, -1, from);
  const double cosine = product(from, to);
  const Point across = sum(1, to, -cosine, from);
  const double sine = size_of(across);
  const double factor = sine > 1e-12 ? std::atan2(sine, cosine) / sine : 1;
  return sum(factor, across, 0, from);
}

Point SmoothCurve::moved(const Point& from, const Point& by, double factor) const {
  if (space_ == Space::line) return sum(1, from, factor, by);
  const double length = size_of(by), angle = factor * length;
  const Point out = sum(std::cos(angle), from, length > 0 ? std::sin(angle) / length : 0, by);
  return sum(1 / size_of(out), out, 0, out);
}

Point SmoothCurve::between(const Point& a, const Point& b, double u) const {
  return moved(a, towards(a, b), u);
}

Point SmoothCurve::velocity(std::size_t key) const {
  const Point& here = keys_[key].point;
  const auto to = [&](std::size_t other) { return towards(here, keys_[other].point); };
  const auto seconds = [&](std::size_t before) {
    return keys_[before + 1].time - keys_[before].time;
  };
  if (key == 0) return sum(1 / seconds(0), to(1), 0, here);
  if (key + 1 == keys_.size()) return sum(-1 / seconds(key - 1), to(key - 1), 0, here);
  const Point on = to(key + 1), back = to(key - 1);
  if (size_of(on) == 0 || size_of(back) == 0) return Point(here.size());
  const double before = seconds(key - 1), after = seconds(key), all = before + after;
  return sum(before / (after * all), on, -after / (before * all), back);
}

Point SmoothCurve::at(double time) const {
  CHECK_LE_(std::size_t{1}, keys_.size());
  const auto after = std::ranges::upper_bound(keys_, time, {}, &Key::time);
  if (after == keys_.begin()) return keys_.front().point;
  if (after == keys_.end()) return keys_.back().point;
  const auto i = static_cast<std::size_t>(after - keys_.begin()) - 1;
  const double seconds = keys_[i + 1].time - keys_[i].time, u = (time - keys_[i].time) / seconds;
  std::array<Point, 4> points{keys_[i].point, moved(keys_[i].point, velocity(i), seconds / 3),
                              moved(keys_[i + 1].point, velocity(i + 1), -seconds / 3),
                              keys_[i + 1].point};
  for (std::size_t count = points.size() - 1; count > 0; --count)
    for (std::size_t k = 0; k < count; ++k) points[k] = between(points[k], points[k + 1], u);
  return points[0];
}

}  // namespace caplet
