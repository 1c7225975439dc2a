// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Branch and bound: boxes are told to be outside, inside or neither by functions of each solid that grow no faster than distance.
#include "scene/detail/csg_bounds.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <queue>
#include <vector>

namespace caplet {

namespace {

using glm::dvec3;

/// How far a point is outside of a solid: a lower bound of the distance, and a number that is at most 0 only within.
struct Beyond {
  double least, most;
};

/// One end of a hull: a ball or a disk across the axis.
struct End {
  double radius;
  bool round;
};

/// For a point at height y along the axis and rho off it, and the hull of two ends at heights 0 and l. The hull is the union over
/// s of the sums of a disk and a ball whose radii run linearly; the distance from these is convex in s, and at any s it is no
/// less than the hull's.
Beyond beyond_hull(double y, double rho, double l, const End& a, const End& b) {
  const auto at = [&](double s) {
    const double disk = (a.round ? 0 : (1 - s) * a.radius) + (b.round ? 0 : s * b.radius);
    const double ball = (a.round ? (1 - s) * a.radius : 0) + (b.round ? s * b.radius : 0);
    const double across = std::max(rho - disk, 0.0), along = y - s * l;
    return std::sqrt(across * across + along * along) - ball;
  };
  double low = 0, high = 1;
  for (int i = 0; i < 16; ++i) {
    const double s = low + (high - low) / 3, t = high - (high - low) / 3;
    if (at(s) < at(t))
      high = t;
    else
      low = s;
  }
  // The slope of `at` is below l + a.radius + b.radius.
  const double most = at((low + high) / 2);
  return {most - (high - low) * (l + a.radius + b.radius), most};
}

Beyond exactly(double distance) { return {distance, distance}; }

/// How far outside a point of the solid's own space is.
struct BeyondAt {
  const dvec3& p;

  Beyond ends(const dvec3& p0, const dvec3& p1, const End& a, const End& b) const {
    const double l = glm::length(p1 - p0);
    if (!(l > 0)) return exactly(glm::length(p - p0) - std::max(a.radius, b.radius));
    const dvec3 axis = (p1 - p0) / l;
    const double y = glm::dot(p - p0, axis);
    const double rho = glm::length(p - p0 - y * axis);
    if (!a.round && !b.round) {
      // Two planes and the side, whose slope c keeps it from growing faster than distance.
      const double taper = (a.radius - b.radius) / l, c = 1 / std::sqrt(1 + taper * taper);
      return exactly(std::max({-y, y - l, c * (rho - a.radius + taper * y)}));
    }
    return beyond_hull(y, rho, l, a, b);
  }
  Beyond operator()(const SphereShape& sphere) const { return exactly(glm::length(p) - sphere.radius); }
  Beyond operator()(const CapsulesShape& capsules) const {
    const double r0 = static_cast<double>(capsules.radius0[0]);
    const double r1 = capsules.radius1.empty() ? r0 : static_cast<double>(capsules.radius1[0]);
    return ends(dvec3(capsules.p0[0]), dvec3(capsules.p1[0]), {r0, true}, {r1, true});
  }
  Beyond operator()(const CylinderShape& c) const {
    return ends(c.p0, c.p1, {c.radius, c.caps[0] == Cap::round}, {c.radius, c.caps[1] == Cap::round});
  }
  Beyond operator()(const ConeShape& c) const {
    return ends(c.p0, c.p1, {c.radius[0], c.caps[0] == Cap::round}, {c.radius[1], c.caps[1] == Cap::round});
  }
  Beyond operator()(const BoxShape& box) const {
    const dvec3 q = glm::max(glm::min(box.p0, box.p1) - p, p - glm::max(box.p0, box.p1));
    return exactly(std::max({q.x, q.y, q.z}));
  }
  Beyond operator()(const PolyhedronShape& polyhedron) const {
    double most = -INFINITY;
    for (std::size_t i = 0; i < polyhedron.points.size(); ++i)
      most = std::max(most, glm::dot(glm::normalize(polyhedron.normals[i]), p - polyhedron.points[i]));
    return exactly(most);
  }
  /// Nested csg is resolved before, and validate refuses open operands.
  static constexpr Beyond unknown{-INFINITY, INFINITY};
  Beyond operator()(const CsgShape&) const { return unknown; }
  Beyond operator()(const TriangleMeshShape&) const { return unknown; }
  Beyond operator()(const BilinearMeshShape&) const { return unknown; }
  Beyond operator()(const DiskShape&) const { return unknown; }
  Beyond operator()(const PartialSphereShape&) const { return unknown; }
  Beyond operator()(const OpenCylinderShape&) const { return unknown; }
};

struct Solid {
  const Shape* shape;
  glm::dmat4 object_from_world;
  bool subtracted;
};

/// A box, and the solids (bits) that it is known to be inside or outside of.
struct Box {
  dvec3 min, max;
  std::uint32_t inside = 0, outside = 0;
};

class Search {
 public:
  Search(const CsgShape& csg, const glm::dmat4& world_from_csg) : csg_(csg) { add(csg, world_from_csg, false); }

