// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What is traced: random walks like bundles of neurites, as capsules or as ribbons of triangles, and the rays.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lower/encode.h"
#include "scene/scene.h"
#include "shared/records.h"

namespace caplet::bench {

/// Walks of 50 steps of length 0.01 (1e6 / n)^(1/3) in [-1, 1]^3, radius 0.12 steps (varied by half from walk to walk).
std::vector<FlatPrimitive> walk_capsules(std::size_t count);
/// The same walks as ribbons, two triangles a step, as wide as the capsules.
std::vector<FlatPrimitive> walk_triangles(std::size_t count);

/// Names of the kinds that walk_scene knows.
const std::vector<std::string>& walk_kinds();
/// The capsules' walks with one solid of another kind a step, about as thick as the capsules; no lights. `peer`: the same as
/// primitives that Embree has, empty for other kinds.
Scene walk_scene(const std::string& kind, std::size_t count, std::vector<FlatPrimitive>& peer);

/// walk_capsules as one shape of a scene of its own, which emits or does not.
Scene walk_lamps(std::size_t count, bool emit);

/// size x size pinhole rays from (0, 0, 3) towards the origin; the cube's side fills the picture.
std::vector<RayRecord> camera_rays(int size);
/// One cosine-distributed ray from each hit, starting a little off the surface.
std::vector<RayRecord> bounce_rays(std::span<const FlatPrimitive> primitives, std::span<const std::uint32_t> slots,
                                   std::span<const RayRecord> rays, std::span<const HitRecord> hits);
/// From each hit a little towards the ray's origin, uniform over the half of the directions that look back: for kinds whose
/// normals this program does not know.
std::vector<RayRecord> scattered_rays(std::span<const RayRecord> rays, std::span<const HitRecord> hits);
/// By Morton cell of the origin (32 a side) and octant of the direction.
void sort_rays(std::vector<RayRecord>& rays);

}  // namespace caplet::bench
