// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The built-in functions of OpenCL C 1.2 that kernels call, for a clang that compiles OpenCL C for
// the host (see CMakeLists.txt). Vector types, literals, swizzles, vector comparisons (-1 for
// true), `mask ? a : b` and shifts modulo the width are the compiler's own. What the standard
// leaves open is taken as C takes it, so that UBSan sees it: a conversion of what the target type
// cannot hold, for one.
#ifndef CAPLET_TESTS_OPENCL_C_H
#define CAPLET_TESTS_OPENCL_C_H

#define BUILTIN static inline __attribute__((overloadable, unused))

#define VECTORS(macro, ...) \
  macro(2, __VA_ARGS__) macro(3, __VA_ARGS__) macro(4, __VA_ARGS__) macro(8, __VA_ARGS__)
#define LANES(n, result, type, value)           \
  {                                             \
    result##n out;                              \
    for (int i = 0; i < n; ++i) out[i] = value; \
    return out;                                 \
  }
#define VECTOR_1(n, name, result, type) \
  BUILTIN result##n name(type##n x) LANES(n, result, type, name(x[i]))
#define VECTOR_2(n, name, result, type) \
  BUILTIN result##n name(type##n x, type##n y) LANES(n, result, type, name(x[i], y[i]))
#define VECTOR_3(n, name, result, type)                   \
  BUILTIN result##n name(type##n x, type##n y, type##n z) \
      LANES(n, result, type, name(x[i], y[i], z[i]))
// With a scalar in place of the last one or two vectors.
#define VECTOR_2_SCALAR(n, name, result, type) \
  BUILTIN result##n name(type##n x, type y) LANES(n, result, type, name(x[i], y))
#define VECTOR_3_SCALAR(n, name, result, type) \
  BUILTIN result##n name(type##n x, type##n y, type z) LANES(n, result, type, name(x[i], y[i], z))
#define VECTOR_3_SCALARS(n, name, result, type) \
  BUILTIN result##n name(type##n x, type y, type z) LANES(n, result, type, name(x[i], y, z))
// Tests of floats: 1 of a scalar, -1 in the lanes of a vector (6.12.6).
#define VECTOR_TEST(n, name, ...) BUILTIN int##n name(float##n x) LANES(n, int, float, -name(x[i]))

// --- Maths (6.12.2): each name and its C function ---

#define MATHS_1(name, function)                       \
  BUILTIN float name(float x) { return function(x); } \
  VECTORS(VECTOR_1, name, float, float)
MATHS_1(acos, __builtin_acosf)
MATHS_1(asin, __builtin_asinf)
MATHS_1(atan, __builtin_atanf)
MATHS_1(ceil, __builtin_ceilf)
MATHS_1(cos, __builtin_cosf)
MATHS_1(exp, __builtin_expf)
MATHS_1(fabs, __builtin_fabsf)
MATHS_1(floor, __builtin_floorf)
MATHS_1(log, __builtin_logf)
MATHS_1(log2, __builtin_log2f)
MATHS_1(rsqrt, 1.0f / __builtin_sqrtf)
MATHS_1(sin, __builtin_sinf)
MATHS_1(sqrt, __builtin_sqrtf)
MATHS_1(tan, __builtin_tanf)
MATHS_1(trunc, __builtin_truncf)

#define MATHS_2(name, function)                                   \
  BUILTIN float name(float x, float y) { return function(x, y); } \
  VECTORS(VECTOR_2, name, float, float)
MATHS_2(atan2, __builtin_atan2f)
MATHS_2(copysign, __builtin_copysignf)
MATHS_2(fmax, __builtin_fmaxf)  // the number of the two, where one is NaN
MATHS_2(fmin, __builtin_fminf)
MATHS_2(fmod, __builtin_fmodf)
MATHS_2(nextafter, __builtin_nextafterf)
MATHS_2(pow, __builtin_powf)
VECTORS(VECTOR_2_SCALAR, fmax, float, float)
VECTORS(VECTOR_2_SCALAR, fmin, float, float)

BUILTIN float fma(float x, float y, float z) { return __builtin_fmaf(x, y, z); }
VECTORS(VECTOR_3, fma, float, float)

// --- Integers (6.12.3) and common functions (6.12.4) ---

// y < x ? y : x and x < y ? y : x, of floats too, where NaN has no defined result.
#define LEAST_AND_GREATEST(type)                             \
  BUILTIN type min(type x, type y) { return y < x ? y : x; } \
  BUILTIN type max(type x, type y) { return x < y ? y : x; }
LEAST_AND_GREATEST(int)
LEAST_AND_GREATEST(uint)
LEAST_AND_GREATEST(ulong)
LEAST_AND_GREATEST(float)

