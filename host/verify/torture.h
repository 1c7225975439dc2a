// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The scenes that `verify` uses when it is given none.
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace caplet::verify {

/// Every kind of shape, some of each: radii from 1e-3 to 1e3, up to 1e4 times as long, coordinates up to 1e5 (a shape is at most
/// 1e5 of its sizes from the origin), turned, stretched and mirrored, in the world, in objects and instances; one-sided and
/// reversed ones, materials by surface; chains of capsules that share ends, boxes and triangles that share sides. Valid; some 200
/// primitives; a camera that sees the middle. Depends on both numbers alone.
Scene torture_scene(std::uint64_t seed, std::uint64_t round);

}  // namespace caplet::verify
