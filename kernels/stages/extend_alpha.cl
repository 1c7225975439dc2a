// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds the closest hit of every ray in the queue, where shapes let some of them through.
#include "stages/times.cl"
#include "trace/alpha.cl"

static void stage_item(const Stage* g, uint item) {
  const uint path = g->queues.queue[item];
  SEE_AT(PATH_TIME(g, path));
  const AlphaScene scene = {g->tree, g->surfaces, g->spectra, g->materials};
  g->rays.path_hit[path] = trace_stopped(&scene, g->rays.path_ray[path]);
}
