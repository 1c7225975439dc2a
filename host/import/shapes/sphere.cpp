// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>

#include "import/detail/pbrt/geometry.h"

namespace caplet::pbrt {

Geometry make_sphere(Parameters& parameters) {
  const double radius = positive_radius(parameters, 1);
  const double a = length(parameters, "zmin", -radius), b = length(parameters, "zmax", radius);
  const PartialSphereShape part{radius, std::clamp(std::min(a, b), -radius, radius),
                                std::clamp(std::max(a, b), -radius, radius), phi_max(parameters)};
  if (part.z_min == -radius && part.z_max == radius && part.phi_max == full_turn)
    return SphereShape{radius};
  if (part.z_min == part.z_max)
    parameters.error(parameters.has("zmin") ? "zmin" : "zmax",
                     "leaves nothing of the sphere: it ends where it begins");
  return part;
}

}  // namespace caplet::pbrt
