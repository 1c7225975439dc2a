// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The random numbers of paths, by their addresses: pixel, sample and dimension (dimensions.def). The only switches over kinds of samplers.
//
// A sampler of samplers.def is a file of this folder by its name, with
//   uint2 NAME_pair(at, dimension)   a point of the unit square, 32 bits a coordinate
//   uint NAME_bits(at, dimension)    a number that is as even by itself as the sampler can make it
#ifndef CAPLET_SAMPLERS_SAMPLERS_CL
#define CAPLET_SAMPLERS_SAMPLERS_CL

#include "samplers/sampler_types.cl"
#include "samplers/{samplers}.cl"

// Values in [0, 1).
static inline float2 sampler_2d(PathSample at, uint dimension) {
  uint2 pair = (uint2)(0u);
  switch (at.view->sampler) {
#define SAMPLER(name) \
  case sampler_##name: pair = name##_pair(at, dimension); break;
#include "rows/samplers.def"
#undef SAMPLER
    default: break;
  }
  return (float2)(unit_float(pair.x), unit_float(pair.y));
}

// Stratified over the samples of a pixel, where the sampler does that, with all of its bits.
static inline uint sampler_bits(PathSample at, uint dimension) {
  switch (at.view->sampler) {
#define SAMPLER(name) \
  case sampler_##name: return name##_bits(at, dimension);
#include "rows/samplers.def"
#undef SAMPLER
    default: return 0u;
  }
}

// The same in [0, 1).
static inline float sampler_1d(PathSample at, uint dimension) { return unit_float(sampler_bits(at, dimension)); }

#endif
