// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Bounds the error of each primitive for a ray: the kernels' stated bounds (docs/numerics.md) and
// the rounding of the scene's numbers to 32-bit floats on their way to the device.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "reference/scene_reference.h"

namespace caplet::verify {

/// Half the distance from 1 to the next float: the greatest relative error of rounding to a float.
inline constexpr double eps = 0x1p-24;

/// A ray in the space of a primitive.
struct LocalRay {
  const reference::Primitive* primitive;
  reference::Ray ray;  // t in (0, infinity)
  double bound;        // the most that a crossing may be off the primitive's surface, in its space
  double value(double t) const {
    return reference::value(*primitive, ray.origin + t * ray.direction);
  }
};

class Bounds {
 public:
  /// `is_moving`: devices have the transforms of this scene from motions (numerics.md).
  explicit Bounds(const reference::SceneReference& reference, bool is_moving = false);

  LocalRay local(std::size_t primitive, const reference::Ray& ray) const;
  /// Returns the longest image, in the primitive's space, of a world vector of length 1.
  double stretch(std::size_t primitive) const { return places_[primitive].object_stretch; }
  /// Returns the product of the stretches in both directions: 3 for similarities.
  double condition(std::size_t primitive) const {
    return places_[primitive].object_stretch * places_[primitive].world_stretch;
  }
  /// Bounds how far a point of the surface may move in the world by the rounding of the primitive's
  /// numbers and of its transform to floats.
  double rounding(std::size_t primitive) const;
  /// Bounds the angle (radians, world) by which that, and the kernels' differences of its points,
  /// may turn its planes and axis.
  double tilt(std::size_t primitive) const;

 private:
  struct Place {
    double object_stretch, world_stretch, world_size, object_shift;
    double corner;  // for csg shapes: the greatest distance of a box of their solids from the
                    // ball's centre
  };
  const reference::SceneReference* reference_;
  double matrix_roundings_;  // that an entry of a transform has more than a rounded one
  std::vector<Place> places_;
};

}  // namespace caplet::verify
