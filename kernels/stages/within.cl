// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// In subsurfaces everything that light meets from where it enters through the boundary until it
// leaves counts as one scattering, as where pbrt-v4 has a profile of diffusion. Scatterings after
// the first do not count towards the greatest depth of a path, but have a roulette of their own.
#ifndef CAPLET_STAGES_WITHIN_CL
#define CAPLET_STAGES_WITHIN_CL

#include "math/rng.cl"
#include "media/medium_stack.cl"
#include "stages/path.cl"

static inline int medium_is_within(const Media* media, uint medium) {
  return medium != CAPLET_NONE && (media->mediums[medium].flags & CAPLET_MEDIUM_SUBSURFACE) != 0u;
}

// Returns whether a ray meets the boundary of a subsurface from within.
static inline int boundary_is_met_within(const Stage* g, uint path, const HitRecord* hit) {
  const uint boundary = boundary_of(&g->tree, &g->surfaces, &g->media, hit);
  if (boundary == CAPLET_NONE) return 0;
  const uint medium = g->media.boundaries[boundary].inside;
  if (!medium_is_within(&g->media, medium) ||
      !boundary_is_left(&g->tree, &g->surfaces, &g->media, boundary, hit))
    return 0;
  const MediumStack stack = {g->medium_stacks.path_inside[path],
                             g->medium_stacks.path_around[path]};
  const MediumStack here = medium_stack_before(&g->tree, &g->surfaces, &g->media, hit, 1, stack);
  return medium_stack_medium(&g->media, &here) == medium;
}

// Returns whether a path goes on, by the random number u, after `within` scatterings that did not
// count and one more. Light leaves a half-space that absorbs nothing with a tail of n^-1/2; going
// on with 1 - 1 / 2n leaves weights of such a tail with a finite mean and, beyond 2,048, none is
// endless.
static inline int within_survives(uint within, float u, float4* throughput) {
  if (within < 64u) return 1;
  const float ends = fmax(0.5f / (float)within, 0x1p-12f);
  if (u < ends) return 0;
  *throughput /= 1.0f - ends;
  return 1;
}

// The same for the path, whose random numbers have the key `hash`; counts the scattering.
static inline int path_survives_within(const Stage* g, uint path, uint within, uint hash,
                                       float4* throughput) {
  const float u =
      (float)(hash_mix(hash_combine(hash ^ HASHED_SAMPLE(within), within)) >> 8) * 0x1p-24f;
  if (!within_survives(within, u, throughput)) return 0;
  g->medium_stacks.path_within[path] = within + 1u;
  return 1;
}

#endif
