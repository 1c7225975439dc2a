// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This sampler puts one sample in each of sampler_x times sampler_y equal parts of the unit square,
// in an order that differs by pixel and dimension. Samples beyond that number begin a new round of
// all parts.
#ifndef CAPLET_SAMPLERS_STRATIFIED_CL
#define CAPLET_SAMPLERS_STRATIFIED_CL

#include "samplers/sampler_types.cl"

// Permutes the numbers below `count`: rounds of bijections of the least power of 2 that holds them,
// repeated until the result is below `count` (cycle walking; Black and Rogaway, "Ciphers with
// arbitrary finite domains", 2002).
static inline uint permuted_number(uint number, uint count, uint seed) {
  const uint bits = 32u - clz(count - 1u);
  const uint mask = bits == 0u ? 0u : 0xffffffffu >> (32u - bits), shift = (bits + 1u) / 2u;
  do {
    uint key = seed;
    for (int round = 0; round < 4; ++round) {
      number = (number * (key | 1u) + hash_mix(key ^ 0x9e3779b9u)) & mask;
      number ^= shift > 0u ? number >> shift : 0u;
      key = hash_mix(key + 0x85ebca6bu);
    }
  } while (number >= count);
  return number;
}

// Returns 2^32 times the place of a random point of part `part` of `parts`; of its middle without
// jitter.
static inline uint within_part(PathSample at, uint part, uint parts, uint random) {
  const uint inside = (at.view->strategy & CAPLET_STRATEGY_UNJITTERED) != 0u ? 0x80000000u : random;
  return (uint)((((ulong)part << 32) | inside) / parts);
}

static inline uint stratified_part(PathSample at, uint seed) {
  const uint parts = at.view->sampler_x * at.view->sampler_y, round = at.sample / parts;
  return permuted_number(at.sample - round * parts, parts, hash_combine(seed, round));
}

static inline uint2 stratified_pair(PathSample at, uint dimension) {
  const uint seed = hash_combine(at.seed, dimension);
  const uint across = at.view->sampler_x, part = stratified_part(at, seed), row = part / across;
  return (
      uint2)(within_part(at, part - row * across, across,
                         hash_combine(seed ^ 0x68bc21ebu, at.sample)),
             within_part(at, row, at.view->sampler_y, hash_combine(seed ^ 0x02e5be93u, at.sample)));
}

static inline uint stratified_bits(PathSample at, uint dimension) {
  const uint seed = hash_combine(at.seed, dimension);
  return within_part(at, stratified_part(at, seed), at.view->sampler_x * at.view->sampler_y,
                     hash_combine(seed ^ 0x68bc21ebu, at.sample));
}

#endif
