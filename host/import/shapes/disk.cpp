// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt/geometry.h"

namespace caplet::pbrt {

DiskShape make_disk(Parameters& parameters) {
  DiskShape disk;
  disk.height = length(parameters, "height", 0);
  disk.radius = positive_radius(parameters, 1);
  disk.inner_radius = parameters.number("innerradius", 0);
  if (!(disk.inner_radius >= 0 && disk.inner_radius < disk.radius)) {
    parameters.error("innerradius", "must be from 0 up and below the radius");
    disk.inner_radius = 0;
  }
  disk.phi_max = phi_max(parameters);
  return disk;
}

}  // namespace caplet::pbrt
