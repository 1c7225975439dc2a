// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The lists that pick_all leaves, as records one after the other.
#include "globals.cl"
#include "stages/pick_record.cl"

#define STAGE_NAME pick_list
static void stage_item(const Globals* g, uint item) {
  const uint capacity = g->params->query_capacity;
  const uint count = min(g->query_counts[item], capacity), begin = g->query_begin[item];
  const RayRecord ray = g->query_rays[item];
  for (uint i = 0; i < count; ++i) {
    const HitRecord hit = g->query_hits[(size_t)item * capacity + i];
    g->picks[begin + i] = pick_record(g, &ray, &hit);
  }
}
#include "stages/kernel.cl"
