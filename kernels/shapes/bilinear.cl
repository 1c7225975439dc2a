// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A bilinear patch is (1-u)(1-v) p00 + u (1-v) p10 + (1-u) v p01 + u v p11.
//
// As in Reshetov ("Cool patches", Ray Tracing Gems, 2019), the line of constant u that meets the
// ray is found first. Here that is done in the ray's own plane: sheared as for triangles, the ray
// is the z axis and a shared vertex has one place for all its patches. The line from A(u) on one
// edge to B(u) on the other passes the origin where
//   A x B = f0 (1-u)^2 + F u (1-u) + f1 u^2 = 0,
//   f0 = q00 x q01, f1 = q10 x q11, F = q00 x q11 + q10 x q01,
// so with D^2 = F^2 - 4 f0 f1 and k = -(F +- D) / 2, the sign that of F, the roots are u : 1-u = k
// : f1 and f0 : k. Nothing cancels for u in [0, 1], and whether it is there are the signs of k and
// of the exact edge functions f0 or f1. The slope of A x B is the Jacobian of the map to the plane,
// -+D: one root is seen from the front and the other from behind, so a patch has at most one of
// either.
//
// A root is then polished by two damped Newton steps on (u, v), clamped to the patch; it counts if
// the patch's point there is within 2^-20 of the patch's extent in the plane from the ray, and
// still on the root's side of any fold (a root off the patch may be led to the other one). Rays
// that pass an edge closer than that count as touching: neighbours may both be hit there, but not
// neither. The reported point is within 24 eps (|o - p00| + size) of the patch (docs/numerics.md,
// "Patches").
//
// The entering crossing may come after the leaving one: t_enter may be greater than t_exit.
#ifndef CAPLET_SHAPES_BILINEAR_CL
#define CAPLET_SHAPES_BILINEAR_CL

#include "shapes/triangle.cl"

// BilinearImage is the patch in the ray's plane, scaled to an extent of 1 to 2: a corner, the edges
// from it along u and v, and the twist; depths as given.
typedef struct {
  real x, y, z, ux, uy, uz, vx, vy, vz, wx, wy, wz;
} BilinearImage;

static inline real unit_clamp(real x) {
  return real_max(real_min(x, real_of(1.0f)), real_of(0.0f));
}

// Tests the crossing at u = num : rest, of one sign, where the Jacobian has that of `turn`. Returns
// the lanes in which it is on the patch, and its depth.
static inline real_mask bilinear_crossing(const BilinearImage* b, real num, real rest, real turn,
                                          real* depth) {
  real u = unit_clamp(num / (num + rest));
  real lx = b->vx + u * b->wx, ly = b->vy + u * b->wy;
  real px = b->x + u * b->ux, py = b->y + u * b->uy;
  real v = unit_clamp(-(px * lx + py * ly) / (lx * lx + ly * ly));
  px += v * lx;
  py += v * ly;
  real off = px * px + py * py;
  for (int i = 0; i < 2; i++) {
    const real mx = b->ux + v * b->wx, my = b->uy + v * b->wy;
    // The step solves (J J^T + damping) s = p; where the map folds, J is singular and the step
    // stays finite.
    const real xx = mx * mx + lx * lx, yy = my * my + ly * ly, xy = mx * my + lx * ly;
    const real damping = (xx + yy) * 0x1p-20f + 0x1p-60f;
    const real a = xx + damping, c = yy + damping, inv = 1.0f / (a * c - xy * xy);
    const real sx = (c * px - xy * py) * inv, sy = (a * py - xy * px) * inv;
    const real u1 = unit_clamp(u - (mx * sx + my * sy)), v1 = unit_clamp(v - (lx * sx + ly * sy));
    const real lx1 = b->vx + u1 * b->wx, ly1 = b->vy + u1 * b->wy;
    const real px1 = (b->x + u1 * b->ux) + v1 * lx1, py1 = (b->y + u1 * b->uy) + v1 * ly1;
    const real off1 = px1 * px1 + py1 * py1;
    const real_mask nearer = off1 < off;
    u = nearer ? u1 : u;
    v = nearer ? v1 : v;
    lx = nearer ? lx1 : lx;
    ly = nearer ? ly1 : ly;
    px = nearer ? px1 : px;
    py = nearer ? py1 : py;
    off = nearer ? off1 : off;
  }
  *depth = (b->z + u * b->uz) + v * (b->vz + u * b->wz);
  const real mx = b->ux + v * b->wx, my = b->uy + v * b->wy;
  const real jacobian = mx * ly - my * lx;
  // Both lines are off by some eps of the patch's size, so short ones turn by more.
  const real slack = 0x1p-22f * (fabs(mx) + fabs(my) + fabs(lx) + fabs(ly));
  return (off <= 0x1p-40f) & ((turn > 0.0f ? jacobian : -jacobian) >= -slack);
}

