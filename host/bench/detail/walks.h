// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The benchmark scenes: random walks like bundles of neurites, as capsules or as ribbons of
// triangles, and the rays.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lower/encode.h"
#include "scene/scene.h"
#include "shared/records.h"

namespace caplet::bench {

/// Returns walks of 50 steps of length 0.01 (1e6 / n)^(1/3) in [-1, 1]^3, radius 0.12 steps (varied
/// by half between walks).
std::vector<FlatPrimitive> walk_capsules(std::size_t count);
/// Returns the same walks as ribbons, two triangles per step, as wide as the capsules.
std::vector<FlatPrimitive> walk_triangles(std::size_t count);

/// Lists the kinds that walk_scene knows.
const std::vector<std::string>& walk_kinds();
/// Returns the capsules' walks with one solid of another kind per step, about as thick as the
/// capsules; no lights. `peer`: equivalent primitives that Embree has, empty for other kinds.
Scene walk_scene(const std::string& kind, std::size_t count, std::vector<FlatPrimitive>& peer);

/// Returns walk_capsules as one shape of a scene, which emits or does not.
Scene walk_lamps(std::size_t count, bool emit);

/// Returns size x size pinhole rays from (0, 0, 3) towards the origin; the cube's side fills the
/// picture.
std::vector<RayRecord> camera_rays(int size);
/// Returns one cosine-distributed ray from each hit, starting slightly off the surface.
std::vector<RayRecord> bounce_rays(std::span<const FlatPrimitive> primitives,
                                   std::span<const std::uint32_t> slots,
                                   std::span<const RayRecord> rays,
                                   std::span<const HitRecord> hits);
/// Returns rays that start at each hit, moved slightly towards the ray's origin, uniform over the
/// hemisphere of directions that point back: for kinds whose normals this program does not know.
std::vector<RayRecord> scattered_rays(std::span<const RayRecord> rays,
                                      std::span<const HitRecord> hits);
/// Sorts by Morton cell of the origin (32 per side) and octant of the direction.
void sort_rays(std::vector<RayRecord>& rays);

}  // namespace caplet::bench
