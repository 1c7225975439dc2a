// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds what the surface functions of all shapes share: the result, and unit vectors that
// never become NaN.
#ifndef CAPLET_SHAPES_SURFACE_LOCAL_CL
#define CAPLET_SHAPES_SURFACE_LOCAL_CL

#include "groups.cl"
#include "math/vector.cl"
#include "shapes/fields.cl"
#include "shapes/placed.cl"

// LocalSurface is a point of a shape in the space in which its data is stored (world, or an
// instance's object space).
typedef struct {
  float3 p;           // on the surface, within `error`
  float3 ng;          // unit; outward of solids, by winding or stored normal for open shapes
  float3 ns;          // unit shading normal, on ng's side
  float3 dpdu, dpdv;  // derivatives of the point by uv; zero where they are undefined (poles)
  float2 uv;
  float error;  // bound on the distance of p from the true surface (docs/numerics.md, "Surface
                // points")
  int along_u;  // 1: of a chain, whose axis lies along dpdu; those of other capsules, cylinders,
                // cones lie along dpdv
} LocalSurface;

// any_chain says that there may be capsules with u at their ends (FlatScene::has_chains). Programs
// for other scenes have no code of them.
#ifdef CAPLET_CHAINS
enum { any_chain = 1 };
#else
enum { any_chain = 0 };
#endif

// SurfaceQuery asks a surface function for the point of a shape's surface `surface` nearest to x,
// in the space its data is stored in.
typedef struct {
  const Surfaces* surfaces;
  Floats leaves;
  const GeometryRecord* geometry;
  uint primitive, surface;
  __global const float* data;  // shapes/fields.cl
  float3 x;
  float3 fallback;  // unit normal where x leaves it undefined
  // `space` is a rotation or reflection (3x4 row-major, no translation) that the shape is stored
  // under, if its uv depends on it; or 0.
  __global const float* space;
  float3 direction;               // of the ray, of any length, in the space of x
  __global const float* chain_u;  // u at p0 and at p1 of a capsule of a chain; 0: it is in none
  float time;                     // when the ray sees the scene (Tree)
} SurfaceQuery;

static inline float norm1(float3 v) { return fabs(v.x) + fabs(v.y) + fabs(v.z); }

// Returns v / |v| for any magnitude; `otherwise` when v is zero or not finite.
static inline float3 unit_or(float3 v, float3 otherwise) {
  const float scale = max3(fabs(v));
  if (!(scale > 0.0f && scale < INFINITY)) return otherwise;
  v = v / scale;
  const float length_squared = dot(v, v);  // in [1, 3]
  return length_squared < 4.0f ? v / sqrt(length_squared) : otherwise;
}

// Returns some unit vector perpendicular to the unit vector n.
static inline float3 perpendicular(float3 n) { return frame_from_normal(n).s; }

// Angles around `axis` (unit) run from s to t: in the shape's own space s is where +x goes when the
// shortest rotation takes +z, or -z for axes below -0.9, to the axis. The frame jumps there and not
// at the axes that people write.
static inline Frame turn_frame(__global const float* space, float3 axis) {
  const float3 n = space ? unit_or(transform_transposed(space, axis), axis) : axis;
  Frame f = frame_from_pole(n, n.z >= -0.9f ? 1.0f : -1.0f);
  if (space) {
    f.s = transform_vector(space, f.s);
    f.t = transform_vector(space, f.t);
    f.n = axis;
  }
  return f;
}
// Returns the z axis of the shape's own space.
static inline float3 own_z(__global const float* space) {
  return space ? (float3)(space[2], space[6], space[10]) : (float3)(0.0f, 0.0f, 1.0f);
}

// Returns the angle of `n` around the frame's n (both unit), over a full turn: in [0, 1).
static inline float turn_around(const Frame* f, float3 n) {
  const float turn = atan2(dot(n, f->t), dot(n, f->s)) * (0.5f * CAPLET_INV_PI);
  return turn < 0.0f ? fmin(turn + 1.0f, 0x1.fffffep-1f) : turn;
}

// Returns the derivative by that turn of a point at v from somewhere on the axis. Reflections turn
// the other way.
static inline float3 along_turn(const Frame* f, float3 v) {
  return (dot(cross(f->s, f->t), f->n) < 0.0f ? -2.0f : 2.0f) * CAPLET_PI * cross(f->n, v);
}

