// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A path stores values of its first hit for the layers: BatchRecord.layer_floats floats, for the
// layers that the film has, in the order of layers.def.
#ifndef CAPLET_STAGES_LAYERS_CL
#define CAPLET_STAGES_LAYERS_CL

#include "shared/kinds.h"
#include "shared/records.h"

static inline __global float* layers_of_path(__global const BatchRecord* batch, uint path,
                                             __global float* path_layers) {
  return path_layers + (size_t)path * batch->layer_floats;
}

// Stores the values of a camera ray that has hit nothing yet.
static inline void layers_of_nothing(__global const BatchRecord* batch, uint path,
                                     __global float* path_layers) {
  __global float* at = layers_of_path(batch, path, path_layers);
  const uint layers = batch->layers;
#define RADIANCE_LAYER(name, option, channels, how, count, words, unit, value)
#define HIT_LAYER(name, option, channels, how, count, words, unit, value) \
  if (layers & (1u << layer_##name))                                      \
    for (int c = 0; c < count; ++c) *at++ = 0.0f;
#define ID_LAYER(name, option, channel, value) \
  if (layers & (1u << layer_##name)) *at++ = as_float(CAPLET_NONE);
#define SLOT_LAYER(name, option, channels, how, words, unit, value) \
  if (layers & (1u << layer_##name)) *at++ = as_float(CAPLET_NONE);
#include "shared/layers.def"
#undef RADIANCE_LAYER
#undef HIT_LAYER
#undef ID_LAYER
#undef SLOT_LAYER
}

#endif
