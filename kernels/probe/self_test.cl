// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// These kernels compute what Caplet's kernels rely on; host/device/self_test.cpp checks it.

// Computes twelve values for each pair of numbers.
__kernel void arithmetic(__global const float* pairs, __global float* out, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  const float a = pairs[2 * i], b = pairs[2 * i + 1];
  __global float* row = out + 12 * i;
  row[0] = a + b;
  row[1] = a - b;
  row[2] = a * b;
  row[3] = a / b;
  row[4] = sqrt(a);
  row[5] = fma(a, b, -a);
  row[6] = fmin(a, b);
  row[7] = fmax(a, b);
  row[8] = floor(a);
  row[9] = fabs(a);
  row[10] = copysign(a, b);
  row[11] = as_float(as_uint(a) ^ 0x80000000u);
}

// Computes one word of answers for each pair of numbers.
__kernel void comparisons(__global const float* pairs, __global uint* out, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  const float a = pairs[2 * i], b = pairs[2 * i + 1];
  uint answers = 0;
  answers |= (a < b ? 1u : 0u) << 0;
  answers |= (a <= b ? 1u : 0u) << 1;
  answers |= (a == b ? 1u : 0u) << 2;
  answers |= (a != b ? 1u : 0u) << 3;
  answers |= (a >= b ? 1u : 0u) << 4;
  answers |= (!(a > b) ? 1u : 0u) << 5;
  answers |= (isnan(a) ? 1u : 0u) << 6;
  answers |= (isinf(a) ? 1u : 0u) << 7;
  answers |= (signbit(a) ? 1u : 0u) << 8;
  // This tests lane 5 of the vector forms, where true is -1.
  const float8 wide_a = (float8)(1.0f, 2.0f, 3.0f, 4.0f, 5.0f, a, 7.0f, 8.0f);
  const float8 wide_b = (float8)(2.0f, 2.0f, 2.0f, 2.0f, 2.0f, b, 2.0f, 2.0f);
  const int8 less = wide_a < wide_b;
  answers |= (less.s5 == -1 ? 1u : 0u) << 9;
  answers |= (less.s0 == -1 && less.s1 == 0 && less.s7 == 0 ? 1u : 0u) << 10;
  answers |= (any(isnan(wide_a)) ? 1u : 0u) << 11;
  out[i] = answers;
}

// Computes eight words for each pair of integers.
__kernel void integers(__global const uint* pairs, __global uint* out, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  const uint a = pairs[2 * i], b = pairs[2 * i + 1];
  __global uint* row = out + 8 * i;
  row[0] = clz(a);
  row[1] = popcount(a);
  row[2] = a << (b & 31u);
  row[3] = a >> (b & 31u);
  row[4] = (uint)((int)a >> (b & 31u));
  row[5] = mul_hi(a, b);
  row[6] = rotate(a, b);
  row[7] = a * b;
}

// Copies eight floats, chosen lane by lane, from an address that is aligned only for a float to
// another such address.
__kernel void lanes(__global const float* in, __global float* out, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  const float8 x = vload8(i, in + 1);
  const float8 y = vload8(i, in + 3);
  vstore8(select(x, y, x < 0.0f), i, out + 1);
}

// Tests atomics on `totals`: 0 counter of all work-items, 1 sum of their ids, 2 largest id, 3 bits
// set by each. ids: the local size, local id, group id and global size that each item reads.
__kernel void groups(__global uint* totals, __global uint* tickets, __global uint* ids) {
  const uint i = (uint)get_global_id(0);
  tickets[i] = atomic_inc(totals);
  atomic_add(totals + 1, i);
  atomic_max(totals + 2, i);
  atomic_or(totals + 3, 1u << (i & 31u));
  ids[4 * i] = (uint)get_local_size(0);
  ids[4 * i + 1] = (uint)get_local_id(0);
  ids[4 * i + 2] = (uint)get_group_id(0);
  ids[4 * i + 3] = (uint)get_global_size(0);
}
