// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Shadow rays: what reaches the light adds its radiance.
#include "trace/trace.cl"

static void stage_item(const Stage* g, uint item) {
  const uint path = g->shadows.queue_shadow[item];
  if (trace_any(&g->tree, g->shadows.path_shadow[path])) return;
  g->radiance.path_radiance[path] += g->shadows.path_shadow_radiance[path];
}
