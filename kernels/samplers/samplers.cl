// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file makes the random numbers of paths by their addresses: pixel, sample and dimension
// (dimensions.def). It holds the only switches over kinds of samplers.
//
// A sampler of samplers.def has a file in this folder with its name, which defines
//   uint2 NAME_pair(at, dimension)   a point of the unit square, 32 bits a coordinate
//   uint NAME_bits(at, dimension)    a number that is as even by itself as the sampler can make it
#ifndef CAPLET_SAMPLERS_SAMPLERS_CL
#define CAPLET_SAMPLERS_SAMPLERS_CL

#include "samplers/sampler_types.cl"
#include "samplers/{samplers}.cl"
#include "samplers/zsobol.cl"

// Programs with only one sampler do not test which it is.
enum {
  sampler_rows = 0
#define SAMPLER(name) +1
#include "rows/samplers.def"
#undef SAMPLER
};
enum {
  sampler_sum = 0
#define SAMPLER(name) +sampler_##name
#include "rows/samplers.def"
#undef SAMPLER
};
static inline uint sampler_of(__global const ViewRecord* view) {
  return sampler_rows == 1 ? (uint)sampler_sum : view->sampler;
}

static inline PathSample sample_of_pixel(__global const ViewRecord* view, uint x, uint y,
                                         uint sample) {
  const uint seed = pixel_seed(x, y, view->seed);
  PathSample at = {
      x, y, sample, seed, sample >> sequence_bits(view), sequence_key(view, sample, seed), view};
  if (sampler_of(view) == sampler_zsobol) zsobol_address(&at);
  return at;
}

// Returns values in [0, 1).
static inline float2 sampler_2d(PathSample at, uint dimension) {
  uint2 pair = (uint2)(0u);
  switch (sampler_of(at.view)) {
#define SAMPLER(name)                  \
  case sampler_##name:                 \
    pair = name##_pair(at, dimension); \
    break;
#include "rows/samplers.def"
#undef SAMPLER
    default: break;
  }
  return (float2)(unit_float(pair.x), unit_float(pair.y));
}

// Returns a number with all of its bits, stratified over the samples of a pixel if the sampler
// stratifies.
static inline uint sampler_bits(PathSample at, uint dimension) {
  switch (sampler_of(at.view)) {
#define SAMPLER(name)  \
  case sampler_##name: \
    return name##_bits(at, dimension);
#include "rows/samplers.def"
#undef SAMPLER
    default: return 0u;
  }
}

// Returns sampler_bits as a number in [0, 1).
static inline float sampler_1d(PathSample at, uint dimension) {
  return unit_float(sampler_bits(at, dimension));
}

#endif
