// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `real`: what a shape formula computes with. CAPLET_REAL_WIDTH 8 tests eight primitives of a leaf block at once (CPUs), 1 tests
// one (GPUs). Masks are made by comparisons and used by `mask ? a : b`, & and | alone, which mean the same for both widths.
#ifndef CAPLET_SHAPES_REAL_CL
#define CAPLET_SHAPES_REAL_CL

#ifndef CAPLET_REAL_WIDTH
#define CAPLET_REAL_WIDTH 1
#endif

#if CAPLET_REAL_WIDTH == 8
typedef float8 real;
typedef int8 real_mask;

static inline real real_of(float x) { return (float8)(x); }
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

#if defined(__has_builtin)
#if __has_builtin(__builtin_ia32_movmskps256) && defined(__AVX__)
#define CAPLET_MOVMSK 1
#endif
#endif
// Bit i: lane i is true.
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
typedef float real;
typedef int real_mask;

static inline real real_of(float x) { return x; }
static inline real real_load(__global const float* row, uint lane) { return row[lane]; }
static inline real_mask lanes_filled(__global const float* row, uint lane) { return ((__global const int*)row)[lane] >= 0; }
static inline void real_store(real x, float* out) { *out = x; }
static inline void mask_store(real_mask m, int* out) { *out = m; }
static inline uint mask_bits(real_mask m) { return m != 0; }
#else
#error "CAPLET_REAL_WIDTH is 1 or 8"
#endif

// The second operand wins when the first is not a number.
static inline real real_min(real a, real b) { return a < b ? a : b; }
static inline real real_max(real a, real b) { return a > b ? a : b; }
static inline real real_dot(real ax, real ay, real az, real bx, real by, real bz) { return ax * bx + ay * by + az * bz; }

// Index of the lowest set bit; bits must not be 0.
static inline uint lowest_bit(uint bits) { return popcount(~bits & (bits - 1u)); }

// A ray in the space of the primitives, with what every primitive needs of it.
typedef struct {
  float ox, oy, oz, dx, dy, dz;
  float t_min;
  float inv_dd;  // 1 / |d|^2
  float ff_min;  // below this a squared direction component is rounding noise (2^-50 |d|^2)
  // Triangles: offsets, in floats of a leaf block, of the components that become x, y and z once the largest component of d is z;
  // the shear, and 1 / dz (Woop, Benthin and Wald 2013).
  uint row_x, row_y, row_z;
  float kox, koy, koz, shear_x, shear_y, inv_dz;
} ShapeRay;

static inline ShapeRay shape_ray(float3 o, float3 d, float t_min) {
  ShapeRay ray;
  ray.ox = o.x;
  ray.oy = o.y;
  ray.oz = o.z;
  ray.dx = d.x;
  ray.dy = d.y;
  ray.dz = d.z;
  ray.t_min = t_min;
  const float dd = dot(d, d);
  ray.inv_dd = 1.0f / dd;
  ray.ff_min = fmax(dd * 0x1p-50f, 0x1p-120f);
  const float ax = fabs(d.x), ay = fabs(d.y), az = fabs(d.z);
  const int z_is_x = ax > ay && ax > az, z_is_y = !z_is_x && ay > az;
  // (x y z) -> (y z x), (z x y) or (x y z): cyclic, so that the orientation stays.
  ray.row_x = z_is_x ? 8 : z_is_y ? 16 : 0;
  ray.row_y = z_is_x ? 16 : z_is_y ? 0 : 8;
  ray.row_z = z_is_x ? 0 : z_is_y ? 8 : 16;
  ray.kox = z_is_x ? o.y : z_is_y ? o.z : o.x;
  ray.koy = z_is_x ? o.z : z_is_y ? o.x : o.y;
  ray.koz = z_is_x ? o.x : z_is_y ? o.y : o.z;
  const float kdx = z_is_x ? d.y : z_is_y ? d.z : d.x;
  const float kdy = z_is_x ? d.z : z_is_y ? d.x : d.y;
  ray.inv_dz = 1.0f / (z_is_x ? d.x : z_is_y ? d.y : d.z);
  ray.shear_x = kdx * ray.inv_dz;
  ray.shear_y = kdy * ray.inv_dz;
  return ray;
}

// The nearer of a span's two ends beyond t_min. `hit`: lanes with a span.
static inline real span_nearest(const ShapeRay* ray, real t_enter, real t_exit, real_mask* leaving) {
  *leaving = t_enter <= real_of(ray->t_min);
  return *leaving ? t_exit : t_enter;
}

#endif
