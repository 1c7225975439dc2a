// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This sampler makes independent uniform numbers: hashes of their addresses.
#ifndef CAPLET_SAMPLERS_INDEPENDENT_CL
#define CAPLET_SAMPLERS_INDEPENDENT_CL

#include "samplers/sampler_types.cl"

static inline uint independent_bits(PathSample at, uint dimension) {
  return hash_combine(hash_combine(at.seed, dimension) ^ 0x68bc21ebu, at.sample);
}

static inline uint2 independent_pair(PathSample at, uint dimension) {
  return (uint2)(independent_bits(at, dimension),
                 hash_combine(hash_combine(at.seed, dimension) ^ 0x02e5be93u, at.sample));
}

#endif
