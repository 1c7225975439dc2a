// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Turns the lists of pick_all into records one after the other.
#include "stages/pick_record.cl"
#include "stages/times.cl"

static void stage_item(const Stage* g, uint item) {
  SEE_AT(QUERY_TIME(g, item));
  const uint capacity = g->query.query->capacity;
  const uint count = min(g->crossings.query_counts[item], capacity),
             begin = g->crossings.query_begin[item];
  const RayRecord ray = g->query.query_rays[item];
  for (uint i = 0; i < count; ++i) {
    const HitRecord hit = g->crossings.query_hits[(size_t)item * capacity + i];
    g->picks.picks[begin + i] = pick_record(&g->tree, &g->surfaces, &ray, &hit);
  }
}