BUILTIN int clamp(int x, int low, int high) { return min(max(x, low), high); }
BUILTIN uint clamp(uint x, uint low, uint high) { return min(max(x, low), high); }
BUILTIN float clamp(float x, float low, float high) { return fmin(fmax(x, low), high); }
VECTORS(VECTOR_3, clamp, float, float)
VECTORS(VECTOR_3, clamp, int, int)
VECTORS(VECTOR_3_SCALARS, clamp, float, float)
BUILTIN float mix(float x, float y, float a) { return x + (y - x) * a; }
VECTORS(VECTOR_3, mix, float, float)
VECTORS(VECTOR_3_SCALAR, mix, float, float)
BUILTIN uint popcount(uint x) { return (uint)__builtin_popcount(x); }
BUILTIN uint clz(uint x) { return x == 0 ? 32u : (uint)__builtin_clz(x); }
BUILTIN uint mul_hi(uint x, uint y) { return (uint)(((ulong)x * (ulong)y) >> 32); }

// --- Conversions (6.2.3) ---

#define CONVERSION(n, to, from) \
  BUILTIN to##n convert_##to##n(from##n x) LANES(n, to, from, (to)x[i])
VECTORS(CONVERSION, float, int)
VECTORS(CONVERSION, int, float)

// --- Geometry (6.12.5) ---

#define DOT(n, ...)                                 \
  BUILTIN float dot(float##n x, float##n y) {       \
    float sum = x[0] * y[0];                        \
    for (int i = 1; i < n; ++i) sum += x[i] * y[i]; \
    return sum;                                     \
  }
DOT(2)
DOT(3)
DOT(4)
BUILTIN float3 cross(float3 x, float3 y) {
  return (float3)(x.y * y.z - x.z * y.y, x.z * y.x - x.x * y.z, x.x * y.y - x.y * y.x);
}
// Through double: neither squares of large nor of small numbers are lost.
#define LENGTH(n, ...)                                              \
  BUILTIN float length(float##n x) {                                \
    double sum = 0;                                                 \
    for (int i = 0; i < n; ++i) sum += (double)x[i] * (double)x[i]; \
    const double root = __builtin_sqrt(sum);                        \
    return root > (double)FLT_MAX ? INFINITY : (float)root;         \
  }                                                                 \
  BUILTIN float##n normalize(float##n x) {                          \
    const float whole = length(x);                                  \
    return whole > 0.0f ? x / whole : x;                            \
  }                                                                 \
  BUILTIN float distance(float##n x, float##n y) { return length(x - y); }
LENGTH(2)
LENGTH(3)
LENGTH(4)

// --- Relations (6.12.6) ---

BUILTIN int isnan(float x) { return __builtin_isnan(x) ? 1 : 0; }
BUILTIN int isinf(float x) { return __builtin_isinf(x) ? 1 : 0; }
BUILTIN int isfinite(float x) { return __builtin_isfinite(x) ? 1 : 0; }
VECTORS(VECTOR_TEST, isnan)
VECTORS(VECTOR_TEST, isinf)
VECTORS(VECTOR_TEST, isfinite)
BUILTIN int isgreater(float x, float y) { return x > y; }
BUILTIN int isless(float x, float y) { return x < y; }
#define COMPARE(n, ...)                                              \
  BUILTIN int##n isgreater(float##n x, float##n y) { return x > y; } \
  BUILTIN int##n isless(float##n x, float##n y) { return x < y; }
VECTORS(COMPARE)

// By the most significant bit of each lane; of scalars, by any bit.
#define SELECT_VECTOR(n, type)                           \
  BUILTIN type##n select(type##n a, type##n b, int##n c) \
      LANES(n, type, type, (c[i] < 0 ? b[i] : a[i]))
BUILTIN float select(float a, float b, int c) { return c ? b : a; }
BUILTIN int select(int a, int b, int c) { return c ? b : a; }
VECTORS(SELECT_VECTOR, float)
VECTORS(SELECT_VECTOR, int)

BUILTIN int any(int x) { return x < 0; }
BUILTIN int all(int x) { return x < 0; }
#define ANY_ALL(n, ...)                            \
  BUILTIN int any(int##n x) {                      \
    int found = 0;                                 \
    for (int i = 0; i < n; ++i) found |= x[i] < 0; \
    return found;                                  \
  }                                                \
  BUILTIN int all(int##n x) {                      \
    int held = 1;                                  \
    for (int i = 0; i < n; ++i) held &= x[i] < 0;  \
    return held;                                   \
  }
VECTORS(ANY_ALL)

// --- Vector data (6.12.7) ---

#define LOAD_STORE_OF(n, type, space)                          \
  BUILTIN type##n vload##n(size_t offset, const space type* p) \
      LANES(n, type, type, p[n * offset + (size_t)i])
#define LOAD_STORE(n, type)                                             \
  LOAD_STORE_OF(n, type, __global)                                      \
  LOAD_STORE_OF(n, type, __private)                                     \
  BUILTIN void vstore##n(type##n x, size_t offset, __global type* p) {  \
    for (int i = 0; i < n; ++i) p[n * offset + (size_t)i] = x[i];       \
  }                                                                     \
  BUILTIN void vstore##n(type##n x, size_t offset, __private type* p) { \
    for (int i = 0; i < n; ++i) p[n * offset + (size_t)i] = x[i];       \
  }
VECTORS(LOAD_STORE, float)
VECTORS(LOAD_STORE, int)

// Both widths are linked into one program: tables are each text's own.
#define __constant static constant

#endif
