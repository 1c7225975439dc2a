// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds hashes, and random numbers made from them.
#ifndef CAPLET_MATH_RNG_CL
#define CAPLET_MATH_RNG_CL

// This is a bijection of 32 bits in which every input bit flips every output bit with probability
// near 1/2 ("lowbias32", Wellons 2018).
static inline uint hash_mix(uint x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ (x >> 16);
}

// Returns the hash of an ordered pair; for a fixed a (or b) different b (or a) never collide.
static inline uint hash_combine(uint a, uint b) { return hash_mix(a + b * 0x9e3779b9u); }

// Returns the seed of all random numbers of a pixel.
static inline uint pixel_seed(uint x, uint y, uint seed) {
  return hash_combine(hash_combine(hash_mix(seed), x), y);
}

// Returns the top 24 bits as a float in [0, 1 - 2^-24].
static inline float unit_float(uint x) { return (float)(x >> 8) * 5.9604644775390625e-8f; }

#endif
