// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Eight lanes and eight bytes in another order. Compilers for processors with such instructions are told of them, where they know their
// names (CAPLET_EIGHT_IS_FAST); the portable way, which CAPLET_PORTABLE asks for everywhere, gives the same.
#ifndef CAPLET_TRACE_EIGHT_CL
#define CAPLET_TRACE_EIGHT_CL

#if defined(__has_builtin) && defined(__AVX2__) && !defined(CAPLET_PORTABLE)
#if __has_builtin(__builtin_ia32_permvarsi256) && __has_builtin(__builtin_ia32_pshufb128)
#define CAPLET_EIGHT_IS_FAST 1
#endif
#endif
#if defined(__has_builtin) && !defined(CAPLET_PORTABLE)
#if __has_builtin(__builtin_prefetch)
#define CAPLET_PREFETCH 1
#endif
#endif

// Entry m: the numbers of the bits set in m from the highest down, a byte each, the highest in the least significant byte.
__constant ulong set_bits[256] = {
    0x0UL, 0x0UL, 0x1UL, 0x1UL, 0x2UL, 0x2UL, 0x102UL, 0x102UL, 0x3UL, 0x3UL, 0x103UL, 0x103UL, 0x203UL, 0x203UL, 0x10203UL,
    0x10203UL, 0x4UL, 0x4UL, 0x104UL, 0x104UL, 0x204UL, 0x204UL, 0x10204UL, 0x10204UL, 0x304UL, 0x304UL, 0x10304UL, 0x10304UL,
    0x20304UL, 0x20304UL, 0x1020304UL, 0x1020304UL, 0x5UL, 0x5UL, 0x105UL, 0x105UL, 0x205UL, 0x205UL, 0x10205UL, 0x10205UL, 0x305UL,
    0x305UL, 0x10305UL, 0x10305UL, 0x20305UL, 0x20305UL, 0x1020305UL, 0x1020305UL, 0x405UL, 0x405UL, 0x10405UL, 0x10405UL,
    0x20405UL, 0x20405UL, 0x1020405UL, 0x1020405UL, 0x30405UL, 0x30405UL, 0x1030405UL, 0x1030405UL, 0x2030405UL, 0x2030405UL,
    0x102030405UL, 0x102030405UL, 0x6UL, 0x6UL, 0x106UL, 0x106UL, 0x206UL, 0x206UL, 0x10206UL, 0x10206UL, 0x306UL, 0x306UL,
    0x10306UL, 0x10306UL, 0x20306UL, 0x20306UL, 0x1020306UL, 0x1020306UL, 0x406UL, 0x406UL, 0x10406UL, 0x10406UL, 0x20406UL,
    0x20406UL, 0x1020406UL, 0x1020406UL, 0x30406UL, 0x30406UL, 0x1030406UL, 0x1030406UL, 0x2030406UL, 0x2030406UL, 0x102030406UL,
    0x102030406UL, 0x506UL, 0x506UL, 0x10506UL, 0x10506UL, 0x20506UL, 0x20506UL, 0x1020506UL, 0x1020506UL, 0x30506UL, 0x30506UL,
    0x1030506UL, 0x1030506UL, 0x2030506UL, 0x2030506UL, 0x102030506UL, 0x102030506UL, 0x40506UL, 0x40506UL, 0x1040506UL,
    0x1040506UL, 0x2040506UL, 0x2040506UL, 0x102040506UL, 0x102040506UL, 0x3040506UL, 0x3040506UL, 0x103040506UL, 0x103040506UL,
    0x203040506UL, 0x203040506UL, 0x10203040506UL, 0x10203040506UL, 0x7UL, 0x7UL, 0x107UL, 0x107UL, 0x207UL, 0x207UL, 0x10207UL,
    0x10207UL, 0x307UL, 0x307UL, 0x10307UL, 0x10307UL, 0x20307UL, 0x20307UL, 0x1020307UL, 0x1020307UL, 0x407UL, 0x407UL, 0x10407UL,
    0x10407UL, 0x20407UL, 0x20407UL, 0x1020407UL, 0x1020407UL, 0x30407UL, 0x30407UL, 0x1030407UL, 0x1030407UL, 0x2030407UL,
    0x2030407UL, 0x102030407UL, 0x102030407UL, 0x507UL, 0x507UL, 0x10507UL, 0x10507UL, 0x20507UL, 0x20507UL, 0x1020507UL,
    0x1020507UL, 0x30507UL, 0x30507UL, 0x1030507UL, 0x1030507UL, 0x2030507UL, 0x2030507UL, 0x102030507UL, 0x102030507UL, 0x40507UL,
    0x40507UL, 0x1040507UL, 0x1040507UL, 0x2040507UL, 0x2040507UL, 0x102040507UL, 0x102040507UL, 0x3040507UL, 0x3040507UL,
    0x103040507UL, 0x103040507UL, 0x203040507UL, 0x203040507UL, 0x10203040507UL, 0x10203040507UL, 0x607UL, 0x607UL, 0x10607UL,
    0x10607UL, 0x20607UL, 0x20607UL, 0x1020607UL, 0x1020607UL, 0x30607UL, 0x30607UL, 0x1030607UL, 0x1030607UL, 0x2030607UL,
    0x2030607UL, 0x102030607UL, 0x102030607UL, 0x40607UL, 0x40607UL, 0x1040607UL, 0x1040607UL, 0x2040607UL, 0x2040607UL,
    0x102040607UL, 0x102040607UL, 0x3040607UL, 0x3040607UL, 0x103040607UL, 0x103040607UL, 0x203040607UL, 0x203040607UL,
    0x10203040607UL, 0x10203040607UL, 0x50607UL, 0x50607UL, 0x1050607UL, 0x1050607UL, 0x2050607UL, 0x2050607UL, 0x102050607UL,
    0x102050607UL, 0x3050607UL, 0x3050607UL, 0x103050607UL, 0x103050607UL, 0x203050607UL, 0x203050607UL, 0x10203050607UL,
    0x10203050607UL, 0x4050607UL, 0x4050607UL, 0x104050607UL, 0x104050607UL, 0x204050607UL, 0x204050607UL, 0x10204050607UL,
    0x10204050607UL, 0x304050607UL, 0x304050607UL, 0x10304050607UL, 0x10304050607UL, 0x20304050607UL, 0x20304050607UL,
    0x1020304050607UL, 0x1020304050607UL};