  /// An upper bound of how far the solid reaches along `axis`, up or down by `sign`, found in parts of `share` of the box;
  /// -infinity when it is empty.
  double reach(const Box& whole, int axis, double sign, double share) const {
    const auto extreme = [&](const Box& box) { return sign > 0 ? box.max[axis] : -box.min[axis]; };
    const auto nearer = [&](const Box& a, const Box& b) { return extreme(a) < extreme(b); };
    std::priority_queue<Box, std::vector<Box>, decltype(nearer)> boxes(nearer);
    const dvec3 enough = share * (whole.max - whole.min);
    boxes.push(whole);
    for (int i = 0; i < effort && !boxes.empty(); ++i) {
      Box box = boxes.top();
      const Side side = side_of(box);
      const dvec3 size = box.max - box.min;
      if (side == Side::inside || (side == Side::unknown && size.x <= enough.x && size.y <= enough.y && size.z <= enough.z))
        return extreme(box);
      boxes.pop();
      if (side == Side::outside) continue;
      const dvec3 part = size / (whole.max - whole.min);
      const int longest = part.x >= part.y && part.x >= part.z ? 0 : part.y >= part.z ? 1 : 2;
      Box low = box, high = box;
      low.max[longest] = high.min[longest] = 0.5 * (box.min[longest] + box.max[longest]);
      boxes.push(low);
      boxes.push(high);
    }
    return boxes.empty() ? -INFINITY : extreme(boxes.top());
  }

 private:
  enum class Side { outside, inside, unknown };
  static constexpr int effort = 2048;

  void add(const CsgShape& csg, const glm::dmat4& world_from_csg, bool subtracted) {
    for (std::size_t i = 0; i < csg.operands.size(); ++i) {
      const Shape& operand = *csg.operands[i];
      const glm::dmat4 world_from_operand = world_from_csg * operand.world_from_object;
      const bool turned = subtracted != (csg.operation == CsgShape::Operation::set_difference && i > 0);
      if (const auto* nested = std::get_if<CsgShape>(&operand.geometry))
        add(*nested, world_from_operand, turned);
      else
        solids_.push_back({&operand, glm::inverse(world_from_operand), turned});
    }
  }

  Side side_of(Box& box) const {
    for (std::size_t i = 0; i < solids_.size(); ++i) {
      const std::uint32_t bit = std::uint32_t{1} << i;
      if ((box.inside | box.outside) & bit) continue;
      const Side side = side_of(solids_[i], box);
      if (side == Side::inside) box.inside |= bit;
      if (side == Side::outside) box.outside |= bit;
    }
    std::uint32_t bit = 1;
    return side_of(csg_, box, bit);
  }

  /// On which side of the solid the box lies; `bit` stands for its first operand, and then for the one after its last.
  static Side side_of(const CsgShape& csg, const Box& box, std::uint32_t& bit) {
    using enum CsgShape::Operation;
    Side result = Side::unknown;
    for (std::size_t i = 0; i < csg.operands.size(); ++i) {
      Side side = (box.inside & bit) ? Side::inside : (box.outside & bit) ? Side::outside : Side::unknown;
      if (const auto* nested = std::get_if<CsgShape>(&csg.operands[i]->geometry))
        side = side_of(*nested, box, bit);
      else
        bit <<= 1;
      if (i == 0) {
        result = side;
        continue;
      }
      if (csg.operation == set_difference && side != Side::unknown) side = side == Side::inside ? Side::outside : Side::inside;
      const Side decides = csg.operation == set_union ? Side::inside : Side::outside;
      if (result == decides || side == decides)
        result = decides;
      else if (side == Side::unknown)
        result = side;
    }
    return result;
  }

  static Side side_of(const Solid& solid, const Box& box) {
    const auto beyond = [&](const dvec3& p) { return std::visit(BeyondAt{p}, solid.shape->geometry); };
    const glm::dmat3 a(solid.object_from_world);
    const dvec3 half = 0.5 * (box.max - box.min);
    const dvec3 center(solid.object_from_world * glm::dvec4(0.5 * (box.min + box.max), 1));
    const dvec3 x = a[0] * half.x, y = a[1] * half.y, z = a[2] * half.z;
    const dvec3 corners[] = {x + y + z, x + y - z, x - y + z, x - y - z};
    double reach = 0;
    for (const dvec3& corner : corners) reach = std::max(reach, glm::length(corner));
    const Beyond at_center = beyond(center);
    if (at_center.least > reach) return Side::outside;
    if (at_center.most > 0) return Side::unknown;
    // The solid is convex: if it holds the corners, it holds the box. Only solids that are taken away need to be known to hold
    // it.
    if (!solid.subtracted) return Side::unknown;
    for (const dvec3& corner : corners)
      if (beyond(center + corner).most > 0 || beyond(center - corner).most > 0) return Side::unknown;
    return Side::inside;
  }

  const CsgShape& csg_;
  std::vector<Solid> solids_;
};

}  // namespace

Bounds tightened(const CsgShape& csg, const glm::dmat4& world_from_csg, const Bounds& bounds) {
  const dvec3 size = bounds.max - bounds.min;
  const double least = std::min({size.x, size.y, size.z});
  if (least < 0) return {};
  if (csg.operation == CsgShape::Operation::set_union) return bounds;  // a union of tight bounds is tight
  std::size_t solids = 0;
  for (const auto& operand : csg.operands) solids += solid_count(*operand);
  if (!(least > 0) || !std::isfinite(glm::length(size)) || solids > max_csg_operands) return bounds;
  const Search search(csg, world_from_csg);
  Box box{bounds.min, bounds.max};
  for (const double share : {1.0 / 32, 1.0 / 128})
    for (int axis = 0; axis < 3; ++axis) {
      const double high = search.reach(box, axis, 1, share), low = -search.reach(box, axis, -1, share);
      if (!(low <= high)) return {};
      box.min[axis] = low;
      box.max[axis] = high;
    }
  return {box.min, box.max};
}

}  // namespace caplet
