// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// These are rays whose crossings are known by construction. A line through two points of a convex
// solid's surface crosses it in these two alone; a line that is steeper than a sheet is anywhere
// crosses it once; one in a plane clear of a solid's supporting plane misses it. No intersection
// formula is needed, so none can be shared with the kernels.
#pragma once

#include <cstdint>
#include <vector>

#include "lower/linking.h"
#include "scene/scene.h"
#include "shared/kinds.h"
#include "shared/records.h"

namespace caplet {

struct KnownCrossing {
  enum class Side {
    entering,
    leaving,
    either
  };             // either: of sheets it depends on what their normal is
  double t = 0;  // in lengths of the ray's direction
  Side side = Side::either;
};

struct KnownRay {
  int kind = 0;              // shape_sphere, ... (kinds.h)
  std::uint32_t object = 0;  // as PickRecord.object
  RayRecord ray{};
  std::vector<KnownCrossing> crossings;  // in order; at least a tenth of a direction's length apart
};

/// Returns the kinds (bit k: kind k) of a scene that tests kernels for scenes of `shapes`, and what
/// they are built for: these; with csg shapes the operands of known ones; and with kinds that only
/// instances can rotate, instances.
std::uint64_t shapes_on_trial(std::uint64_t shapes);

struct KnownScene {
  Scene scene;
  std::vector<KnownRay> rays;
};
/// Returns shapes of every kind of shapes_on_trial(shapes), each rotated, and, where there are
/// instances, some stretched, mirrored or one-sided. They are far enough from each other that no
/// ray meets two of them.
KnownScene known_scene(std::uint64_t shapes);

/// Returns which capsules of known scenes are linked: those of that kind.
Linking links_of_known();

/// Returns "sphere" for shape_sphere.
const char* shape_name(int kind);

}  // namespace caplet
