// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes sums that do not depend on the order of adding: whole numbers of a unit, in two's
// complement of 64-bit words, least significant first
// (docs/decisions/0008-the-films-sums-are-exact.md).
#ifndef CAPLET_MATH_EXACT_CL
#define CAPLET_MATH_EXACT_CL

// Returns 2^exponent, for exponents of normal numbers.
static inline float power_of_two(int exponent) { return as_float((uint)(127 + exponent) << 23); }

// Adds the components of v to four sums of `words` (1 to 3) words whose unit is 2^unit, |unit + 64
// (words - 1)| <= 250. A value is rounded towards zero to whole units and counts as at most 2^(64
// words - 26) of them (infinity and NaN too), so that 2^25 additions cannot overflow.
//
// Every step is exact: products by powers of two are (what they lose below the smallest normal
// number is far below a unit), and so are a number's whole part and the rest.
static inline void exact_add(ulong4* sums, const int words, float4 v, int unit) {
  const int shift = 64 * (1 - words) - unit;  // to units of the leading word
  float4 left = fabs(v) * power_of_two(shift / 2) * power_of_two(shift - shift / 2);
  left = left < 0x1p38f ? left : (float4)(0x1.fffffep37f);
  const ulong4 flip = as_ulong4(convert_long4(v < 0.0f));
  ulong4 part[3];
  part[words - 1] = as_ulong4(convert_long4(left));
  for (int w = words - 2; w >= 0; --w) {
    left = (left - convert_float4(part[w + 1])) * 0x1p64f;
    part[w] = convert_ulong4(left);
  }
  ulong4 carry = flip & (ulong)1;
  for (int w = 0; w < words; ++w) {
    const ulong4 addend = part[w] ^ flip;
    const ulong4 partial = sums[w] + addend;
    const ulong4 total = partial + carry;
    carry = as_ulong4((partial < addend) | (total < partial)) & (ulong)1;
    sums[w] = total;
  }
}

#endif
