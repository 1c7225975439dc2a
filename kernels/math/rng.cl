// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Addressed random numbers: padded two-dimensional Sobol points with hash-based Owen scrambling and shuffling. Burley, "Practical
// Hash-based Owen Scrambling", JCGT 2020; Laine and Karras, "Stratified sampling for stochastic transparency", 2011.
#ifndef CAPLET_MATH_RNG_CL
#define CAPLET_MATH_RNG_CL

// A bijection of 32 bits in which every input bit flips every output bit with probability near 1/2 ("lowbias32", Wellons 2018).
static inline uint hash_mix(uint x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ (x >> 16);
}

// Hash of an ordered pair; for a fixed a (or b) different b (or a) never collide.
static inline uint hash_combine(uint a, uint b) { return hash_mix(a + b * 0x9e3779b9u); }

// Seed of all random numbers of a pixel.
static inline uint pixel_seed(uint x, uint y, uint seed) { return hash_combine(hash_combine(hash_mix(seed), x), y); }

static inline uint reverse_bits(uint x) {
  x = (x >> 16) | (x << 16);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

// Each bit is flipped by a hash of the bits below it: on reversed bits, an Owen scrambling (constants: Vegdahl, "Building a
// better LK hash", 2021).
static inline uint scramble_reversed(uint x, uint seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  return x ^ (x * 0x53a22864u);
}

// The second Sobol dimension, digits least significant first on both sides: digit j is the sum over k of C(k, j) times digit k,
// modulo 2, and C(k, j) is odd exactly when j is a subset of k (Lucas).
static inline uint pascal_reversed(uint x) {
  x ^= x >> 16;
  x ^= (x >> 8) & 0x00ff00ffu;
  x ^= (x >> 4) & 0x0f0f0f0fu;
  x ^= (x >> 2) & 0x33333333u;
  return x ^ ((x >> 1) & 0x55555555u);
}

// The top 24 bits as a float in [0, 1 - 2^-24].
static inline float unit_float(uint x) { return (float)(x >> 8) * 5.9604644775390625e-8f; }

// The sample's place in the shuffled sequence; an aligned block of 2^m samples stays an aligned block.
static inline uint shuffled_index(uint sample, uint seed) { return reverse_bits(scramble_reversed(reverse_bits(sample), seed)); }

// Sample `sample` of pair `dimension_pair`: any aligned block of 2^m samples is a (0, m, 2)-net. Values in [0, 1).
static inline float2 sampler_2d(uint pixel_seed, uint sample, uint dimension_pair) {
  const uint seed = hash_combine(pixel_seed, dimension_pair);
  const uint index = shuffled_index(sample, seed);
  const uint x = reverse_bits(scramble_reversed(index, hash_mix(seed ^ 0x68bc21ebu)));
  const uint y = reverse_bits(scramble_reversed(pascal_reversed(index), hash_mix(seed ^ 0x02e5be93u)));
  return (float2)(unit_float(x), unit_float(y));
}

// The first coordinate of sampler_2d, alone, with all of its bits: stratified over any aligned block of 2^m samples.
static inline uint sampler_bits(uint pixel_seed, uint sample, uint dimension_pair) {
  const uint seed = hash_combine(pixel_seed, dimension_pair);
  return reverse_bits(scramble_reversed(shuffled_index(sample, seed), hash_mix(seed ^ 0x68bc21ebu)));
}
static inline float sampler_1d(uint pixel_seed, uint sample, uint dimension_pair) {
  return unit_float(sampler_bits(pixel_seed, sample, dimension_pair));
}

#endif
