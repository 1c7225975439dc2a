// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/detail/grown_balls.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <tuple>

#include "base/error.h"

namespace caplet {

namespace {

using glm::dvec3;

/// A ball's radius grows by less than this part of it. That is little against a float's last place,
/// and much against the roundings of doubles, so that no four spheres pass through one point and
/// none touch, even in crystals and symmetric molecules.
constexpr double most_growth = 0x1p-28;

/// The time grows with the square of the number of balls that a probe can touch together with one.
/// Proteins and water have some 60, and 3,000 for a probe of 8 angstroms. More than this is taken
/// for a mistake, such as lengths in another unit; so are as many balls in the cells around one.
constexpr std::size_t most_near = 4096, most_in_cells = 65536;

[[noreturn]] void refuse(std::size_t count) {
  throw InputError("the probe reaches from one ball to " + std::to_string(count) +
                   " others, of at most " + std::to_string(most_near) +
                   ": it is too large for them, or their unit is another one");
}

/// Returns a number in [0, 1) that looks random. It depends on nothing but the ball, so that the
/// order of balls does not matter.
double fraction_for(const glm::vec3& center, float radius) {
  std::uint64_t hash = 0;
  for (const float value : {center.x, center.y, center.z, radius}) {
    hash = (hash ^ std::bit_cast<std::uint32_t>(value + 0.0f)) + 0x9e3779b97f4a7c15u;
    hash = (hash ^ hash >> 30) * 0xbf58476d1ce4e5b9u;
    hash = (hash ^ hash >> 27) * 0x94d049bb133111ebu;
    hash ^= hash >> 31;
  }
  return static_cast<double>(hash >> 11) * 0x1p-53;
}

}  // namespace

GrownBalls::GrownBalls(std::span<const glm::vec3> centers, std::span<const float> radii,
                       double probe)
    : probe_(probe) {
  double largest = 0;
  for (std::size_t i = 0; i < centers.size(); ++i) {
    const double radius = radii[i] + probe;
    centers_.emplace_back(centers[i]);
    radii_.push_back(radius + radius * most_growth * fraction_for(centers[i], radii[i]));
    names_.push_back(static_cast<std::uint32_t>(i));
    largest = std::max(largest, radii_.back());
  }
  if (centers.empty()) return;
  grid_.emplace(centers_, 2 * largest);
  std::vector<char> dropped(size());
  tbb::parallel_for(std::size_t{0}, size(),
                    [&](std::size_t i) { dropped[i] = swallowed(static_cast<std::uint32_t>(i)); });
  keep(dropped);
  grid_.emplace(centers_, 2 * largest);
}

bool GrownBalls::swallowed(std::uint32_t ball) const {
  bool found = false;
  std::size_t seen = 0;
  grid_->near(centers_[ball], [&](std::uint32_t other) {
    if (++seen > most_in_cells) refuse(seen);
    if (found || other == ball) return;
    const double rest = radii_[other] - radii_[ball];
    const dvec3 to = centers_[other] - centers_[ball];
    if (rest < 0 || glm::dot(to, to) > rest * rest) return;
    found = rest > 0 || other < ball;  // of two that are the same, the first stays
  });
  return found;
}

void GrownBalls::keep(const std::vector<char>& dropped) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < dropped.size(); ++i) {
    if (dropped[i]) continue;
    centers_[count] = centers_[i];
    radii_[count] = radii_[i];
    names_[count++] = names_[i];
  }
  centers_.resize(count);
  radii_.resize(count);
  names_.resize(count);
}

std::optional<NearBall> GrownBalls::seen(std::uint32_t a, std::uint32_t b) const {
  const double radius = radii_[a], other = radii_[b];
  const dvec3 to = centers_[b] - centers_[a];
  const double square = glm::dot(to, to);
  if (!(square < (radius + other) * (radius + other))) return std::nullopt;
  const double distance = std::sqrt(square);
  const double height = (distance + (radius - other) * ((radius + other) / distance)) / 2;
  if (!(std::abs(height) < radius)) return std::nullopt;  // they touch, to rounding
  return NearBall{b, other, to, to / distance, height};
}

std::vector<NearBall> GrownBalls::around(std::uint32_t ball) const {
  std::vector<NearBall> found;
  grid_->near(centers_[ball], [&](std::uint32_t other) {
    if (other == ball) return;
    if (const auto near = seen(ball, other)) found.push_back(*near);
  });
  if (found.size() > most_near) refuse(found.size());
  std::sort(found.begin(), found.end(), [](const NearBall& a, const NearBall& b) {
    return std::tie(a.height, a.ball) < std::tie(b.height, b.ball);
  });
  return found;
}

}  // namespace caplet
