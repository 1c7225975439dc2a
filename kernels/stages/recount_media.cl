// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Recounts, before distances are sampled, the boundaries that contain rays which began where
// several surfaces are at one place, and finds whether their hits are at such a place.
#include "stages/crossings.cl"
#include "media/passing.cl"
#include "stages/path.cl"
#include "stages/times.cl"

static void stage_item(const Stage* g, uint item) {
  const uint path = g->queues.queue[item];
  SEE_AT(PATH_TIME(g, path));
  const RayRecord ray = g->rays.path_ray[path];
  const HitRecord hit = g->rays.path_hit[path];
  const int begins = path_begins(g->carried.path_flags[path], &ray);
  if (!begins && g->medium_stacks.path_near[path] == CAPLET_RECOUNT) {
    MediumStack stack = {g->medium_stacks.path_inside[path], g->medium_stacks.path_around[path]};
    stack = medium_stack_counted(&g->tree, &g->surfaces, &g->media, ray, stack);
    g->medium_stacks.path_inside[path] = stack.inside;
    g->medium_stacks.path_around[path] = stack.around;
  }
  g->medium_stacks.path_near[path] = CAPLET_ALONE;
  if (hit.slot == CAPLET_NONE) return;

  RayRecord around = ray;
  const float apart = crossings_apart(&ray, hit.t);
  around.t_min = hit.t - apart;
  around.t_max = hit.t + apart;
  RayCrossings crossings;
  crossings_begin(&crossings, around);
  int passes = surface_passes(&g->tree, &g->surfaces, &g->materials, &hit);
  uint near = CAPLET_ALONE, left = CAPLET_NONE;
  while (crossings_next(&g->tree, &crossings)) {
    const HitRecord other = crossings.hits[crossings.at - 1u];
    const uint boundary = boundary_of(&g->tree, &g->surfaces, &g->media, &other);
    if (boundary != CAPLET_NONE &&
        boundary_is_left(&g->tree, &g->surfaces, &g->media, boundary, &other))
      left = min(left, boundary);
    if (other.slot == hit.slot && other.instance == hit.instance && other.t == hit.t &&
        other.surface == hit.surface)
      continue;
    if (boundary != CAPLET_NONE) near = CAPLET_NEAR;
    if (!passes || other.t != hit.t) continue;
    // The nearest hit may hide, at the same t, a surface that stops light.
    const uint geometry = geometry_at(&g->tree, &g->surfaces, other.slot);
    passes = g->surfaces.geometries[geometry].alpha != CAPLET_NONE ||
             surface_passes(&g->tree, &g->surfaces, &g->materials, &other);
    if (passes) continue;
    g->rays.path_hit[path] = other;
    near = CAPLET_NEAR;
  }
  if (near == CAPLET_NEAR)
    g->medium_stacks.path_near[path] = left == CAPLET_NONE ? CAPLET_NEAR : CAPLET_NEAR_LEFT + left;
}
