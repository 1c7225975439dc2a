// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Traces shadow rays among media and adds the light that is left when they reach it.
#include "stages/crossings.cl"
#include "media/passing.cl"
#include "media/sample_distance.cl"
#include "stages/path.cl"
#include "stages/times.cl"
#include "trace/alpha.cl"
#include "trace/shadow.cl"

static void stage_item(const Stage* g, uint item) {
  const uint path = g->shadows.queue_shadow[item];
  SEE_AT(PATH_TIME(g, path));
  const AlphaScene scene = {g->tree, g->surfaces, g->spectra, g->materials};
  RayRecord ray = g->shadows.path_shadow[path];
  MediumStack stack = {g->medium_stacks.shadow_inside[path], g->medium_stacks.shadow_around[path]};
  const ShadowTarget target = g->shadows.path_shadow_target[path];
  const PathSample at = path_sample(g->batch.batch, g->view.view, path);
  MediumNumbers numbers = {
      hash_combine(path_hash(at, g->carried.path_flags[path]), HASHED_SAMPLE(shadow)), 0u};
  MediumWeights weights;
  weights.throughput = g->shadows.path_shadow_radiance[path];
  weights.scattering = weights.light = g->medium_stacks.path_ratio[path];
  weights.most = max4(fabs(weights.throughput));
  if (g->medium_stacks.shadow_near[path] == CAPLET_RECOUNT)
    stack = medium_stack_counted(&g->tree, &g->surfaces, &g->media, ray, stack);
  RayCrossings crossings;
  crossings_begin(&crossings, ray);
  HitRecord hit = {ray.t_min, CAPLET_NONE, CAPLET_NONE, 0u};
  uint left = CAPLET_NONE;  // the largest of what was left at one place
  float left_at = -INFINITY;
  for (;;) {
    const float from = hit.t;
    const int met = crossings_next(&g->tree, &crossings);
    if (met)
      hit = crossings.hits[crossings.at - 1u];
    else
      hit.slot = CAPLET_NONE;
    const int ends = shadow_is_free(&g->tree, &hit, target);
    const int crosses = !ends && alpha_stops(&scene, &ray, &hit);
    if (crosses && !surface_passes(&g->tree, &g->surfaces, &g->materials, &hit)) return;
    stack = medium_stack_before(&g->tree, &g->surfaces, &g->media, &hit, isinf(ray.t_max), stack);
    const uint medium = medium_stack_medium(&g->media, &stack);
    const float to = met ? hit.t : ray.t_max;
    if (medium != CAPLET_NONE && from < to) {
      const MediumSegment segment = medium_segment(
          &g->media, &g->spectra, medium, g->carried.path_wavelengths[path], &ray, from, to);
      if (!medium_transmittance(&segment, &numbers, &weights)) return;
    }
    if (ends) break;
    const uint boundary =
        crosses ? boundary_of(&g->tree, &g->surfaces, &g->media, &hit) : CAPLET_NONE;
    if (boundary == CAPLET_NONE || crossing_repeats(&g->tree, &g->surfaces, &g->media, &crossings))
      continue;
    medium_stack_cross(&g->tree, &g->surfaces, &g->media, &hit, &stack);
    if (!boundary_is_left(&g->tree, &g->surfaces, &g->media, boundary, &hit)) continue;
    left = hit.t - left_at <= crossings_apart(&ray, hit.t) ? min(left, boundary) : boundary;
    left_at = hit.t;
    stack.around = g->media.boundaries[left].outside;
  }
  const float light = mean4(weights.light), scattering = mean4(weights.scattering);
  if (!(light > 0.0f)) return;
  const float2 pdfs = g->medium_stacks.shadow_pdfs[path];
  const float weight = pdfs.y > 0.0f ? power_heuristic(pdfs.x * light, pdfs.y * scattering) : 1.0f;
  g->radiance.path_radiance[path] += weights.throughput * (weight / light);
}
