// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// Declares the OpenCL C functions that kernels call. The host puts this before a program for PoCL
// and leaves PoCL's own header of 18,000 declarations out, which clang would read at every build,
// 20 ms each, those from a cache too. What a kernel calls and this lacks is a build error; the host
// then builds the program with PoCL's header.

#define DECLARE_CONST __attribute__((overloadable, const))
#define DECLARE_PURE __attribute__((overloadable, pure))
#define DECLARE_OVERLOAD __attribute__((overloadable))

size_t DECLARE_CONST get_global_id(uint);
size_t DECLARE_CONST get_global_size(uint);
size_t DECLARE_CONST get_local_id(uint);
size_t DECLARE_CONST get_local_size(uint);
size_t DECLARE_CONST get_group_id(uint);
size_t DECLARE_CONST get_num_groups(uint);

// Functions of floating point numbers, of vectors too.
#define DECLARE_REALS(T)           \
  T DECLARE_CONST acos(T);         \
  T DECLARE_CONST asin(T);         \
  T DECLARE_CONST atan2(T, T);     \
  T DECLARE_CONST ceil(T);         \
  T DECLARE_CONST clamp(T, T, T);  \
  T DECLARE_CONST copysign(T, T);  \
  T DECLARE_CONST cos(T);          \
  T DECLARE_CONST exp(T);          \
  T DECLARE_CONST fabs(T);         \
  T DECLARE_CONST floor(T);        \
  T DECLARE_CONST fma(T, T, T);    \
  T DECLARE_CONST fmax(T, T);      \
  T DECLARE_CONST fmin(T, T);      \
  T DECLARE_CONST log(T);          \
  T DECLARE_CONST log2(T);         \
  T DECLARE_CONST max(T, T);       \
  T DECLARE_CONST min(T, T);       \
  T DECLARE_CONST mix(T, T, T);    \
  T DECLARE_CONST nextafter(T, T); \
  T DECLARE_CONST pow(T, T);       \
  T DECLARE_CONST rsqrt(T);        \
  T DECLARE_CONST sin(T);          \
  T DECLARE_CONST sqrt(T);
// Those of a vector T and a scalar S.
#define DECLARE_REALS_AND_SCALAR(T, S) \
  T DECLARE_CONST clamp(T, S, S);      \
  T DECLARE_CONST fmax(T, S);          \
  T DECLARE_CONST fmin(T, S);          \
  T DECLARE_CONST mix(T, T, S);
#define DECLARE_GEOMETRY(T, S) \
  S DECLARE_CONST dot(T, T);   \
  S DECLARE_CONST length(T);   \
  T DECLARE_CONST normalize(T);
// Tests of T, with their results in I, and choices by I or its unsigned twin U.
#define DECLARE_TESTS(T, I)        \
  I DECLARE_CONST isfinite(T);     \
  I DECLARE_CONST isgreater(T, T); \
  I DECLARE_CONST isinf(T);        \
  I DECLARE_CONST isnan(T);        \
  I DECLARE_CONST signbit(T);
#define DECLARE_CHOICES(T, I, U)   \
  T DECLARE_CONST select(T, T, I); \
  T DECLARE_CONST select(T, T, U);
#define DECLARE_INTEGERS(T)       \
  T DECLARE_CONST clamp(T, T, T); \
  T DECLARE_CONST clz(T);         \
  T DECLARE_CONST max(T, T);      \
  T DECLARE_CONST min(T, T);      \
  T DECLARE_CONST mul_hi(T, T);   \
  T DECLARE_CONST popcount(T);    \
  T DECLARE_CONST rotate(T, T);
#define DECLARE_ALL_OF(T)   \
  int DECLARE_CONST all(T); \
  int DECLARE_CONST any(T);
#define DECLARE_LOADS(T, N, SPACE) T##N DECLARE_PURE vload##N(size_t, const SPACE T*);
#define DECLARE_STORES(T, N, SPACE) void DECLARE_OVERLOAD vstore##N(T##N, size_t, SPACE T*);
#define DECLARE_MEMORY_OF(T, N)   \
  DECLARE_LOADS(T, N, __constant) \
  DECLARE_LOADS(T, N, __global)   \
  DECLARE_LOADS(T, N, __local)    \
  DECLARE_LOADS(T, N, __private)  \
  DECLARE_STORES(T, N, __global)  \
  DECLARE_STORES(T, N, __local)   \
  DECLARE_STORES(T, N, __private)
#define DECLARE_MEMORY(T) \
  DECLARE_MEMORY_OF(T, 2) DECLARE_MEMORY_OF(T, 3) DECLARE_MEMORY_OF(T, 4) DECLARE_MEMORY_OF(T, 8)
