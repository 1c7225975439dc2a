// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "judge.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "shared/kinds.h"

namespace caplet::test {

Judge::Judge(std::span<const FlatPrimitive> primitives,
             std::span<const reference::Primitive> references, const RayRecord& ray)
    : primitives_(primitives), references_(references), record_(ray), ray_(reference_ray(ray)) {
  for (std::uint32_t id = 0; id < references.size(); ++id) {
    const auto crossings = reference::crossings(references[id], ray_);
    // A ray along a triangle may begin in it and not cross it; one that begins at a solid and
    // misses it touches it.
    if (crossings.empty() && reference::is_solid(references[id])) continue;
    bool thin = false;
    for (std::size_t i = 0; i < crossings.size(); ++i) {
      const bool thin_before =
          std::exchange(thin, primitives[id].shape == shape_csg && i + 1 < crossings.size() &&
                                  is_thin(id, crossings[i].t, crossings[i + 1].t));
      if (crossings[i].t > 0) expected_.push_back({crossings[i].t, id, thin_before || thin});
    }
    const double here = value(id, 0);
    begins_at_surface_ = begins_at_surface_ || std::abs(here) <= bound(id);
    begins_inside_ = begins_inside_ || here < -bound(id);
  }
  std::stable_sort(expected_.begin(), expected_.end(),
                   [](const Expected& a, const Expected& b) { return a.t < b.t; });
}

double Judge::value(std::uint32_t id, double t) const {
  return reference::value(references_[id], ray_.origin + t * ray_.direction);
}

// docs/numerics.md, "CSG": the sum of the bounds of both sides.
bool Judge::is_thin(std::uint32_t id, double from, double to) const {
  double deepest = 0;
  for (int k = 1; k < 64; ++k)
    deepest = std::max(deepest, std::abs(value(id, from + (to - from) * k / 64)));
  return deepest <= 2 * bound(id);
}

double Judge::bound(std::uint32_t id) const {
  return surface_bound(primitives_[id], references_[id], record_);
}

bool Judge::touches(std::uint32_t id) const {
  if (!touched_ || touched_->first != id)
    touched_ = {
        id, reference::referee(references_[id], ray_, bound(id)) == reference::Verdict::tangent};
  return touched_->second;
}

// Whether the ray comes to the surface at t and goes back to the side that it came from: what the
// referee says of a convex shape's whole line, said of one place.
bool Judge::passes_by(std::uint32_t id, double t) const {
  const double b = bound(id), step = 0.5 * b / glm::length(ray_.direction);
  const auto side = [&](double towards) {
    for (int n = 1; n < 200000; ++n)
      if (const double v = value(id, t + towards * n * step); std::abs(v) > b)
        return v > 0 ? 1 : -1;
    return 0;
  };
  return side(-1) == side(1);
}

// Two parameters are one crossing where the ray stays near the surface between them: each end is
// within the bound of it.
bool Judge::same_place(std::uint32_t id, double t, double other) const {
  return std::abs(value(id, 0.5 * (t + other))) <= 2 * bound(id);
}

Judgement Judge::displaced(std::uint32_t id, double t) const {
  Judgement out{Verdict::displaced, id, 0, HUGE_VAL, std::abs(value(id, t)), false, touches(id)};
  out.later = out.off_surface <= bound(id);
  for (const Expected& e : expected_)
    if (e.id == id) {
      out.t_error = std::abs(t - e.t) / e.t;
      break;
    }
  return out;
}

Judgement Judge::judge(std::uint32_t id, double t) const {
  bool touching = false;
  if (id != CAPLET_NONE) {
    const bool on_it = std::abs(value(id, t)) <= bound(id);
    const bool found = std::any_of(expected_.begin(), expected_.end(), [&](const Expected& e) {
      return e.id == id && same_place(id, e.t, t);
    });
    if (!on_it || !found) {
      // Edge-on, triangles are met beside themselves.
      const bool edge_on =
          primitives_[id].shape == shape_triangle &&
          std::abs(value(id, t)) <= reference::bounding_ball(references_[id]).radius;
      const bool csg_passed_by = primitives_[id].shape == shape_csg && on_it && passes_by(id, t);
      if (!(t > 0) || !(on_it || edge_on) || !(csg_passed_by || touches(id))) {
        const double margin = reference::margin(references_[id], ray_);
        if (margin < -bound(id))
          return {Verdict::false_hit, id, -margin, HUGE_VAL, std::abs(value(id, t)), false, false};
        return displaced(id, t);
      }
      touching = true;
    }
  }
  for (const Expected& e : expected_) {
    if (id != CAPLET_NONE && (e.t >= t || same_place(e.id, e.t, t))) break;
    if (e.thin || touches(e.id)) {
      touching = true;
      continue;
    }
    if (e.id == id) return displaced(id, t);
    return {
        Verdict::missed, e.id, std::abs(reference::margin(references_[e.id], ray_)), HUGE_VAL, 0,
        false,           false};
  }
  return {touching ? Verdict::touching : Verdict::right, 0, 0, 0, 0, false, false};
}

Judgement Judge::judge_point(bool hit, double t) const {
  if (!hit) return judge(CAPLET_NONE, t);
  // The primitive whose surface is nearest to the reported point.
  std::uint32_t best = 0;
  for (std::uint32_t id = 1; id < references_.size(); ++id)
    if (std::abs(value(id, t)) < std::abs(value(best, t))) best = id;
  return judge(best, t);
}

}  // namespace caplet::test
