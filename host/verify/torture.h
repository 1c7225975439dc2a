// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The default scenes of `verify`.
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace caplet::verify {

/// Returns a valid scene with several shapes of every kind: radii from 1e-3 to 1e3, up to 1e4 times
/// as long, coordinates up to 1e5 (a shape is at most 1e5 of its sizes from the origin), rotated,
/// stretched and mirrored, in the world, in objects and instances; one-sided and reversed ones,
/// materials by surface; chains of capsules that share ends, boxes and triangles that share sides.
/// It has some 200 primitives and a camera that sees the middle, and depends only on both numbers.
Scene torture_scene(std::uint64_t seed, std::uint64_t round);

}  // namespace caplet::verify
