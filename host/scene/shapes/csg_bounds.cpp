// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Branch and bound: functions of each solid that grow no faster than distance classify boxes as
// outside, inside or unknown.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <queue>
#include <vector>

#include "scene/shape.h"

namespace caplet {

namespace {

using glm::dvec3;

struct Solid {
  const Shape* shape;
  glm::dmat4 object_from_world;
  bool subtracted;
};

/// A box, and the solids (as bits) that it is known to be inside or outside of.
struct Box {
  dvec3 min, max;
  std::uint32_t inside = 0, outside = 0;
};

class Search {
 public:
  Search(const CsgShape& csg, const glm::dmat4& world_from_csg) : csg_(csg) {
    add(csg, world_from_csg, false);
  }

  /// Returns an upper bound of the solid's extent along `axis` in the direction of `sign`, searched
  /// in parts of `share` of the box; -infinity when the solid is empty.
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
      if (side == Side::inside ||
          (side == Side::unknown && size.x <= enough.x && size.y <= enough.y && size.z <= enough.z))
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
      const bool turned =
          subtracted != (csg.operation == CsgShape::Operation::set_difference && i > 0);
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

  /// Classifies the box against the solid. `bit` stands for its first operand, and afterwards for
  /// the one after its last.
  static Side side_of(const CsgShape& csg, const Box& box, std::uint32_t& bit) {
    using enum CsgShape::Operation;
    Side result = Side::unknown;
    for (std::size_t i = 0; i < csg.operands.size(); ++i) {
      Side side = (box.inside & bit)    ? Side::inside
                  : (box.outside & bit) ? Side::outside
                                        : Side::unknown;
      if (const auto* nested = std::get_if<CsgShape>(&csg.operands[i]->geometry))
        side = side_of(*nested, box, bit);
      else
        bit <<= 1;
      if (i == 0) {
        result = side;
        continue;
      }
      if (csg.operation == set_difference && side != Side::unknown)
        side = side == Side::inside ? Side::outside : Side::inside;
      const Side decides = csg.operation == set_union ? Side::inside : Side::outside;
      if (result == decides || side == decides)
        result = decides;
      else if (side == Side::unknown)
        result = side;
    }
    return result;
  }

  static Side side_of(const Solid& solid, const Box& box) {
    const auto beyond = [&](const dvec3& p) {
      return std::visit([&](const auto& own) { return caplet::beyond(own, p); },
                        solid.shape->geometry);
    };
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
    if (at_center.most <= -reach) return Side::inside;
    // A convex solid that contains the corners contains the box. Only subtracted solids need to be
    // known to contain it.
    if (!solid.subtracted) return Side::unknown;
    for (const dvec3& corner : corners)
      if (beyond(center + corner).most > 0 || beyond(center - corner).most > 0)
        return Side::unknown;
    return Side::inside;
  }

  const CsgShape& csg_;
  std::vector<Solid> solids_;
};

constexpr double first_share = 1.0 / 16;

/// Returns whether a search of the solid within `bounds` can be made and may find less.
bool can_tighten(const CsgShape& csg, const Bounds& bounds) {
  if (csg.operation == CsgShape::Operation::set_union || moves(csg))
    return false;  // a union of tight bounds is tight
  const dvec3 size = bounds.max - bounds.min;
  std::size_t solids = 0;
  for (const auto& operand : csg.operands) solids += solid_count(*operand);
  return std::min({size.x, size.y, size.z}) > 0 && std::isfinite(glm::length(size)) &&
         solids <= max_csg_operands;
}

/// Tightens `bounds`, which contain the csg solid under `world_from_csg`. Each side moves inward to
/// the first part, 1/16 of the box long in each direction, that is not shown to be outside, and
/// then again with 1/128 of the new box, or until a fixed effort is spent (2048 parts per side).
/// Where the surfaces meet the side at a slant, a few parts remain between. The bounds never cut
/// the solid, and are empty when no part of the box can contain any of it.
Bounds tightened(const CsgShape& csg, const glm::dmat4& world_from_csg, const Bounds& bounds) {
  const Search search(csg, world_from_csg);
  Box box{bounds.min, bounds.max};
  for (const double share : {first_share, 1.0 / 128})
    for (int axis = 0; axis < 3; ++axis) {
      const double high = search.reach(box, axis, 1, share),
                   low = -search.reach(box, axis, -1, share);
      if (!(low <= high)) return {};
      box.min[axis] = low;
      box.max[axis] = high;
    }
  return {box.min, box.max};
}

/// Returns bounds of a geometry that moves, under `m`, at all times.
///
/// Between two keys a point p of it is at shift + rotation * stretch * p, where the rotation is by
/// at most pi at an even speed, and shift and stretch are linear. With R the greatest length of
/// stretch * p at a key, the second derivative over the time between the keys is at most
/// (pi^2 + 2 pi) 2 R, and so the point is at most (1/16)^2 / 8 of that, 0.0158 R, away from the
/// chords between 17 of its places.
Bounds swept_bounds(const Geometry& geometry, const TransformKeys& keys, const glm::dmat4& m) {
  constexpr int steps = 16;
  constexpr double sag = 0.016;
  const Bounds box = bounds_of(geometry, glm::dmat4(1));
  const AnimatedTransform animated(keys);
  Bounds out;
  double reach = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 p(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                  corner & 4 ? box.max.z : box.min.z);
    for (const TransformKey& key : keys)
      reach = std::max(reach, glm::length(glm::dmat3(key.matrix) * p));
    for (std::size_t i = 1; i < keys.size(); ++i) {
      const double begin = keys[i - 1].time, length = keys[i].time - begin;
      for (int k = 0; k <= steps; ++k)
        out.extend(transformed(m * animated.at(begin + length * k / steps), p));
    }
  }
  const dvec3 pad = sag * reach * row_lengths(glm::dmat3(m));
  return {out.min - pad, out.max + pad};
}

/// Returns the bounds that follow from those of the operands; empty where those do not meet.
Bounds bounds_of_operands(const CsgShape& csg, const glm::dmat4& m) {
  Bounds bounds;
  for (std::size_t i = 0; i < csg.operands.size(); ++i) {
    if (csg.operation == CsgShape::Operation::set_difference && i > 0) break;
    const Bounds own =
        csg.motion(i).empty()
            ? bounds_of(csg.operands[i]->geometry, m * csg.operands[i]->world_from_object)
            : swept_bounds(csg.operands[i]->geometry, csg.motion(i), m);
    if (csg.operation == CsgShape::Operation::set_intersection && i > 0) {
      bounds.min = glm::max(bounds.min, own.min);
      bounds.max = glm::min(bounds.max, own.max);
    } else {
      bounds.extend(own);
    }
  }
  const dvec3 size = bounds.max - bounds.min;
  return std::min({size.x, size.y, size.z}) >= 0 ? bounds : Bounds();
}

}  // namespace

Bounds bounds_under(const CsgShape& csg, const glm::dmat4& m) {
  const Bounds bounds = bounds_of_operands(csg, m);
  if (bounds.empty()) return {};
  return can_tighten(csg, bounds) ? tightened(csg, m, bounds) : bounds;
}

bool is_empty(const CsgShape& csg, const glm::dmat4& m) {
  const Bounds bounds = bounds_of_operands(csg, m);
  if (bounds.empty()) return true;
  return can_tighten(csg, bounds) &&
         Search(csg, m).reach({bounds.min, bounds.max}, 0, 1, first_share) == -INFINITY;
}

}  // namespace caplet
