// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The rays of `verify`: camera rays, diffuse bounces, chords between primitives, and hard ones.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "reference/scene_reference.h"
#include "scene/scene.h"
#include "shared/records.h"
#include "verify/random.h"

namespace caplet::verify {

enum class RayFamily {
  camera,    // through the centre of a random pixel
  bounce,    // from the hit of a camera ray or chord, cosine-distributed
  chord,     // between two primitives: from outside, or from between them
  touching,  // along the tangent plane of a surface point, offset by up to 1e-8 to 1e-1 of the size
  grazing,   // to a surface point, at 1e-6 to 1e-1 to its tangent plane
  rim,       // through a point where two surfaces meet, or where an open one ends
  axis,      // along a coordinate axis, with zeros of both signs, to a surface point or beside it
  far,       // to a surface point, from 10 to 1e6 times the size away
  inside,    // from within
  on_surface  // from a surface point after rounding
};
inline constexpr std::array family_names = {"camera", "bounce", "chord", "touching", "grazing",
                                            "rim",    "axis",   "far",   "inside",   "on_surface"};

struct VerifyRay {
  RayRecord ray{};
  RayFamily family = RayFamily::chord;
};

/// Ray number `index` of a scene depends only on the seed and the index. All are finite, with t in
/// (0, infinity).
class RaySource {
 public:
  /// Both arguments must outlive this.
  RaySource(const Scene& scene, const reference::SceneReference& reference, std::uint64_t seed);
  VerifyRay ray(std::uint64_t index) const;

 private:
  struct Point;
  std::size_t primitive(Random& random) const;
  Point surface_point(std::size_t primitive, Random& random) const;
  RayRecord camera_ray(Random& random) const;
  RayRecord chord(Random& random) const;
  std::optional<RayRecord> bounce(Random& random) const;
  std::optional<RayRecord> hard(RayFamily family, Random& random) const;
  std::optional<Point> rim(std::size_t primitive, Random& random) const;

  const Scene& scene_;
  const reference::SceneReference& reference_;
  std::uint64_t seed_;
  std::vector<std::vector<std::size_t>> by_kind_;  // the primitives of each existing kind
};

/// Rounds a ray to a record of floats.
RayRecord ray_record(const glm::dvec3& origin, const glm::dvec3& direction);

}  // namespace caplet::verify
