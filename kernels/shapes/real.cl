// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `real` is the type that a shape formula computes with. CAPLET_REAL_WIDTH 8 tests eight primitives
// of a leaf block at once (CPUs), 1 tests one (GPUs). Masks are made by comparisons and used by
// `mask ? a : b`, & and | alone, which mean the same for both widths.
#ifndef CAPLET_SHAPES_REAL_CL
#define CAPLET_SHAPES_REAL_CL

#include "math/floats.cl"
#include "shared/kinds.h"

#ifndef CAPLET_REAL_WIDTH
#define CAPLET_REAL_WIDTH 1
#endif

// CAPLET_WAITS marks values that are computed long before they are needed: where one primitive is
// tested at a time they wait in memory, not in registers, of which GPUs have few.
#if CAPLET_REAL_WIDTH == 8
#define CAPLET_WAITS
typedef float8 real;
typedef int8 real_mask;

static inline real real_of(float x) { return (float8)(x); }
static inline real_mask int_of(int x) { return (int8)(x); }
static inline real_mask real_bits(real x) { return as_int8(x); }
static inline real real_load(__global const float* row, uint lane) {
  (void)lane;
  return vload8(0, row);
}
static inline real_mask lanes_filled(__global const float* row, uint lane) {
  (void)lane;
  return vload8(0, (__global const int*)row) >= 0;
}
static inline void real_store(real x, float* out) { vstore8(x, 0, out); }
static inline void mask_store(real_mask m, int* out) { vstore8(m, 0, out); }

#if defined(__has_builtin) && !defined(CAPLET_PORTABLE)
#if __has_builtin(__builtin_ia32_movmskps256) && defined(__AVX__)
#define CAPLET_MOVMSK 1
#endif
#endif
// Returns a word in which bit i is lane i.
static inline uint mask_bits(real_mask m) {
#ifdef CAPLET_MOVMSK
  typedef float caplet_v8sf __attribute__((vector_size(32)));
  return (uint)__builtin_ia32_movmskps256(__builtin_astype(m, caplet_v8sf));
#else
  const int8 bits = m & (int8)(1, 2, 4, 8, 16, 32, 64, 128);
  const int4 fold4 = bits.lo | bits.hi;
  const int2 fold2 = fold4.lo | fold4.hi;
  return (uint)(fold2.x | fold2.y);
#endif
}

#elif CAPLET_REAL_WIDTH == 1
#define CAPLET_WAITS volatile
typedef float real;
typedef int real_mask;

static inline real real_of(float x) { return x; }
static inline real_mask int_of(int x) { return x; }
static inline real_mask real_bits(real x) { return as_int(x); }
static inline real real_load(__global const float* row, uint lane) { return row[lane]; }
static inline real_mask lanes_filled(__global const float* row, uint lane) {
  return ((__global const int*)row)[lane] >= 0;
}
static inline void real_store(real x, float* out) { *out = x; }
static inline void mask_store(real_mask m, int* out) { *out = m; }
static inline uint mask_bits(real_mask m) { return m != 0; }
#else
#error "CAPLET_REAL_WIDTH is 1 or 8"
#endif

// The second operand wins when the first is not a number.
static inline real real_min(real a, real b) { return a < b ? a : b; }
static inline real real_max(real a, real b) { return a > b ? a : b; }
static inline real real_dot(real ax, real ay, real az, real bx, real by, real bz) {
  return ax * bx + ay * by + az * bz;
}

// Returns a power of two that takes a positive x to [1, 2). (For 2^127 or more, and for subnormals,
// it is some finite number.)
static inline real real_power_of_two_below_inverse(real x) {
  const real_mask exponent = int_of(0x7f000000) - (real_bits(x) & int_of(0x7f800000));
#if CAPLET_REAL_WIDTH == 8
  return as_float8(exponent);
#else
  return as_float(exponent);
#endif
}

// Returns the index of the lowest set bit; bits must not be 0.
static inline uint lowest_bit(uint bits) { return popcount(~bits & (bits - 1u)); }

// TriangleRay is what triangles need of a ray: offsets, in floats of a leaf block, of the
// components that become x, y and z once the largest component of d is z; the shear, and 1 / dz
// (Woop, Benthin and Wald 2013).
typedef struct {
  uint row_x, row_y, row_z;
  float kox, koy, koz, shear_x, shear_y, inv_dz;
} TriangleRay;

static inline TriangleRay triangle_ray(float3 o, float3 d) {
  TriangleRay ray;
  const float ax = fabs(d.x), ay = fabs(d.y), az = fabs(d.z);
  const int z_is_x = ax > ay && ax > az, z_is_y = !z_is_x && ay > az;
  // The order is (x y z) -> (y z x), (z x y) or (x y z): cyclic, so that the orientation stays.
  ray.row_x = z_is_x ? 8 : z_is_y ? 16 : 0;
  ray.row_y = z_is_x ? 16 : z_is_y ? 0 : 8;
  ray.row_z = z_is_x ? 0 : z_is_y ? 8 : 16;
  const float3 ko = z_is_x ? o.yzx : z_is_y ? o.zxy : o, kd = z_is_x ? d.yzx : z_is_y ? d.zxy : d;
  ray.kox = ko.x;
  ray.koy = ko.y;
  ray.koz = ko.z;
  ray.inv_dz = 1.0f / kd.z;
  ray.shear_x = kd.x * ray.inv_dz;
  ray.shear_y = kd.y * ray.inv_dz;
  return ray;
}