// Computes the uv of a chain's capsules, which are those of pbrt's curves: u is linear along the
// axis and constant on the caps, so that neighbours agree at their joint; v runs across the tube
// from 0 to 1 as the ray sees it. out->ng is the normal at the ball that stands `s` of the way from
// p0 to p1 and has `radius`; `c` is the part of the side's normal across the axis (unit), and
// `side` the length of the side.
static inline void chain_uv(const SurfaceQuery* q, float3 axis, float s, float c, float radius,
                            float side, LocalSurface* out) {
  const float u0 = q->chain_u[0], u1 = q->chain_u[1];
  // Both neighbours have the same number at their joint.
  const float u = s < 1.0f ? u0 + s * (u1 - u0) : u1;
  // On the caps dp/du continues as at the rim: in the plane of the axis, with the length that it
  // has there.
  const float rate = side / (u1 - u0);
  const float along = dot(axis, out->ng);
  out->dpdu =
      (fabs(rate) < INFINITY ? rate : side) * unit_or(axis - along * out->ng, (float3)(0.0f));
  // e is across the axis as the ray sees it, and f points against the ray: v = (1 + sin a) / 2 at
  // sin a e + cos a f.
  const float3 e = unit_or(cross(q->direction, axis), (float3)(0.0f)), f = cross(e, axis);
  const float3 across = out->ng - along * axis;
  const float turned =
      q->space && dot(cross(load3(q->space), load3(q->space + 4)), load3(q->space + 8)) < 0.0f
          ? -1.0f
          : 1.0f;
  out->uv = (float2)(u, clamp(0.5f + 0.5f * turned * dot(across, e) / c, 0.0f, 1.0f));
  const float cosine = dot(unit_or(across, f), f),
              steep = fabs(cosine) > 1e-3f ? cosine : copysign(1e-3f, cosine);
  out->dpdv = turned * (2.0f * radius * c / steep) * unit_or(cross(axis, across), (float3)(0.0f));
}

// Returns the angle between the unit vectors `axis` and `n`, in [0, pi]; accurate near the poles.
static inline float angle_between(float3 axis, float3 n) {
  return atan2(length(n - axis * dot(n, axis)), dot(n, axis));
}

// Returns the sum over columns of |m| |p|, translation included; roundings of affine_point(m, p)
// are proportional to it.
static inline float3 affine_magnitude(const Affine* of, float3 p) {
  const float* m = of->m;
  const float3 a = fabs(p);
  return (float3)(fabs(m[0]) * a.x + fabs(m[1]) * a.y + fabs(m[2]) * a.z + fabs(m[3]),
                  fabs(m[4]) * a.x + fabs(m[5]) * a.y + fabs(m[6]) * a.z + fabs(m[7]),
                  fabs(m[8]) * a.x + fabs(m[9]) * a.y + fabs(m[10]) * a.z + fabs(m[11]));
}

// Takes a surface point through an affine map (to_world) with its inverse (to_object).
static inline LocalSurface surface_transformed(const Affine* to_world, const Affine* to_object,
                                               LocalSurface s) {
  float3 magnitude = affine_magnitude(to_world, s.p);
  // An entry of a matrix that moves is off by some roundings of its row's largest entry.
  if (anything_moves) magnitude = (float3)(norm1(magnitude));
  const float3 normal = unit_or(affine_transposed(to_object, s.ng), s.ng);
  const float3 shading = unit_or(affine_transposed(to_object, s.ns), normal);
  // This is the object-space uncertainty: that of the point, and the rounding of the way there and
  // back with both rounded matrices.
  const float object_error =
      s.error + 8.0f * CAPLET_EPS * norm1(affine_magnitude(to_object, magnitude));
  LocalSurface out = s;
  out.p = affine_point(to_world, s.p);
  out.dpdu = affine_vector(to_world, s.dpdu);
  out.dpdv = affine_vector(to_world, s.dpdv);
  out.ng = normal;
  out.ns = dot(shading, normal) < 0.0f ? -shading : shading;
  out.error = length(affine_transposed(to_world, normal)) * object_error +
              8.0f * CAPLET_EPS * dot(fabs(normal), magnitude);
  return out;
}

#endif
