// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds small vector helpers over float3. Matrices are 3x4 row-major, 12 floats.
#ifndef CAPLET_MATH_VECTOR_CL
#define CAPLET_MATH_VECTOR_CL

#define CAPLET_PI 3.14159265358979f
#define CAPLET_INV_PI 0.318309886183791f
// CAPLET_EPS is the unit roundoff of binary32.
#define CAPLET_EPS 5.9604644775390625e-8f

typedef struct {
  float3 s, t, n;
} Frame;

static inline float sqr(float x) { return x * x; }
static inline float max3(float3 v) { return fmax(v.x, fmax(v.y, v.z)); }
static inline float max4(float4 v) { return fmax(fmax(v.x, v.y), fmax(v.z, v.w)); }
static inline float mean4(float4 v) { return 0.25f * (v.x + v.y + v.z + v.w); }
static inline float3 load3(__global const float* p) { return (float3)(p[0], p[1], p[2]); }

static inline float3 transform_point(__global const float* m, float3 p) {
  return (float3)(m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3],
                  m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
                  m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]);
}
static inline float3 transform_vector(__global const float* m, float3 v) {
  return (float3)(m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z,
                  m[8] * v.x + m[9] * v.y + m[10] * v.z);
}
// Applies the transpose of m to v: it takes a normal to the space that m comes from.
static inline float3 transform_transposed(__global const float* m, float3 v) {
  return (float3)(m[0] * v.x + m[4] * v.y + m[8] * v.z, m[1] * v.x + m[5] * v.y + m[9] * v.z,
                  m[2] * v.x + m[6] * v.y + m[10] * v.z);
}

// Affine is such a matrix in registers.
typedef struct {
  float m[12];
} Affine;
static inline Affine affine_load(__global const float* m) {
  Affine a;
  for (int k = 0; k < 12; k++) a.m[k] = m[k];
  return a;
}
static inline float3 affine_point(const Affine* a, float3 p) {
  return (float3)(a->m[0] * p.x + a->m[1] * p.y + a->m[2] * p.z + a->m[3],
                  a->m[4] * p.x + a->m[5] * p.y + a->m[6] * p.z + a->m[7],
                  a->m[8] * p.x + a->m[9] * p.y + a->m[10] * p.z + a->m[11]);
}
static inline float3 affine_vector(const Affine* a, float3 v) {
  return (float3)(a->m[0] * v.x + a->m[1] * v.y + a->m[2] * v.z,
                  a->m[4] * v.x + a->m[5] * v.y + a->m[6] * v.z,
                  a->m[8] * v.x + a->m[9] * v.y + a->m[10] * v.z);
}
static inline float3 affine_transposed(const Affine* a, float3 v) {
  return (float3)(a->m[0] * v.x + a->m[4] * v.y + a->m[8] * v.z,
                  a->m[1] * v.x + a->m[5] * v.y + a->m[9] * v.z,
                  a->m[2] * v.x + a->m[6] * v.y + a->m[10] * v.z);
}

// Builds the frame of Duff et al., "Building an orthonormal basis, revisited", JCGT 2017. n of unit
// length. sign: 1 or -1, and sign + n.z is not near 0. The rotation that takes +z (-z) to n by the
// least angle takes +x to s.
static inline Frame frame_from_pole(float3 n, float sign) {
  Frame f;
  const float a = -1.0f / (sign + n.z);
  const float b = n.x * n.y * a;
  f.s = (float3)(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
  f.t = (float3)(b, sign + n.y * n.y * a, -n.y);
  f.n = n;
  return f;
}
static inline Frame frame_from_normal(float3 n) {
  return frame_from_pole(n, n.z >= 0.0f ? 1.0f : -1.0f);
}
// Returns the frame with normal n whose s lies along dpdu as far as possible.
static inline Frame frame_from_tangent(float3 n, float3 dpdu) {
  const float3 s = dpdu - n * dot(n, dpdu);
  const float length_squared = dot(s, s);
  if (!(length_squared > 1e-20f * dot(dpdu, dpdu)) || !(length_squared > 0.0f))
    return frame_from_normal(n);
  Frame f;
  f.s = s * rsqrt(length_squared);
  f.t = cross(n, f.s);
  f.n = n;
  return f;
}
static inline float3 to_local(const Frame* f, float3 v) {
  return (float3)(dot(v, f->s), dot(v, f->t), dot(v, f->n));
}
static inline float3 to_world(const Frame* f, float3 v) {
  return f->s * v.x + f->t * v.y + f->n * v.z;
}

static inline float power_heuristic(float a, float b) {
  if (isinf(a)) return 1.0f;
  const float a2 = a * a, b2 = b * b;
  return a2 + b2 > 0.0f ? a2 / (a2 + b2) : 0.0f;
}

// Returns sin and cos of x in [-pi/4, pi/4] by their Taylor series, to 2 units in the last place.
// The built-in functions spend most of their time on reducing large arguments.
static inline float sin_small(float x) {
  const float z = x * x;
  return x +
         x * z *
             (-1.66666667e-1f + z * (8.33333333e-3f + z * (-1.98412698e-4f + z * 2.75573192e-6f)));
}
static inline float cos_small(float x) {
  const float z = x * x;
  return 1.0f + z * (-0.5f + z * (4.16666667e-2f + z * (-1.38888889e-3f + z * 2.48015873e-5f)));
}

// Maps the unit square to the unit disk and keeps areas (Shirley and Chiu 1997).
static inline float2 sample_disk(float2 u) {
  const float2 p = 2.0f * u - 1.0f;
  if (p.x == 0.0f && p.y == 0.0f) return (float2)(0.0f);
  const int wide = fabs(p.x) > fabs(p.y);
  const float radius = wide ? p.x : p.y;
  const float angle = 0.25f * CAPLET_PI * (wide ? p.y / p.x : p.x / p.y);
  const float c = radius * cos_small(angle), s = radius * sin_small(angle);
  return wide ? (float2)(c, s) : (float2)(s, c);
}
static inline float3 sample_cosine_hemisphere(float2 u) {
  const float2 d = sample_disk(u);
  return (float3)(d.x, d.y, sqrt(fmax(0.0f, 1.0f - dot(d, d))));
}

#endif
