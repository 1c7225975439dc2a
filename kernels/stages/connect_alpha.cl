// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Shadow rays, where shapes let some of them through.
#include "trace/alpha.cl"

static void stage_item(const Stage* g, uint item) {
  const AlphaScene scene = {g->tree, g->surfaces, g->spectra, g->materials};
  const uint path = g->shadows.queue_shadow[item];
  if (trace_stopped(&scene, g->shadows.path_shadow[path]).slot == CAPLET_NONE)
    g->radiance.path_radiance[path] += g->shadows.path_shadow_radiance[path];
}
