// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Says of an answer to "what does this ray hit first?" whether it is right, by the reference and
// the referee, within the bounds of docs/numerics.md.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cases.h"
#include "reference/solver.h"

namespace caplet::test {

enum class Verdict {
  right,      // within the bound
  touching,   // the ray comes within the bound of touching what the answer is about: hit and miss
              // are both right
  missed,     // a solid that the ray enters deeper than the bound is not there
  false_hit,  // a primitive that the ray passes by further than the bound
  displaced   // the primitive is hit, but elsewhere
};

struct Judgement {
  Verdict verdict = Verdict::right;
  std::uint32_t primitive = 0;  // that the verdict is about
  double depth = 0;        // missed, false_hit: how deep the ray enters it or how far it passes by
  double t_error = 0;      // displaced: |t - the right one|, relative to the right one
  double off_surface = 0;  // displaced: distance of the reported point from the surface
  bool later =
      false;  // displaced: the point is on the surface, but not where the ray meets it first
  bool grazing = false;  // displaced: the ray comes within the bound of touching the primitive
  bool wrong() const { return verdict > Verdict::touching; }
};

/// One ray among primitives. Holds references to them. For one thread.
class Judge {
 public:
  Judge(std::span<const FlatPrimitive> primitives, std::span<const reference::Primitive> references,
        const RayRecord& ray);
  /// Where the ray begins: within the bound of a surface, inside a solid, or neither.
  bool begins_at_surface() const { return begins_at_surface_; }
  bool begins_inside() const { return begins_inside_; }
  /// The reference's nearest crossing.
  bool hit() const { return !expected_.empty(); }
  /// `id`: which primitive; CAPLET_NONE: nothing is hit.
  Judgement judge(std::uint32_t id, double t) const;
  /// judge(), where of several primitives that have this point in common it does not matter which
  /// one is named.
  Judgement judge_point(bool hit, double t) const;

 private:
  struct Expected {
    double t;
    std::uint32_t id;
    bool thin;  // of a csg shape, and next to a wall or gap that the bounds of both its sides close
  };
  double value(std::uint32_t id, double t) const;
  bool is_thin(std::uint32_t id, double from, double to) const;
  double bound(std::uint32_t id) const;
  bool touches(std::uint32_t id) const;
  bool passes_by(std::uint32_t id, double t) const;
  bool same_place(std::uint32_t id, double t, double other) const;
  Judgement displaced(std::uint32_t id, double t) const;

  std::span<const FlatPrimitive> primitives_;
  std::span<const reference::Primitive> references_;
  RayRecord record_;
  reference::Ray ray_;
  std::vector<Expected> expected_;  // t > 0, in order
  bool begins_at_surface_ = false, begins_inside_ = false;
  // The referee's last answer: it takes long and is asked about the same primitive for every answer
  // that is judged.
  mutable std::optional<std::pair<std::uint32_t, bool>> touched_;
};

}  // namespace caplet::test
