// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// All shapes and the switch over them. CAPLET_BASIC_SHAPES: scenes of spheres, capsules, triangles and disks alone need no other code, and
// their traversal is faster without it.
#ifndef CAPLET_SHAPES_SHAPES_CL
#define CAPLET_SHAPES_SHAPES_CL

#include "shapes/capsule.cl"
#include "shapes/disk.cl"
#include "shapes/sphere.cl"
#include "shapes/tapered_capsule.cl"
#include "shapes/triangle.cl"
#ifndef CAPLET_BASIC_SHAPES
#include "shapes/bilinear.cl"
#include "shapes/box.cl"
#include "shapes/cone.cl"
#include "shapes/csg.cl"
#include "shapes/cylinder.cl"
#include "shapes/open_cylinder.cl"
#include "shapes/partial_disk.cl"
#include "shapes/partial_sphere.cl"
#include "shapes/polyhedron.cl"
#endif

// Lanes of the leaf block that the ray hits, where, and which side of which surface it sees.
static inline real_mask shape_hit(uint shape, const ShapeRay* ray, __global const float* block, uint lane, real* t, real_mask* side) {
  switch (shape) {
#define SHAPE(name, rows) \
  case shape_##name: return name##_hit(ray, block, lane, t, side);
#ifdef CAPLET_BASIC_SHAPES
    SHAPE(capsule, 0)
    SHAPE(triangle, 0)
    SHAPE(sphere, 0)
    SHAPE(tapered_capsule, 0)
    SHAPE(disk, 0)
#else
#define COMPOUND(name, rows)
#include "shared/shapes.def"
    SHAPE(csg, 0)
#endif
#undef SHAPE
    default: break;
  }
  *t = real_of(0.0f);
  *side = int_of(0);
  return int_of(0);
}

#endif
