// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Shadow rays: what reaches the light adds its radiance.
#include "globals.cl"
#include "trace/trace.cl"

#define STAGE_NAME connect
static void stage_item(const Globals* g, uint item) {
  const uint path = g->queue_shadow[item];
  if (trace_any(g->nodes, g->leaves, g->instances, g->params->root, g->path_shadow[path])) return;
  vstore4(vload4(path, g->path_radiance) + vload4(path, g->path_shadow_radiance), path, g->path_radiance);
}
#include "stages/kernel.cl"
