// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/motion.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/check.h"
#include "base/error.h"
#include "shared/limits.h"

namespace caplet {

namespace {

using Matrix = glm::dmat4;
using Cubic = std::array<Matrix, 4>;

constexpr std::size_t most_segments = 4096;
constexpr int most_halvings = 20;

/// Returns the cubic through four matrices at the Chebyshev points of [0, 1], by divided
/// differences.
Cubic through(const std::array<double, 4>& points, const std::array<Matrix, 4>& values) {
  std::array<Matrix, 4> newton = values;
  for (std::size_t order = 1; order < 4; ++order)
    for (std::size_t i = 3; i >= order; --i)
      newton[i] = (newton[i] - newton[i - 1]) * (1 / (points[i] - points[i - order]));
  Cubic out{Matrix(0), Matrix(0), Matrix(0), Matrix(0)};
  out[0] = newton[3];
  for (std::size_t i = 3; i-- > 0;) {  // multiplied by (u - point), plus the next
    for (std::size_t k = 3; k > 0; --k) out[k] = out[k - 1] - points[i] * out[k];
    out[0] = newton[i] - points[i] * out[0];
  }
  return out;
}

Matrix value(const Cubic& cubic, double u) {
  return cubic[0] + u * (cubic[1] + u * (cubic[2] + u * cubic[3]));
}

/// Returns the part of a cubic from u = a to u = b, as a cubic over [0, 1].
Cubic between(const Cubic& c, double a, double b) {
  const double width = b - a;
  return {value(c, a), width * (c[1] + a * (2.0 * c[2] + 3.0 * a * c[3])),
          width * width * (c[2] + 3.0 * a * c[3]), width * width * width * c[3]};
}

/// Returns whether the matrices are the same up to half a rounding of floats: of the largest entry
/// of a row's linear part, and of the translations.
bool is_near(const Matrix& a, const Matrix& b) {
  double shift = 0;
  for (int r = 0; r < 3; ++r) shift = std::max(shift, std::abs(a[3][r]));
  for (int r = 0; r < 3; ++r) {
    double largest = 0, off = 0;
    for (int c = 0; c < 3; ++c) {
      largest = std::max(largest, std::abs(a[c][r]));
      off = std::max(off, std::abs(a[c][r] - b[c][r]));
    }
    if (!(off <= 0x1p-25 * largest)) return false;
    if (!(std::abs(a[3][r] - b[3][r]) <= 0x1p-25 * (shift + largest))) return false;
  }
  return true;
}

}  // namespace

std::optional<MotionPath> MotionPath::of(const TransformKeys& keys, const FilmSettings& film,
                                         const glm::dvec3& pivot, const Matrix& right,
                                         const SourceLocation& where) {
  if (keys.empty()) return std::nullopt;
  const AnimatedTransform animated(keys, pivot);
  std::vector<double> times;
  for (const TransformKey& key : keys) times.push_back(key.time);
  return of([&](double seconds) { return animated.at(seconds) * right; }, times, film, where);
}

std::optional<MotionPath> MotionPath::of(const std::function<Matrix(double)>& at_seconds,
                                         const std::vector<double>& times, const FilmSettings& film,
                                         const SourceLocation& where) {
  const double open = film.shutter_open, close = open + film.open_time();
  const auto at = [&](double time) { return at_seconds(open + time * (close - open)); };
  MotionPath out;
  out.start_ = at(0);
  // Speeds change at keys alone, so segments end there.
  std::vector<double> ends{0};
  std::vector<double> rising = times;
  std::ranges::sort(rising);
  for (const double seconds : rising)
    if (const double time = (seconds - open) / (close - open); time > ends.back() && time < 1)
      ends.push_back(time);
  ends.push_back(1);

  std::array<double, 4> points;
  for (std::size_t i = 0; i < 4; ++i)
    points[i] = 0.5 - 0.5 * std::cos((static_cast<double>(i) + 0.5) * 3.141592653589793 / 4);
  const std::function<void(double, double, int)> add = [&](double begin, double end, int halvings) {
    const auto within = [&](double u) { return at(begin + u * (end - begin)); };
    std::array<Matrix, 4> there, back;
    for (std::size_t i = 0; i < 4; ++i) {
      there[i] = within(points[i]);
      back[i] = glm::inverse(there[i]);
    }
    const Segment segment{begin, end, through(points, there), through(points, back)};
    bool near = true;
    // The error of a cubic through the Chebyshev points is greatest at the ends and between them.
    for (const double u : {0.0, 0.146, 0.5, 0.854, 1.0})
      near = near && is_near(within(u), value(segment.matrix, u)) &&
             is_near(glm::inverse(within(u)), value(segment.inverse, u));
    if (near || halvings == most_halvings) {
      if (out.segments_.size() == most_segments)
        throw InputError(where,
                         "the motion takes more than 4096 segments of time: what turns is too "
                         "far from what it turns about");
      out.segments_.push_back(segment);
      return;
    }
    add(begin, 0.5 * (begin + end), halvings + 1);
    add(0.5 * (begin + end), end, halvings + 1);
  };
  for (std::size_t i = 1; i < ends.size(); ++i) add(ends[i - 1], ends[i], 0);

  const bool rests = std::ranges::all_of(out.segments_, [&](const Segment& one) {
    return is_near(out.start_, value(one.matrix, 0)) && is_near(out.start_, value(one.matrix, 1)) &&
           is_near(out.start_, value(one.matrix, 0.5));
  });
  if (rests) return std::nullopt;
  return out;
}

Matrix MotionPath::greatest(bool of_inverse) const {
  Matrix out(0);
  for (const Segment& segment : segments_) {
    const Cubic& c = of_inverse ? segment.inverse : segment.matrix;
    // A cubic lies within the hull of its Bezier points.
    const std::array<Matrix, 4> hull{c[0], c[0] + c[1] / 3.0, c[0] + 2.0 / 3 * c[1] + c[2] / 3.0,
                                     c[0] + c[1] + c[2] + c[3]};
    for (const Matrix& point : hull)
      for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
          out[column][row] = std::max(out[column][row], std::abs(point[column][row]));
  }
  return out;
}

Bounds MotionPath::swept(const Bounds& box, float begin, float end) const {
  Bounds out;
  if (box.empty()) return out;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const auto from = static_cast<float>(segments_[i].begin),
               to = i + 1 < segments_.size() ? static_cast<float>(segments_[i + 1].begin) : 1.0f;
    if (from > end || to < begin) continue;
    // These are u as kernels round it, which rises with the time (motion_segment).
    const auto u_at = [&](float time) {
      return (time - from) * static_cast<float>(1 / (segments_[i].end - segments_[i].begin));
    };
    const Cubic part = between(segments_[i].matrix, double{u_at(std::max(begin, from))},
                               double{u_at(std::min(end, to))});
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec4 p(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                         corner & 4 ? box.max.z : box.min.z, 1);
      // A cubic lies within the hull of its Bezier points.
      std::array<glm::dvec3, 4> c;
      for (std::size_t k = 0; k < 4; ++k) c[k] = glm::dvec3(part[k] * p);
      out.extend(c[0]);
      out.extend(c[0] + c[1] / 3.0);
      out.extend(c[0] + 2.0 / 3 * c[1] + c[2] / 3.0);
      out.extend(c[0] + c[1] + c[2] + c[3]);
    }
  }
  return out;
}

