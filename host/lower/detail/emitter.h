// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds emissive primitives.
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace caplet {

/// Emitter is one emissive primitive as placed in the world.
struct Emitter {
  std::uint32_t slot, instance, geometry;
  std::uint32_t group;  // the same for the primitives of one shape as placed
  double area;          // world, of the surfaces that emit
  std::uint32_t spectrum;
  double scale;      // multiplies the spectrum
  double luminance;  // of the radiance, scale included
  bool two_sided;
  bool unseen;  // by rays: CAPLET_LIGHT_UNSEEN
  const AreaEmission*
      of_image;    // where it has an image, whose mean luminance is not in `luminance`; or null
  bool by_ball;    // sampled by the bounding ball (kernels/lights/shapes/ball.cl)
  double ball[4];  // centre and radius, world
  // The light tree uses these: the box in the world; the direction that it shines to, or 0 for all.
  double min[3], max[3], axis[3];
};

}  // namespace caplet