static inline Span bilinear_span(const ShapeRay* ray, __global const float* block, uint lane) {
#pragma OPENCL FP_CONTRACT OFF
  __global const float* p00 = block + 8 * (1 + bilinear_at_p00);
  const TriangleRay axes = triangle_ray_of(ray);
  __global const float* rx = p00 + axes.row_x;
  __global const float* ry = p00 + axes.row_y;
  __global const float* rz = p00 + axes.row_z;
  const int p10 = 8 * (bilinear_at_p10 - bilinear_at_p00),
            p01 = 8 * (bilinear_at_p01 - bilinear_at_p00),
            p11 = 8 * (bilinear_at_p11 - bilinear_at_p00);
  const real z00 = real_load(rz, lane) - axes.koz, z10 = real_load(rz + p10, lane) - axes.koz;
  const real z01 = real_load(rz + p01, lane) - axes.koz, z11 = real_load(rz + p11, lane) - axes.koz;
  real x00 = (real_load(rx, lane) - axes.kox) - axes.shear_x * z00,
       y00 = (real_load(ry, lane) - axes.koy) - axes.shear_y * z00;
  real x10 = (real_load(rx + p10, lane) - axes.kox) - axes.shear_x * z10,
       y10 = (real_load(ry + p10, lane) - axes.koy) - axes.shear_y * z10;
  real x01 = (real_load(rx + p01, lane) - axes.kox) - axes.shear_x * z01,
       y01 = (real_load(ry + p01, lane) - axes.koy) - axes.shear_y * z01;
  real x11 = (real_load(rx + p11, lane) - axes.kox) - axes.shear_x * z11,
       y11 = (real_load(ry + p11, lane) - axes.koy) - axes.shear_y * z11;
  Span span = span_of(int_of(0), real_of(0.0f), real_of(0.0f));
  // The ray must pass the box of the corners' images.
  const real low_x = real_min(real_min(x00, x10), real_min(x01, x11)),
             high_x = real_max(real_max(x00, x10), real_max(x01, x11));
  const real low_y = real_min(real_min(y00, y10), real_min(y01, y11)),
             high_y = real_max(real_max(y00, y10), real_max(y01, y11));
  const real extent = real_max(real_max(-low_x, high_x), real_max(-low_y, high_y));
  const real room = extent * 0x1p-20f;
  const real_mask near =
      (low_x <= room) & (high_x >= -room) & (low_y <= room) & (high_y >= -room) & (extent > 0.0f);
  if (mask_bits(near) == 0) return span;

  const real scale = real_power_of_two_below_inverse(extent);
  x00 *= scale, y00 *= scale, x10 *= scale, y10 *= scale;
  x01 *= scale, y01 *= scale, x11 *= scale, y11 *= scale;
  // The family of lines whose roots are known better is chosen: f0, F and f1 are off by eps of
  // their size, and that over the length of the lines is an error of distance. Where the patch
  // crosses over itself, seen along the ray, the lines of one family are short and many while those
  // of the other are long and few.
  const real along_u = fabs(x10 - x00) + fabs(y10 - y00) + fabs(x11 - x01) + fabs(y11 - y01);
  const real along_v = fabs(x01 - x00) + fabs(y01 - y00) + fabs(x11 - x10) + fabs(y11 - y10);
  const real near_u = edge_function(x00, y01, y00, x01), far_u = edge_function(x10, y11, y10, x11);
  const real near_v = edge_function(x00, y10, y00, x10), far_v = edge_function(x01, y11, y01, x11);
  const real across = edge_function(x00, y11, y00, x11), other = edge_function(x10, y01, y10, x01);
  const real_mask swap = (fabs(near_u) + fabs(far_u) + fabs(across + other)) * along_u >
                         (fabs(near_v) + fabs(far_v) + fabs(across - other)) * along_v;
  const real ax = swap ? x01 : x10, ay = swap ? y01 : y10, az = swap ? z01 : z10;  // u = 1, v = 0
  const real bx = swap ? x10 : x01, by = swap ? y10 : y01, bz = swap ? z10 : z01;  // u = 0, v = 1
  const real f0 = swap ? near_v : near_u, f1 = swap ? far_v : far_u;
  const real f = across + (swap ? -other : other);
  const real disc = edge_function(f, f, 4.0f * f0, f1);
  const real_mask meets = near & (disc >= 0.0f);
  if (mask_bits(meets) == 0) return span;
  const real d = sqrt(real_max(disc, real_of(0.0f)));
  const real_mask negative = f < 0.0f;
  const real k = 0.5f * (negative ? d - f : -d - f);

  BilinearImage b;
  b.x = x00, b.y = y00, b.z = z00;
  b.ux = ax - x00, b.uy = ay - y00, b.uz = az - z00;
  b.vx = bx - x00, b.vy = by - y00, b.vz = bz - z00;
  b.wx = (x11 - bx) - b.ux, b.wy = (y11 - by) - b.uy, b.wz = (z11 - bz) - b.uz;
  // The normal points along the ray where the Jacobian (turned by the swap) and the ray's z have
  // one sign; at k : f1 it has the sign of k.
  const real sense = (negative ? real_of(axes.inv_dz) : real_of(-axes.inv_dz)) *
                     (swap ? real_of(-1.0f) : real_of(1.0f));
  const real_mask first_leaves = sense > 0.0f;
  const real_mask first = k >= 0.0f ? f1 >= 0.0f : f1 <= 0.0f,
                  second = k >= 0.0f ? f0 >= 0.0f : f0 <= 0.0f;
  real depth;
  span.enter = meets & (first_leaves ? second : first);
  span.enter &= bilinear_crossing(&b, first_leaves ? f0 : k, first_leaves ? k : f1,
                                  first_leaves ? -k : k, &depth);
  span.t_enter = depth * axes.inv_dz;
  span.exit = meets & (first_leaves ? first : second);
  span.exit &= bilinear_crossing(&b, first_leaves ? k : f0, first_leaves ? f1 : k,
                                 first_leaves ? k : -k, &depth);
  span.t_exit = depth * axes.inv_dz;
  return span;
}

static inline real_mask bilinear_hit(const ShapeRay* ray, __global const float* block, uint lane,
                                     real* t, real_mask* side) {
  const Span span = bilinear_span(ray, block, lane);
  const real_mask enter = span.enter & (span.t_enter > ray->t_min) & int_of(ray->sees_entering);
  const real_mask exit = span.exit & (span.t_exit > ray->t_min) & int_of(ray->sees_leaving);
  const real never = real_of(INFINITY);
  const real t_enter = enter ? span.t_enter : never, t_exit = exit ? span.t_exit : never;
  *t = real_min(t_enter, t_exit);
  *side = t_enter <= t_exit ? int_of(0) : int_of(CAPLET_LEAVING);
  return enter | exit;
}

#endif
