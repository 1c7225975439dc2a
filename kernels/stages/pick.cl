// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The nearest crossing of every ray of a query.
#include "globals.cl"
#include "stages/pick_record.cl"
#include "trace/trace.cl"

#define STAGE_NAME pick
static void stage_item(const Globals* g, uint item) {
  const RayRecord ray = g->query_rays[item];
  const HitRecord hit = trace_closest(g->nodes, g->leaves, g->instances, g->params->root, ray);
  g->picks[item] = pick_record(g, &ray, &hit);
}
#include "stages/kernel.cl"