void MotionPath::append(bool with_inverse, std::vector<float>& to) const {
  for (const Segment& segment : segments_) {
    to.push_back(static_cast<float>(segment.begin));
    to.push_back(static_cast<float>(1 / (segment.end - segment.begin)));
  }
  const auto put = [&](const Cubic& cubic) {
    for (int row = 0; row < 3; ++row)
      for (const Matrix& coefficient : cubic)
        for (int column = 0; column < 4; ++column)
          to.push_back(static_cast<float>(coefficient[column][row]));
  };
  for (const Segment& segment : segments_) {
    if (with_inverse) put(segment.inverse);
    put(segment.matrix);
  }
}

std::array<float, 12> motion_at(std::span<const float> motion, std::uint32_t segments,
                                std::uint32_t matrices, std::uint32_t matrix, float time) {
  std::uint32_t segment = 0;
  while (segment + 1 < segments && motion[2 * segment + 2] <= time) ++segment;
  const float u = (time - motion[2 * segment]) * motion[2 * segment + 1];
  const std::span<const float> cubics = motion.subspan(
      2 * segments + std::size_t{CAPLET_MOTION_FLOATS} * (matrices * segment + matrix),
      CAPLET_MOTION_FLOATS);
  std::array<float, 12> out{};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 4; ++column) {
      const auto c = [&](std::size_t power) { return cubics[16 * row + 4 * power + column]; };
      out[4 * row + column] = std::fma(std::fma(std::fma(c(3), u, c(2)), u, c(1)), u, c(0));
    }
  return out;
}

}  // namespace caplet
