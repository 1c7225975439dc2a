// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Cylinder: a cone of equal radii.
#ifndef CAPLET_SHAPES_SURFACE_CYLINDER_CL
#define CAPLET_SHAPES_SURFACE_CYLINDER_CL

#include "shapes/surface_cone.cl"

static inline LocalSurface surface_cylinder(const SurfaceQuery* q) {
  return cone_point(q, data3(q->data, 0), data3(q->data, 3), q->data[48], q->data[48], q->data[56], q->data[64]);
}

#endif