// Lane i of the result: lane order[i] (0 to 7) of x.
static inline int8 permuted(int8 x, int8 order) {
#ifdef CAPLET_EIGHT_IS_FAST
  typedef int caplet_v8si __attribute__((vector_size(32)));
  return __builtin_astype(__builtin_ia32_permvarsi256(__builtin_astype(x, caplet_v8si), __builtin_astype(order, caplet_v8si)), int8);
#else
  return shuffle(x, as_uint8(order));
#endif
}

// Byte i of the result: byte order[i] (0 to 7) of x.
static inline uchar8 permuted_bytes(uchar8 x, uchar8 order) {
#ifdef CAPLET_EIGHT_IS_FAST
  typedef char caplet_v16qi __attribute__((vector_size(16)));
  const uchar16 a = (uchar16)(x, (uchar8)(0)), b = (uchar16)(order, (uchar8)(0));
  return __builtin_astype(__builtin_ia32_pshufb128(__builtin_astype(a, caplet_v16qi), __builtin_astype(b, caplet_v16qi)), uchar16).lo;
#else
  return shuffle(x, order);
#endif
}

// Bit i of the result: bit k of byte i. The products of bit 8 i with 2^(56 - 7 i) meet at 56 + i, and no others get there.
static inline uint bit_column(ulong bytes, int k) { return (uint)(((bytes >> k & 0x0101010101010101UL) * 0x0102040810204080UL) >> 56); }

// Asks for 256 bytes that are read soon.
static inline void fetch_ahead(__global const float* at) {
#ifdef CAPLET_PREFETCH
  const char* line = (const char*)(size_t)at;
  __builtin_prefetch(line, 0, 3);
  __builtin_prefetch(line + 64, 0, 3);
  __builtin_prefetch(line + 128, 0, 3);
  __builtin_prefetch(line + 192, 0, 3);
#else
  (void)at;
#endif
}

#endif
