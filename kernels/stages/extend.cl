// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Closest hit of every ray in the queue.
#include "globals.cl"
#include "trace/trace.cl"

#define STAGE_NAME extend
static void stage_item(const Globals* g, uint item) {
  const uint path = g->queue[item];
  g->path_hit[path] = trace_closest(g->nodes, g->leaves, g->instances, g->params->root, g->path_ray[path]);
}
#include "stages/kernel.cl"
