// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds every crossing of every ray of a query.
#include "stages/times.cl"
#include "trace/list.cl"

static void stage_item(const Stage* g, uint item) {
  SEE_AT(QUERY_TIME(g, item));
  const uint capacity = g->query.query->capacity;
  g->crossings.query_counts[item] = trace_all(&g->tree, g->query.query_rays[item], capacity,
                                              g->crossings.query_hits + (size_t)item * capacity);
}
