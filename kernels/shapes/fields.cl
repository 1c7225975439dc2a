// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file defines the fields of shapes.def as functions of a primitive's data: capsule_r(data),
// capsule_p0(data). Datum j is at data[8 * j].
#ifndef CAPLET_SHAPES_FIELDS_CL
#define CAPLET_SHAPES_FIELDS_CL

#include "shared/shapes.h"

// Returns the data of the primitive in lane `lane` of a leaf block.
static inline __global const float* lane_data(__global const float* block, uint lane) {
  return block + 8 + lane;
}

#define CAPLET_FIELD_scalar(function, at) \
  static inline float function(__global const float* data) { return data[8 * (at)]; }
#define CAPLET_FIELD_vector(function, at)                                     \
  static inline float3 function(__global const float* data) {                 \
    return (float3)(data[8 * (at)], data[8 * (at) + 8], data[8 * (at) + 16]); \
  }
#define CAPLET_FIELD_index(function, at) \
  static inline uint function(__global const float* data) { return as_uint(data[8 * (at)]); }
#define SHAPE(name, traits)
#define FIELD(shape, name, type) CAPLET_FIELD_##type(shape##_##name, shape##_at_##name)
#include "shared/shapes.def"
#undef SHAPE
#undef CAPLET_FIELD_scalar
#undef CAPLET_FIELD_vector
#undef CAPLET_FIELD_index

#endif
