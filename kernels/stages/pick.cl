// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds the nearest crossing of every ray of a query.
#include "stages/pick_record.cl"
#include "stages/times.cl"

static __global const RayRecord* traced_ray_at(const Stage* g, uint item) {
  return g->query.query_rays + item;
}
static void traced_hit(const Stage* g, uint item, const HitRecord* hit) {
  SEE_AT(QUERY_TIME(g, item));
  const RayRecord ray = g->query.query_rays[item];
  g->picks.picks[item] = pick_record(&g->tree, &g->surfaces, &ray, hit);
}
#define TRACED_TREE(g) (&(g)->tree)
#define TRACED_ROOT(g, item) world_root_at(&(g)->tree, TRACED_TIME(g, item))
#define TRACED_TIME(g, item) QUERY_TIME(g, item)
#include "trace/many.cl"
