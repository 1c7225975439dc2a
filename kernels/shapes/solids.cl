// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The closed solids of one span each: what csg shapes combine.
#ifndef CAPLET_SHAPES_SOLIDS_CL
#define CAPLET_SHAPES_SOLIDS_CL

#include "shapes/box.cl"
#include "shapes/capsule.cl"
#include "shapes/cone.cl"
#include "shapes/cylinder.cl"
#include "shapes/polyhedron.cl"
#include "shapes/sphere.cl"
#include "shapes/tapered_capsule.cl"

static inline Span solid_span(uint shape, const ShapeRay* ray, __global const float* block, uint lane) {
  switch (shape) {
    case shape_sphere: return sphere_span(ray, block, lane);
    case shape_capsule: return capsule_span(ray, block, lane);
    case shape_tapered_capsule: return tapered_capsule_span(ray, block, lane);
    case shape_cylinder: return cylinder_span(ray, block, lane);
    case shape_cone: return cone_span(ray, block, lane);
    case shape_box: return box_span(ray, block, lane);
    default: return polyhedron_span(ray, block, lane);
  }
}

#endif