// ShapeRay is a ray in the space of the primitives, with what every primitive needs of it.
typedef struct {
  float ox, oy, oz, dx, dy, dz;
  float t_min;
  float inv_dd;  // 1 / |d|^2
  float ff_min;  // below this a squared direction component is rounding noise (2^-50 |d|^2)
  int sees_entering, sees_leaving;  // -1 or 0: crossings that count
  Floats leaves;                    // shapes of no fixed size keep data there
#ifdef CAPLET_MOTION
  float time;  // when the ray sees the scene
#endif
#if CAPLET_REAL_WIDTH == 8
  TriangleRay triangle;  // kept; one at a time registers are dearer
#endif
} ShapeRay;

static inline ShapeRay shape_ray(float3 o, float3 d, float t_min, Floats leaves) {
  ShapeRay ray;
  ray.ox = o.x;
  ray.oy = o.y;
  ray.oz = o.z;
  ray.dx = d.x;
  ray.dy = d.y;
  ray.dz = d.z;
  ray.t_min = t_min;
  ray.sees_entering = ray.sees_leaving = -1;
  ray.leaves = leaves;
  const float dd = dot(d, d);
  ray.inv_dd = 1.0f / dd;
  ray.ff_min = fmax(dd * 0x1p-50f, 0x1p-120f);
#if CAPLET_REAL_WIDTH == 8
  ray.triangle = triangle_ray(o, d);
#endif
  return ray;
}

// Returns when the ray sees the scene, from 0 to 1 while the shutter is open.
static inline float ray_time(const ShapeRay* ray) {
#ifdef CAPLET_MOTION
  return ray->time;
#else
  (void)ray;
  return 0.0f;
#endif
}

static inline TriangleRay triangle_ray_of(const ShapeRay* ray) {
#if CAPLET_REAL_WIDTH == 8
  return ray->triangle;
#else
  return triangle_ray((float3)(ray->ox, ray->oy, ray->oz), (float3)(ray->dx, ray->dy, ray->dz));
#endif
}

// NearRay is a ray for filters that look along it: its origin, an orthonormal frame with w along
// the direction, and the length of the direction, in which t counts, rounded up.
typedef struct {
  float ox, oy, oz;
  float ux, uy, uz, vx, vy, vz, wx, wy, wz;
  float length;
} NearRay;

// The frame is that of Duff et al. 2017, Building an Orthonormal Basis, Revisited.
static inline NearRay near_ray(float3 o, float3 d) {
  NearRay ray;
  const float length = sqrt(dot(d, d));
  const float3 w = d / length;
  const float sign = copysign(1.0f, w.z), a = -1.0f / (sign + w.z), b = w.x * w.y * a;
  ray.ox = o.x;
  ray.oy = o.y;
  ray.oz = o.z;
  ray.ux = 1.0f + sign * w.x * w.x * a;
  ray.uy = sign * b;
  ray.uz = -sign * w.x;
  ray.vx = b;
  ray.vy = sign + w.y * w.y * a;
  ray.vz = -w.y;
  ray.wx = w.x;
  ray.wy = w.y;
  ray.wz = w.z;
  ray.length = length * (1.0f + 0x1p-20f);
  return ray;
}

// Span is where a line crosses a shape: it goes in at t_enter and out at t_exit, through the
// surfaces of these numbers. `enter` and `exit` are the lanes in which that crossing is on the
// shape: both or none for closed solids; open ones miss parts, and one crossing alone is an
// entrance or an exit by the side it is seen from. t_enter <= t_exit to rounding wherever both are
// there (of bilinear patches either may be first); elsewhere t has no meaning.
typedef struct {
  real t_enter, t_exit;
  real_mask enter, exit;
  real_mask surface_enter, surface_exit;  // integers
} Span;

// Returns the span of a closed solid that has one surface.
static inline Span span_of(real_mask hit, real t_enter, real t_exit) {
  Span span;
  span.t_enter = t_enter;
  span.t_exit = t_exit;
  span.enter = span.exit = hit;
  span.surface_enter = span.surface_exit = int_of(0);
  return span;
}

// Returns the span of an open shape that a line crosses once; `side`: HitRecord.surface.
static inline Span span_of_one(real_mask hit, real t, real_mask side) {
  const real_mask leaving = (side & int_of(CAPLET_LEAVING)) != 0;
  Span span;
  span.t_enter = span.t_exit = t;
  span.enter = hit & (leaving == 0);
  span.exit = hit & leaving;
  span.surface_enter = span.surface_exit = side & int_of((int)CAPLET_SURFACE_MASK);
  return span;
}

// Defines name_hit from name_span.
#define SPAN_HIT(name)                                                                            \
  static inline real_mask name##_hit(const ShapeRay* ray, __global const float* block, uint lane, \
                                     real* t, real_mask* side) {                                  \
    const Span span = name##_span(ray, block, lane);                                              \
    return span_nearest(ray, &span, t, side);                                                     \
  }

// Finds the nearest crossing beyond t_min that the ray sees: the lanes that have one, t, and
// HitRecord.surface.
static inline real_mask span_nearest(const ShapeRay* ray, const Span* span, real* t,
                                     real_mask* side) {
  const real_mask enter = span->enter & (span->t_enter > ray->t_min) & int_of(ray->sees_entering);
  const real_mask exit = span->exit & (span->t_exit > ray->t_min) & int_of(ray->sees_leaving);
  *t = enter ? span->t_enter : span->t_exit;
  *side = enter ? span->surface_enter : span->surface_exit | int_of(CAPLET_LEAVING);
  return enter | exit;
}

#endif
