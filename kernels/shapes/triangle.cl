// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is the watertight ray-triangle test of Woop, Benthin and Wald, "Watertight ray/triangle
// intersection", JCGT 2013.
//
// The ray becomes the z axis by a shear that depends on the ray alone, so a shared vertex has the
// same 2D coordinates in all its triangles. Edge functions of these are within two units in the
// last place, so the sign is right and opposite in the neighbour, and weights of thin triangles are
// as good as others'. Zero counts as inside on both sides.
#ifndef CAPLET_SHAPES_TRIANGLE_CL
#define CAPLET_SHAPES_TRIANGLE_CL

#include "shapes/lanes.cl"

// Returns a b - c d to two units in the last place (Kahan; Jeannerod, Louvet and Muller 2013).
static inline real edge_function(real a, real b, real c, real d) {
  const real cd = c * d;
  return fma(a, b, -cd) + fma(-c, d, cd);
}

// Returns a vertex, whose components come in the order of the ray's axes, from the ray's origin and
// after the shear.
static inline RealVector triangle_vertex(const TriangleRay* axes, real x, real y, real z) {
#pragma OPENCL FP_CONTRACT OFF
  RealVector v;
  v.z = z - axes->koz;
  v.x = (x - axes->kox) - axes->shear_x * v.z;
  v.y = (y - axes->koy) - axes->shear_y * v.z;
  return v;
}

// a, b, c: triangle_vertex().
static inline real_mask triangle_hit_of(const TriangleRay* axes, RealVector a, RealVector b,
                                        RealVector c, real* t, real_mask* side) {
#pragma OPENCL FP_CONTRACT OFF
  const real u = edge_function(c.x, b.y, c.y, b.x);
  const real v = edge_function(a.x, c.y, a.y, c.x);
  const real w = edge_function(b.x, a.y, b.y, a.x);
  const real det = u + v + w;
  const real_mask inside =
      ((u >= 0.0f) & (v >= 0.0f) & (w >= 0.0f)) | ((u <= 0.0f) & (v <= 0.0f) & (w <= 0.0f));
  // This is a convex combination of the vertices' z: off by 6 eps max |z| at most.
  *t = ((u * a.z + v * b.z + w * c.z) / det) * axes->inv_dz;
  // det is minus twice the area in the ray's plane, positive counter-clockwise: the normal points
  // along the ray where its sign and dz's differ.
  *side = det * axes->inv_dz < 0.0f ? int_of(CAPLET_LEAVING) : int_of(0);
  return inside & (det != 0.0f);
}

static inline real_mask triangle_hit(const ShapeRay* ray, __global const float* block, uint lane,
                                     real* t, real_mask* side) {
  const TriangleRay axes = triangle_ray_of(ray);
  __global const float* v0 = block + 8 * (1 + triangle_at_v0);
  __global const float* rx = v0 + axes.row_x;
  __global const float* ry = v0 + axes.row_y;
  __global const float* rz = v0 + axes.row_z;
  const int v1 = 8 * (triangle_at_v1 - triangle_at_v0), v2 = 8 * (triangle_at_v2 - triangle_at_v0);
  return triangle_hit_of(
      &axes, triangle_vertex(&axes, real_load(rx, lane), real_load(ry, lane), real_load(rz, lane)),
      triangle_vertex(&axes, real_load(rx + v1, lane), real_load(ry + v1, lane),
                      real_load(rz + v1, lane)),
      triangle_vertex(&axes, real_load(rx + v2, lane), real_load(ry + v2, lane),
                      real_load(rz + v2, lane)),
      t, side);
}

static inline Span triangle_span(const ShapeRay* ray, __global const float* block, uint lane) {
  real t;
  real_mask side;
  const real_mask hit = triangle_hit(ray, block, lane, &t, &side);
  return span_of_one(hit, t, side);
}

#endif
