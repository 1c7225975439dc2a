// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds ends of emissive capsules that lie within the next capsule of a chain: light samples there
// would all be wasted.
#pragma once

#include <cstdint>
#include <vector>

#include "lower/detail/emitter.h"
#include "lower/flat_scene.h"

namespace caplet {

/// LightCover says how much of a light's primitive is sampled.
struct LightCover {
  std::uint32_t flags = 0;  // CAPLET_LIGHT_COVER_0 and _1 of LightRecord.flags
  double share = 1;         // of the primitive's area, before it is placed
};

/// Returns one for each emitter. The rounded end of a capsule is covered by every other emissive
/// capsule or sphere of the same part that holds the end's sphere: one that begins at the same
/// point, to the bit, with the same radius or a greater one. The uncovered part is stated as the
/// heights (normal times axis) that hold it, rounded up. Scattered rays that meet the rest count in
/// full, so no light is lost whatever is left out. `slots` of the emitters and `leaves` must be
/// set.
std::vector<LightCover> covered_ends(const std::vector<Emitter>& emitters, const FlatScene& flat);

}  // namespace caplet
