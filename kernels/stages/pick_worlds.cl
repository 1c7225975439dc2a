// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds the nearest crossing of every ray of a query in the ray's own world. Worlds place the same
// instances, each by a tree of its own. Rays are neighbours: those of a picture, by rows.
#include "stages/pick_record.cl"

static __global const RayRecord* traced_ray_at(const Stage* g, uint item) {
  return g->query.query_rays + item;
}
static void traced_hit(const Stage* g, uint item, const HitRecord* hit) {
  const RayRecord ray = g->query.query_rays[item];
  g->picks.picks[item] = g->query.query->points ? pick_record(&g->tree, &g->surfaces, &ray, hit)
                                                : pick_identity(&g->tree, &g->surfaces, hit);
}
#define TRACED_TREE(g) (&(g)->tree)
#define TRACED_ROOT(g, item) ((g)->worlds.world_roots[(item) / (g)->query.query->world_rays])
#define TRACED_UNTIL(g, item) \
  (((item) / (g)->query.query->world_rays + 1u) * (g)->query.query->world_rays)
#define TRACED_NEIGHBOURS 1
#include "trace/many.cl"
