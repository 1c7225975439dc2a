// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This sampler distributes one Sobol sequence over the whole image: pixels take its points in a
// shuffled Morton order. The samples of a square block of pixels are a net together, so that the
// error of neighbouring pixels cancels. Ahmed and Wonka, "Screen-space blue-noise diffusion of
// Monte Carlo sampling error via hierarchical ordering of pixels", 2020, describe it; the shuffling
// is Burley's.
#ifndef CAPLET_SAMPLERS_ZSOBOL_CL
#define CAPLET_SAMPLERS_ZSOBOL_CL

#include "samplers/sampler_types.cl"
#include "samplers/sobol.cl"

// Returns the low 16 bits at the even places of 32.
static inline uint spread_bits(uint x) {
  x &= 0xffffu;
  x = (x | (x << 8)) & 0x00ff00ffu;
  x = (x | (x << 4)) & 0x0f0f0f0fu;
  x = (x | (x << 2)) & 0x33333333u;
  return (x | (x << 1)) & 0x55555555u;
}

// Sets the number and the key of a sample's point. Bits beyond the 32 of a number, and samples
// beyond those that were asked for, select another sequence.
static inline void zsobol_address(PathSample* at) {
  const uint replicates = sequence_bits(at->view), sample = at->number;
  const uint bits = max(at->view->sampler_x, replicates) - replicates;
  const ulong pixel = (ulong)(spread_bits(at->x) | (spread_bits(at->y) << 1));
  const ulong index = (pixel << bits) | (sample & ((1u << bits) - 1u));
  at->number = (uint)index;
  at->key = sequence_key(
      at->view, at->sample,
      hash_combine(hash_combine(hash_mix(at->view->seed), (uint)(index >> 32)), sample >> bits));
}

static inline uint2 zsobol_pair(PathSample at, uint dimension) { return sobol_pair(at, dimension); }
static inline uint zsobol_bits(PathSample at, uint dimension) { return sobol_bits(at, dimension); }

#endif
