// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds what samplers share: the address of a path's random numbers, and scrambled Sobol
// points.
#ifndef CAPLET_SAMPLERS_SAMPLER_TYPES_CL
#define CAPLET_SAMPLERS_SAMPLER_TYPES_CL

#include "math/rng.cl"
#include "shared/records.h"

typedef struct {
  uint x, y;  // pixel of the full image
  uint sample;
  uint seed;         // of the pixel
  uint number, key;  // of the Sobol samplers: the point's number in the sequence of this key
  __global const ViewRecord* view;
} PathSample;

// Samples of even and of odd number are two replicates. With CAPLET_STRATEGY_REPLICATES each has
// its own sequence of a Sobol sampler, so that they are independent and their difference says what
// the variance is (docs/decisions/0033-two-replicates-say-the-error.md).
static inline uint replicate_of(uint sample) { return sample & 1u; }

// Returns how many bits of a sample's number name its sequence.
static inline uint sequence_bits(__global const ViewRecord* view) {
  return (view->strategy & CAPLET_STRATEGY_REPLICATES) != 0u ? 1u : 0u;
}

// Returns the key of a sample's sequence; `key` is that of the first one.
static inline uint sequence_key(__global const ViewRecord* view, uint sample, uint key) {
  return (sample & sequence_bits(view)) == 0u ? key : hash_mix(key ^ 0x2f7a5d3bu);
}

static inline uint reverse_bits(uint x) {
  x = (x >> 16) | (x << 16);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

// Each bit is flipped by a hash of the bits below it: on reversed bits, an Owen scrambling
// (constants: Vegdahl, "Building a better LK hash", 2021).
static inline uint scramble_reversed(uint x, uint seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  return x ^ (x * 0x53a22864u);
}

// Returns the place of a number in the shuffled sequence; an aligned block of 2^m numbers stays an
// aligned block.
static inline uint shuffled_index(uint number, uint seed) {
  return reverse_bits(scramble_reversed(reverse_bits(number), seed));
}

// Computes the second Sobol dimension, digits least significant first on both sides: digit j is the
// sum over k of C(k, j) times digit k, modulo 2, and C(k, j) is odd exactly when j is a subset of k
// (Lucas).
static inline uint pascal_reversed(uint x) {
  x ^= x >> 16;
  x ^= (x >> 8) & 0x00ff00ffu;
  x ^= (x >> 4) & 0x0f0f0f0fu;
  x ^= (x >> 2) & 0x33333333u;
  return x ^ ((x >> 1) & 0x55555555u);
}

// These return the coordinates of point `index` of the first two Sobol dimensions under the Owen
// scrambling of a seed, 32 bits each.
static inline uint owen_sobol_x(uint index, uint seed) {
  return reverse_bits(scramble_reversed(index, hash_mix(seed ^ 0x68bc21ebu)));
}
static inline uint owen_sobol_y(uint index, uint seed) {
  return reverse_bits(scramble_reversed(pascal_reversed(index), hash_mix(seed ^ 0x02e5be93u)));
}

#endif