#define DECLARE_CONVERSIONS(FROM, N)                  \
  float##N DECLARE_CONST convert_float##N(FROM##N);   \
  double##N DECLARE_CONST convert_double##N(FROM##N); \
  int##N DECLARE_CONST convert_int##N(FROM##N);       \
  uint##N DECLARE_CONST convert_uint##N(FROM##N);     \
  long##N DECLARE_CONST convert_long##N(FROM##N);     \
  ulong##N DECLARE_CONST convert_ulong##N(FROM##N);

// All that there is of vectors of N.
#define DECLARE_WIDTH(N)                        \
  DECLARE_REALS(float##N)                       \
  DECLARE_REALS(double##N)                      \
  DECLARE_REALS_AND_SCALAR(float##N, float)     \
  DECLARE_REALS_AND_SCALAR(double##N, double)   \
  DECLARE_TESTS(float##N, int##N)               \
  DECLARE_TESTS(double##N, long##N)             \
  DECLARE_CHOICES(float##N, int##N, uint##N)    \
  DECLARE_CHOICES(double##N, long##N, ulong##N) \
  DECLARE_CHOICES(int##N, int##N, uint##N)      \
  DECLARE_CHOICES(uint##N, int##N, uint##N)     \
  DECLARE_CHOICES(long##N, long##N, ulong##N)   \
  DECLARE_CHOICES(ulong##N, long##N, ulong##N)  \
  DECLARE_INTEGERS(int##N)                      \
  DECLARE_INTEGERS(uint##N)                     \
  DECLARE_INTEGERS(long##N)                     \
  DECLARE_INTEGERS(ulong##N)                    \
  DECLARE_ALL_OF(int##N)                        \
  DECLARE_ALL_OF(long##N)                       \
  DECLARE_CONVERSIONS(uchar, N)                 \
  DECLARE_CONVERSIONS(ushort, N)                \
  DECLARE_CONVERSIONS(float, N)                 \
  DECLARE_CONVERSIONS(double, N)                \
  DECLARE_CONVERSIONS(int, N)                   \
  DECLARE_CONVERSIONS(uint, N)                  \
  DECLARE_CONVERSIONS(long, N)                  \
  DECLARE_CONVERSIONS(ulong, N)
DECLARE_WIDTH(2)
DECLARE_WIDTH(3)
DECLARE_WIDTH(4)
DECLARE_WIDTH(8)

DECLARE_REALS(float)
DECLARE_REALS(double)
DECLARE_TESTS(float, int)
DECLARE_TESTS(double, int)
DECLARE_CHOICES(float, int, uint)
DECLARE_CHOICES(double, long, ulong)
DECLARE_CHOICES(int, int, uint)
DECLARE_CHOICES(uint, int, uint)
DECLARE_CHOICES(long, long, ulong)
DECLARE_CHOICES(ulong, long, ulong)
DECLARE_INTEGERS(int)
DECLARE_INTEGERS(uint)
DECLARE_INTEGERS(long)
DECLARE_INTEGERS(ulong)
DECLARE_ALL_OF(int)
DECLARE_ALL_OF(long)
DECLARE_GEOMETRY(float, float)
DECLARE_GEOMETRY(float2, float)
DECLARE_GEOMETRY(float3, float)
DECLARE_GEOMETRY(float4, float)
DECLARE_GEOMETRY(double, double)
DECLARE_GEOMETRY(double2, double)
DECLARE_GEOMETRY(double3, double)
DECLARE_GEOMETRY(double4, double)
float3 DECLARE_CONST cross(float3, float3);
float4 DECLARE_CONST cross(float4, float4);
double3 DECLARE_CONST cross(double3, double3);
double4 DECLARE_CONST cross(double4, double4);
DECLARE_MEMORY(float)
DECLARE_MEMORY(double)
DECLARE_MEMORY(int)
DECLARE_MEMORY(uint)
DECLARE_MEMORY(long)
DECLARE_MEMORY(ulong)
DECLARE_MEMORY(uchar)
DECLARE_MEMORY(ushort)

float4 DECLARE_CONST shuffle(float4, uint4);
int4 DECLARE_CONST shuffle(int4, uint4);
uint4 DECLARE_CONST shuffle(uint4, uint4);

#define DECLARE_ATOMICS(T, SPACE)                      \
  T DECLARE_OVERLOAD atomic_add(volatile SPACE T*, T); \
  T DECLARE_OVERLOAD atomic_inc(volatile SPACE T*);    \
  T DECLARE_OVERLOAD atomic_max(volatile SPACE T*, T); \
  T DECLARE_OVERLOAD atomic_or(volatile SPACE T*, T);
DECLARE_ATOMICS(int, __global)
DECLARE_ATOMICS(uint, __global)
DECLARE_ATOMICS(int, __local)
DECLARE_ATOMICS(uint, __local)
