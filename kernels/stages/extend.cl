// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Closest hit of every ray in the queue.
#include "trace/trace.cl"

static void stage_item(const Stage* g, uint item) {
  const uint path = g->queues.queue[item];
  g->rays.path_hit[path] = trace_closest(&g->tree, g->rays.path_ray[path]);
}
