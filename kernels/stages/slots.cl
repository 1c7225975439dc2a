// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A pixel's list of what its samples met: SLOT_LAYER of layers.def. Films that are added make the
// same lists (host/film/slots.h), in any order, because a slot is only ever lost to smaller keys.
#ifndef CAPLET_STAGES_SLOTS_CL
#define CAPLET_STAGES_SLOTS_CL

#include "math/exact.cl"
#include "shared/limits.h"

// Returns the key of a value: that of a matte is the hash of a name, that of a distance tells it to
// 1/64. Distances are positive, so that their bits have their order.
static inline uint slot_key_matte(float v) { return as_uint(v); }
static inline uint slot_key_deep(float v) { return as_uint(v) >> CAPLET_DEEP_SHIFT; }

// Returns a value as a whole number of 2^unit.
static inline ulong slot_whole_units(float v, int unit) {
  ulong4 sum[1] = {(ulong4)(0)};
  exact_add(sum, 1, (float4)(v, 0.0f, 0.0f, 0.0f), unit);
  return sum[0].x;
}

static inline void slots_clear(__global ulong* slots, const int words) {
  for (int i = 0; i < CAPLET_SLOTS * words; ++i) slots[i] = 0;
}

// Counts a sample in the slot of its key, and adds `more` to its second word if it has one.
static inline void slots_add(__global ulong* slots, const int words, uint key, ulong more) {
  __global ulong* const end = slots + CAPLET_SLOTS * words;
  while (slots != end && (uint)*slots != 0u && (uint)(*slots >> 32) < key) slots += words;
  if (slots == end) return;
  if ((uint)*slots != 0u && (uint)(*slots >> 32) == key) {
    *slots += 1ul;
    if (words == 2) slots[1] += more;
    return;
  }
  // A new slot moves those behind it on by one.
  ulong moved = (ulong)key << 32 | 1ul;
  for (; slots != end && (uint)moved != 0u; slots += words) {
    const ulong here = *slots;
    *slots = moved;
    moved = here;
    if (words == 2) {
      const ulong sum = slots[1];
      slots[1] = more;
      more = sum;
    }
  }
}

#endif
