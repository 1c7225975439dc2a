// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This sampler makes padded two-dimensional Sobol points with hash-based Owen scrambling and
// shuffling: Burley, "Practical Hash-based Owen Scrambling", JCGT 2020; Laine and Karras,
// "Stratified sampling for stochastic transparency", 2011. Any aligned block of 2^m samples is a
// (0, m, 2)-net.
#ifndef CAPLET_SAMPLERS_SOBOL_CL
#define CAPLET_SAMPLERS_SOBOL_CL

#include "samplers/sampler_types.cl"

static inline uint2 sobol_pair(PathSample at, uint dimension) {
  const uint seed = hash_combine(at.key, dimension);
  const uint index = shuffled_index(at.number, seed);
  return (uint2)(owen_sobol_x(index, seed), owen_sobol_y(index, seed));
}

static inline uint sobol_bits(PathSample at, uint dimension) {
  const uint seed = hash_combine(at.key, dimension);
  return owen_sobol_x(shuffled_index(at.number, seed), seed);
}

#endif
