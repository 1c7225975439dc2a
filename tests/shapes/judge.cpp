// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "judge.h"
#include "floats.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "shared/kinds.h"

namespace caplet::test {

namespace {

using glm::dvec3;

bool is_leaving(const HitRecord& hit) { return (hit.surface & CAPLET_LEAVING) != 0; }

/// The hit lies on the shape and on the surface that it names. Returns what is wrong, or an empty
/// text.
std::string wrong_place(const Case& c, const HitRecord& hit, double* ratio) {
  const double off = std::abs(c.value(hit.t));
  *ratio = off / c.bound;
  if (!(off <= c.bound)) {
    // Edge-on, triangles and patches are met beside themselves.
    const bool sheet = c.primitive->shape == shape_triangle || c.primitive->shape == shape_bilinear;
    *ratio = 0;
    if (!(sheet && off <= reference::bounding_ball(*c.reference).radius && c.touches()))
      return fmt::format("the hit at {} is {} off the surface, allowed {}", hit.t, off, c.bound);
    return {};
  }
  const auto surface = static_cast<int>(hit.surface & CAPLET_SURFACE_MASK);
  if (const double away = reference::distance_from_surface(*c.reference, c.at(hit.t), surface);
      reference::surface_count(*c.reference) > 1 && !(away <= 2 * c.bound))
    return fmt::format("the hit at {} is {} from surface {}, allowed {}", hit.t, away, surface,
                       2 * c.bound);
  return {};
}

/// Crossings of reference and device side by side: the same number, each between the same sides, at
/// the same place of the surface.
std::string different(const Case& c, const std::vector<reference::Crossing>& expected,
                      const std::vector<HitRecord>& list) {
  if (expected.size() != list.size())
    return fmt::format("{} crossings, the reference says {}", list.size(), expected.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (expected[i].leaving != is_leaving(list[i]))
      return fmt::format("crossing {} at {} leaving {}, the reference says {} at {}", i, list[i].t,
                         is_leaving(list[i]), expected[i].leaving, expected[i].t);
    // Between both parameters the ray stays near the surface.
    if (!(std::abs(c.value(0.5 * (expected[i].t + double(list[i].t)))) <= 2 * c.bound))
      return fmt::format("crossing {} at {}, the reference says {}", i, list[i].t, expected[i].t);
  }
  return {};
}

}  // namespace

std::string wrong_way(const Case& c, const std::vector<HitRecord>& list, double slack) {
  const auto crossings = reference::crossings(*c.reference, c.ray);
  bool inside = !list.empty() && is_leaving(list[0]);
  for (std::size_t i = 0; i < list.size(); ++i)
    if (is_leaving(list[i]) != (inside == (i % 2 == 0)))
      return fmt::format("crossing {} does not take turns", i);
  double last = 0;
  for (std::size_t i = 0; i <= list.size(); ++i, inside = !inside) {
    const double end = i < list.size() ? double(list[i].t) : HUGE_VAL;
    // Stretches between crossings of the reference, with what lies before the first and behind the
    // last, on the other side.
    for (std::size_t k = 0; k <= crossings.size(); ++k) {
      const bool reference_inside = k > 0 && !crossings[k - 1].leaving;
      if (reference_inside == inside) continue;
      double low = k > 0 ? crossings[k - 1].t : -HUGE_VAL,
             high = k < crossings.size() ? crossings[k].t : HUGE_VAL;
      low = std::max(low, last);
      high = std::min(high, end);
      if (!(low < high)) continue;
      if (!std::isfinite(high)) return fmt::format("inside behind {}, where nothing is", last);
      constexpr int samples = 64;
      for (int n = 1; n < samples; ++n)
        if (const double t = low + (high - low) * n / samples; std::abs(c.value(t)) > slack)
          return fmt::format("said to be {} at {}, where the value is {}; allowed {}",
                             inside ? "inside" : "outside", t, c.value(t), slack);
    }
    last = end;
  }
  return {};
}

Case make_case(const FlatPrimitive& primitive, const reference::Primitive& reference,
               const RayRecord& ray) {
  return {&primitive, &reference, reference_ray(ray), surface_bound(primitive, reference, ray)};
}

Case make_case(const PlacedPrimitive& placed, const reference::Primitive& reference,
               const RayRecord& world_ray) {
  const reference::Ray world = reference_ray(world_ray);
  const std::array<float, 12>& m = placed.object_from_world;
  Case c{&placed.primitive, &reference, {}, 0};
  dvec3 terms{0}, slopes{0};
  for (int r = 0; r < 3; ++r) {
    const auto row = static_cast<std::size_t>(4 * r);
    c.ray.origin[r] = m[row + 3];
    c.ray.direction[r] = 0;
    terms[r] = std::abs(double(m[row + 3]));
    for (int k = 0; k < 3; ++k) {
      const double entry = m[row + static_cast<std::size_t>(k)];
      c.ray.origin[r] += entry * world.origin[k];
      c.ray.direction[r] += entry * world.direction[k];
      terms[r] += std::abs(entry * world.origin[k]);
      slopes[r] += std::abs(entry * world.direction[k]);
    }
  }
  const reference::Ball ball = reference::bounding_ball(reference);
  // docs/numerics.md, "Instances": 4 eps of the terms of the origin, and as much of those of t d
  // where the shape is.
  const double t =
      (glm::length(c.ray.origin - ball.center) + ball.radius) / glm::length(c.ray.direction);
  c.bound = surface_bound(placed.primitive, reference, make_ray(c.ray.origin, c.ray.direction)) +
            4 * eps * (glm::length(terms) + t * glm::length(slopes));
  return c;
}

Judgement judge(const Case& c, const Listed& listed, std::uint32_t capacity) {
  Judgement out;
  const auto note = [&](std::string text) {
    if (out.wrong.empty()) out.wrong = std::move(text);
  };
  const bool hit = listed.nearest.slot != CAPLET_NONE;
  if (listed.count > capacity) note("more crossings than the list holds");
  // Where the ray begins at the surface, which side it begins on is rounding, and the formulas for
  // one crossing and for both may differ.
  const bool begins_there = std::abs(c.value(0)) <= c.bound;
  if (listed.any != hit || (hit == listed.all.empty() && !begins_there))
    note("nearest, any and the list do not agree on whether there is a hit");
  // The list has the leaving one of two crossings at one t first.
  if (hit && !listed.all.empty()) {
    const auto same = [&](std::size_t i) {
      const HitRecord& other = listed.all[i];
      return listed.nearest.t == other.t && listed.nearest.surface == other.surface &&
             listed.nearest.slot == other.slot;
    };
    if (!begins_there && !same(0) && !(listed.all.size() > 1 && same(1)))
      note(fmt::format("the nearest hit is at {}, the first of the list at {}", listed.nearest.t,
                       listed.all[0].t));
  }
  for (std::size_t i = 0; i < listed.all.size(); ++i) {
    double ratio = 0;
    note(wrong_place(c, listed.all[i], &ratio));
    out.worst = std::max(out.worst, ratio);
    if (!(listed.all[i].t > 0) || (i > 0 && !(listed.all[i].t >= listed.all[i - 1].t)))
      note("the list is not in order");
  }
  if (std::holds_alternative<reference::Csg>(*c.reference)) {
    note(wrong_way(c, listed.all, 2 * c.bound));
  } else {
    std::vector<reference::Crossing> expected;
    for (const reference::Crossing& crossing : reference::crossings(*c.reference, c.ray))
      if (crossing.t > 0) expected.push_back(crossing);
    if (const std::string text = different(c, expected, listed.all); !text.empty()) {
      // Where the ray begins at the surface, which side it begins on is rounding; else the referee
      // has to say that the line touches.
      out.excused = std::abs(c.value(0)) <= c.bound || c.touches();
      if (!out.excused) note(text);
    }
  }
  return out;
}

std::string described(const FlatPrimitive& p, const RayRecord& r) {
  std::string out = fmt::format("shape {}:", p.shape);
  for (const float x : p.data) out += fmt::format(" {:a}", x);
  return out +
         fmt::format("\nray: {:a} {:a} {:a}  {:a} {:a} {:a}", r.ox, r.oy, r.oz, r.dx, r.dy, r.dz);
}

}  // namespace caplet::test
