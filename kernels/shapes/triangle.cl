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

static inline real_mask triangle_hit(const ShapeRay* ray, __global const float* block, uint lane,
                                     real* t, real_mask* side) {
#pragma OPENCL FP_CONTRACT OFF
  const TriangleRay axes = triangle_ray_of(ray);
  __global const float* v0 = block + 8 * (1 + triangle_at_v0);
  __global const float* rx = v0 + axes.row_x;
  __global const float* ry = v0 + axes.row_y;
  __global const float* rz = v0 + axes.row_z;
  const int v1 = 8 * (triangle_at_v1 - triangle_at_v0), v2 = 8 * (triangle_at_v2 - triangle_at_v0);
  const real az = real_load(rz, lane) - axes.koz, bz = real_load(rz + v1, lane) - axes.koz,
             cz = real_load(rz + v2, lane) - axes.koz;
  const real ax = (real_load(rx, lane) - axes.kox) - axes.shear_x * az;
  const real ay = (real_load(ry, lane) - axes.koy) - axes.shear_y * az;
  const real bx = (real_load(rx + v1, lane) - axes.kox) - axes.shear_x * bz;
  const real by = (real_load(ry + v1, lane) - axes.koy) - axes.shear_y * bz;
  const real cx = (real_load(rx + v2, lane) - axes.kox) - axes.shear_x * cz;
  const real cy = (real_load(ry + v2, lane) - axes.koy) - axes.shear_y * cz;
  const real u = edge_function(cx, by, cy, bx);
  const real v = edge_function(ax, cy, ay, cx);
  const real w = edge_function(bx, ay, by, ax);
  const real det = u + v + w;
  const real_mask inside =
      ((u >= 0.0f) & (v >= 0.0f) & (w >= 0.0f)) | ((u <= 0.0f) & (v <= 0.0f) & (w <= 0.0f));
  // This is a convex combination of the vertices' z: off by 6 eps max |z| at most.
  *t = ((u * az + v * bz + w * cz) / det) * axes.inv_dz;
  // det is minus twice the area in the ray's plane, positive counter-clockwise: the normal points
  // along the ray where its sign and dz's differ.
  *side = det * axes.inv_dz < 0.0f ? int_of(CAPLET_LEAVING) : int_of(0);
  return inside & (det != 0.0f);
}

static inline Span triangle_span(const ShapeRay* ray, __global const float* block, uint lane) {
  real t;
  real_mask side;
  const real_mask hit = triangle_hit(ray, block, lane, &t, &side);
  return span_of_one(hit, t, side);
}

#endif
