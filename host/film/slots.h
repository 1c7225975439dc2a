// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A pixel's list of what its samples met (SLOT_LAYER of shared/layers.def): which things, and how
// often.
#pragma once

#include <cstdint>
#include <vector>

#include "shared/limits.h"

namespace caplet {

inline constexpr int slots_of_a_pixel = CAPLET_SLOTS;

struct Slot {
  std::uint32_t key = 0, samples = 0;
  double sum = 0;  // of the samples' values; 0 in a list without
  bool operator==(const Slot&) const = default;
};

/// Returns the slots in use of a pixel, in the order of their keys. `words`: of a slot; `unit`: of
/// its sum.
std::vector<Slot> slots_at(const std::uint64_t* words_of_pixel, int words, double unit);

/// Adds the slots of a pixel to those of another. Where there are more keys than slots the greatest
/// are lost, so that lists can be added in any order.
void add_slots(std::uint64_t* to, const std::uint64_t* from, int words);

}  // namespace caplet
