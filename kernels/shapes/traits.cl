// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file says which kinds of shapes are solids.
#ifndef CAPLET_SHAPES_TRAITS_CL
#define CAPLET_SHAPES_TRAITS_CL

#include "shared/shapes.h"

// Returns whether shapes of this kind cross a line in one span only.
static inline int shape_is_solid(uint shape) {
  switch (shape) {
#define SHAPE(name, traits) \
  case shape_##name:        \
    return ((traits)&trait_solid) != 0;
#include "rows/shapes.def"
#undef SHAPE
    default: return 0;
  }
}

#endif
