// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The nearest crossing of every ray of a query.
#include "stages/pick_record.cl"
#include "trace/trace.cl"

static void stage_item(const Stage* g, uint item) {
  const RayRecord ray = g->query.query_rays[item];
  const HitRecord hit = trace_closest(&g->tree, ray);
  g->picks.picks[item] = pick_record(&g->tree, &g->surfaces, &ray, &hit);
}
