// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What each primitive of a scene may be off by, for a ray: the kernels' stated bounds (docs/numerics.md) and the rounding of the
// scene's numbers to 32-bit floats on their way to the device.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "reference/scene_witness.h"

namespace caplet::verify {

/// Half the distance from 1 to the next float: what rounding to a float changes at most, relative.
inline constexpr double eps = 0x1p-24;

/// A ray in the space of a primitive.
struct LocalRay {
  const reference::Primitive* primitive;
  reference::Ray ray;  // t in (0, infinity)
  double bound;        // most that a crossing may be off the primitive's surface, in its space
  double value(double t) const { return reference::value(*primitive, ray.origin + t * ray.direction); }
};

class Bounds {
 public:
  explicit Bounds(const reference::SceneWitness& witness);

  LocalRay local(std::size_t primitive, const reference::Ray& ray) const;
  /// A world length of any direction is at most this long in the primitive's space.
  double stretch(std::size_t primitive) const { return places_[primitive].object_stretch; }
  /// Product of the stretches there and back: 3 for similarities.
  double condition(std::size_t primitive) const { return places_[primitive].object_stretch * places_[primitive].world_stretch; }
  /// Rounding of the primitive's own numbers, and of those of its transform, to floats: as far as a point of its surface may move
  /// in the world.
  double rounding(std::size_t primitive) const;
  /// Angle (radians, world) by which that, and the kernels' differences of its points, may turn the primitive's planes and axis.
  double tilt(std::size_t primitive) const;

 private:
  struct Place {
    double object_stretch, world_stretch, world_size, object_shift;
    double corner;  // of csg shapes: how far their solids' boxes reach from the ball's centre
  };
  const reference::SceneWitness* witness_;
  std::vector<Place> places_;
};

}  // namespace caplet::verify
