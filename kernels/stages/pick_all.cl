// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Every crossing of every ray of a query.
#include "globals.cl"
#include "trace/list.cl"

#define STAGE_NAME pick_all
static void stage_item(const Globals* g, uint item) {
  const uint capacity = g->params->query_capacity;
  g->query_counts[item] = trace_all(g->nodes, g->leaves, g->instances, g->params->root, g->query_rays[item], capacity,
                                    g->query_hits + (size_t)item * capacity);
}
#include "stages/kernel.cl"
