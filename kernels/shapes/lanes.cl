// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file defines the fields of shapes.def as functions of a leaf block: capsule_r_lanes(block,
// lane), for all its primitives at once or for the one in `lane` (real.cl).
#ifndef CAPLET_SHAPES_LANES_CL
#define CAPLET_SHAPES_LANES_CL

#include "shapes/real.cl"
#include "shared/shapes.h"

typedef struct {
  real x, y, z;
} RealVector;

#define CAPLET_FIELD_scalar(function, at)                               \
  static inline real function(__global const float* block, uint lane) { \
    return real_load(block + 8 * (1 + (at)), lane);                     \
  }
#define CAPLET_FIELD_vector(function, at)                                     \
  static inline RealVector function(__global const float* block, uint lane) { \
    const RealVector v = {real_load(block + 8 * (1 + (at)), lane),            \
                          real_load(block + 8 * (2 + (at)), lane),            \
                          real_load(block + 8 * (3 + (at)), lane)};           \
    return v;                                                                 \
  }
#define CAPLET_FIELD_index(function, at)                                     \
  static inline real_mask function(__global const float* block, uint lane) { \
    return real_bits(real_load(block + 8 * (1 + (at)), lane));               \
  }
#define SHAPE(name, traits)
#define FIELD(shape, name, type) CAPLET_FIELD_##type(shape##_##name##_lanes, shape##_at_##name)
#include "shared/shapes.def"
#undef SHAPE
#undef CAPLET_FIELD_scalar
#undef CAPLET_FIELD_vector
#undef CAPLET_FIELD_index

#endif
