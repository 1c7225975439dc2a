// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Hits of shapes whose points move, compared with those of the scene that stands still at a time.
#pragma once

#include <initializer_list>

#include "reference/solver.h"
#include "scene/scene.h"
#include "shared/records.h"

namespace caplet::test {

/// Expects that rays at many times see, to the bit, what they see in the scene as it is then. The
/// shutter is open from 0.5 to 2 seconds. `moving`: a kind of shape that the scene has; `still`:
/// those that it has at each time.
void expect_hits_of_frozen(const Scene& scene, int moving, std::initializer_list<int> still);

/// OffReference is how far a hit is from the reference's, along the surface's normal, and how far
/// it may be.
struct OffReference {
  double off, bound;
  double cosine;  // between the ray and the normal
};
/// `t`: the reference's, of the scene that stands still.
OffReference off_reference(const PickRecord& pick, const reference::Ray& ray, double t);

}  // namespace caplet::test
