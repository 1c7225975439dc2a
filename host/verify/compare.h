// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Compares one ray on the device with the reference: their disagreements, and the size of the
// differences where they agree.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "reference/scene_reference.h"
#include "scene/scene.h"
#include "shared/records.h"
#include "verify/bounds.h"

namespace caplet::verify {

/// The quantities that are measured at a crossing.
enum class Quantity {
  t,       // the distance of the ray from the surface between both parameters
  point,   // distance of the reported point from the surface
  normal,  // length of the difference of unit vectors
  uv,      // greater of both differences
};
inline constexpr std::array quantity_names = {"t", "point", "normal", "uv"};

struct Deviation {
  double in_bounds = 0;  // in units of the allowed deviation: more than 1 is a disagreement
  double in_ulps = 0;  // in units in the last place (of t; of the point's largest coordinate; of 1)
};

/// A crossing that both find.
struct Match {
  std::size_t primitive = 0;  // reference index
  std::array<Deviation, quantity_names.size()> deviations;
};

/// The subject of a disagreement.
enum class Fault { hit, id, surface, order, side, material, t, point, normal, uv };
inline constexpr std::array fault_names = {"hit",      "id", "surface", "order",  "side",
                                           "material", "t",  "point",   "normal", "uv"};

struct Disagreement {
  Fault fault = Fault::hit;
  std::size_t primitive = 0;  // reference index, or no_primitive
  std::string text;
};
inline constexpr std::size_t no_primitive = ~std::size_t{0};

/// The reference's answer for a ray, which is the same for all devices.
struct Expected {
  reference::Ray ray;
  std::vector<reference::SceneHit> hits;  // in order
  std::vector<std::uint32_t> near;        // primitives whose balls the line hits
};

/// A device's answer.
struct Found {
  PickRecord nearest;
  std::span<const PickRecord> list;  // all crossings
};

struct Outcome {
  std::vector<Match> matches;
  std::vector<Disagreement> disagreements;
  std::vector<std::size_t> grazed;  // primitives where both answers are right: the line touches
                                    // within the bound, or begins there
};

class Comparison {
 public:
  /// Scene and reference must outlive this. `is_moving`: as for Bounds.
  Comparison(const Scene& scene, const reference::SceneReference& reference,
             bool is_moving = false);

  Expected expected(const RayRecord& ray) const;
  Outcome compare(const Expected& expected, const Found& found) const;
  const Bounds& bounds() const { return bounds_; }

 private:
  struct Pair;  // the crossings of one primitive
  std::size_t primitive_of(const PickRecord& pick) const;
  std::string name_of(std::size_t primitive) const;
  void compare_primitive(const Expected& expected, Pair& pair, Outcome& out) const;
  void compare_nearest(const Expected& expected, const PickRecord& nearest, Outcome& out) const;
  Match measure(const LocalRay& local, const reference::SceneHit& hit, const PickRecord& pick,
                const reference::Ray& ray) const;

  const Scene& scene_;
  const reference::SceneReference& reference_;
  Bounds bounds_;
};

}  // namespace caplet::verify
