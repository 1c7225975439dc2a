// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Traces shadow rays where shapes let some of them through. A light sample's radiance already
// includes the probability that its own point stops a ray.
#include "stages/times.cl"
#include "trace/alpha.cl"
#include "trace/shadow.cl"

static void stage_item(const Stage* g, uint item) {
  const uint path = g->shadows.queue_shadow[item];
  SEE_AT(PATH_TIME(g, path));
  const AlphaScene scene = {g->tree, g->surfaces, g->spectra, g->materials};
  const ShadowTarget target = g->shadows.path_shadow_target[path];
  RayRecord ray = g->shadows.path_shadow[path];
  for (;;) {
    const HitRecord hit = trace_closest(&scene.tree, ray);
    if (shadow_is_free(&scene.tree, &hit, target)) break;
    if (alpha_stops(&scene, &ray, &hit)) return;
    ray.t_min = hit.t;
  }
  g->radiance.path_radiance[path] += g->shadows.path_shadow_radiance[path];
}
