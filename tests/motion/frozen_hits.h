// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Hits of shapes whose points move, compared with those of the scene that stands still at a time.
#pragma once

#include <functional>
#include <initializer_list>
#include <vector>

#include "scene/scene.h"
#include "shared/records.h"

namespace caplet::test {

/// Expects that rays at many times see, to the bit, what they see in the scene as it is then. The
/// shutter is open from 0.5 to 2 seconds. `moving`: a kind of shape that the scene has; `still`:
/// those that it has at each time.
void expect_hits_of_frozen(const Scene& scene, int moving, std::initializer_list<int> still);

/// BesideReference counts the rays that meet something in the reference, those whose hits are
/// within their bounds of the reference's, and those that meet something else.
struct BesideReference {
  int hits = 0, near = 0, apart = 0;
};
/// Compares nearest hits, in both encodings, with the reference's in the scene frozen at `times` (0
/// to 1 of the shutter). Expects hits that are apart to graze. rays(seed): those of a time.
BesideReference beside_reference(const Scene& scene, const std::vector<float>& times,
                                 const std::function<std::vector<RayRecord>(unsigned seed)>& rays);

}  // namespace caplet::test
