// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/detail/sphere_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

namespace caplet {

namespace {

using glm::dvec3;

// Points are computed with errors of some 1e-15, and more where two circles nearly coincide. What
// is nearer than this to a plane counts as within, so that bounds miss nothing.
constexpr double region_slack = 1e-12;

double circle_radius(const SpherePlane& plane) {
  return std::sqrt(std::max(0.0, (1 - plane.offset) * (1 + plane.offset)));
}

dvec3 any_point(const SpherePlane& plane) {
  return plane.offset * plane.normal + circle_radius(plane) * any_orthogonal(plane.normal);
}

/// The points where two circles meet.
struct Crossing {
  std::array<dvec3, 2> points;
  double slack;
};

std::optional<Crossing> crossing(const SpherePlane& a, const SpherePlane& b) {
  const dvec3 across = glm::cross(a.normal, b.normal);
  const double sine = glm::length(across);
  if (sine < 1e-15) return std::nullopt;
  // y divides a few roundings by the sine. The point slides by as much along both circles.
  const double y = (b.offset - glm::dot(a.normal, b.normal) * a.offset) / sine;
  const double slack = region_slack + 1e-15 / sine;
  const double z2 = (1 - a.offset) * (1 + a.offset) - y * y;
  if (z2 < -slack) return std::nullopt;
  const dvec3 up = across / sine;
  const dvec3 foot = a.offset * a.normal + y * glm::cross(up, a.normal);
  const dvec3 step = std::sqrt(std::max(z2, 0.0)) * up;
  return Crossing{{foot + step, foot - step}, slack};
}

/// Some of the planes, in an order that finds one that hides a point soon.
class Planes {
 public:
  Planes(std::span<const SpherePlane> all, std::span<const std::uint32_t> some) {
    for (const std::uint32_t plane : some) planes_.push_back(all[plane]);
  }

  std::size_t size() const { return planes_.size(); }
  const SpherePlane& operator[](std::size_t i) const { return planes_[i]; }

  /// Returns whether a point lies within all planes other than a and b.
  bool hold(const dvec3& d, double slack, std::size_t a, std::size_t b) {
    if (last_ != a && last_ != b && last_ < size() && hides(last_, d, slack)) return false;
    for (std::size_t i = 0; i < size(); ++i)
      if (i != a && i != b && hides(i, d, slack)) {
        last_ = i;
        return false;
      }
    return true;
  }

 private:
  bool hides(std::size_t i, const dvec3& d, double slack) const {
    return glm::dot(planes_[i].normal, d) > planes_[i].offset + slack;
  }
  std::vector<SpherePlane> planes_;
  std::size_t last_ = 0;
};

constexpr std::size_t no_plane = static_cast<std::size_t>(-1);

/// The region's corners, a point of each circle that lies in it as a whole, and the circles that
/// meet it.
struct Outline {
  std::vector<dvec3> points;
  std::vector<bool> met;
};

Outline outline_of(Planes& planes) {
  Outline out{{}, std::vector<bool>(planes.size(), false)};
  for (std::size_t a = 0; a < planes.size(); ++a)
    for (std::size_t b = a + 1; b < planes.size(); ++b) {
      const auto both = crossing(planes[a], planes[b]);
      if (!both) continue;
      for (const dvec3& d : both->points)
        if (planes.hold(d, both->slack, a, b)) {
          out.points.push_back(d);
          out.met[a] = out.met[b] = true;
        }
    }
  for (std::size_t a = 0; a < planes.size(); ++a) {
    if (out.met[a] || std::abs(planes[a].offset) >= 1) continue;
    const dvec3 d = any_point(planes[a]);
    if (!planes.hold(d, region_slack, a, a)) continue;
    out.points.push_back(d);
    out.met[a] = true;
  }
  return out;
}

/// Returns the plane that hides the point most, unless none does.
std::optional<std::uint32_t> hider(std::span<const SpherePlane> planes, const dvec3& d) {
  std::optional<std::uint32_t> found;
  double most = region_slack;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const double depth = glm::dot(planes[i].normal, d) - planes[i].offset;
    if (depth <= most) continue;
    most = depth;
    found = static_cast<std::uint32_t>(i);
  }
  return found;
}

/// Bounds the region: in each direction the greatest point is the sphere's, a circle's or a corner.
Bounds bounds_of(Planes& planes, const std::vector<dvec3>& corners) {
  Bounds box;
  for (const dvec3& d : corners) box.extend(d);
  for (int k = 0; k < 3; ++k)
    for (const double sign : {-1.0, 1.0}) {
      dvec3 pole(0);
      pole[k] = sign;
      if (planes.hold(pole, region_slack, no_plane, no_plane)) box.extend(pole);
      for (std::size_t a = 0; a < planes.size(); ++a) {
        const dvec3& n = planes[a].normal;
        const dvec3 off = pole - glm::dot(pole, n) * n;
        const double length = glm::length(off);
        if (length < 1e-9) continue;  // its points are equally high, to rounding
        const dvec3 d = planes[a].offset * n + circle_radius(planes[a]) / length * off;
        if (planes.hold(d, region_slack, a, a)) box.extend(d);
      }
    }
  return box;
}

}  // namespace

dvec3 any_orthogonal(const dvec3& unit) {
  const dvec3 size = glm::abs(unit);
  const dvec3 other = size.x <= size.y && size.x <= size.z ? dvec3(1, 0, 0)
                      : size.y <= size.z                   ? dvec3(0, 1, 0)
                                                           : dvec3(0, 0, 1);
  return glm::normalize(glm::cross(unit, other));
}

std::vector<std::uint32_t> bounding_planes(std::span<const SpherePlane> planes) {
  std::vector<std::uint32_t> every(planes.size());
  for (std::size_t i = 0; i < every.size(); ++i) every[i] = static_cast<std::uint32_t>(i);
  Planes all(planes, every);
  const Outline outline = outline_of(all);
  std::erase_if(every, [&](std::uint32_t i) { return !outline.met[i]; });
  return every;
}

// The bounding planes leave connected parts of the sphere. No other circle enters one that
// belongs to the region, so each part is hidden as a whole or not at all: its corners, or any point
// of a circle without corners, tell which.
SphereRegion sphere_region(std::span<const SpherePlane> planes,
                           std::vector<std::uint32_t> bounding) {
  for (;;) {
    Planes kept(planes, bounding);
    Outline outline = outline_of(kept);
    const std::size_t before = bounding.size();
    for (const dvec3& d : outline.points) {
      const auto hides = [&](std::uint32_t plane) {
        return glm::dot(planes[plane].normal, d) > planes[plane].offset + region_slack;
      };
      if (std::any_of(bounding.begin() + static_cast<std::ptrdiff_t>(before), bounding.end(),
                      hides))
        continue;
      const auto by = hider(planes, d);
      if (by && std::find(bounding.begin(), bounding.end(), *by) == bounding.end())
        bounding.push_back(*by);
    }
    if (bounding.size() == before) return {bounding, bounds_of(kept, outline.points)};
  }
}

}  // namespace caplet
