// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A cylinder is a cone of equal radii.
#ifndef CAPLET_SHAPES_SURFACE_CYLINDER_CL
#define CAPLET_SHAPES_SURFACE_CYLINDER_CL

#include "shapes/surface_cone.cl"

static inline LocalSurface surface_cylinder(const SurfaceQuery* q) {
  return cone_point(q, cylinder_p0(q->data), cylinder_p1(q->data), cylinder_r(q->data),
                    cylinder_r(q->data), cylinder_cap0(q->data), cylinder_cap1(q->data));
}

#endif
