// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is a primitive as its kernel reads it.
#pragma once

#include <cstdint>

#include "shared/shapes.h"

namespace caplet {

/// FlatPrimitive is one primitive: its fields (shapes.def: p.data[capsule_at_r],
/// capsule_r(p.data)), in the space of its tree. Kinds with trait_kept_box have their box (min 3,
/// max 3) behind them.
struct FlatPrimitive {
  std::uint32_t shape;
  std::uint32_t id;  // global primitive id; for instances the index into FlatScene::instances
  float data[12];
  const float* kept_box() const { return data + data_of[shape]; }
  float* kept_box() { return data + data_of[shape]; }
};
#define SHAPE(name, traits)                                            \
  static_assert(name##_data + ((traits)&trait_kept_box ? 6 : 0) <= 12, \
                "FlatPrimitive holds a " #name);
#include "shared/shapes.def"
#undef SHAPE

}  // namespace caplet
