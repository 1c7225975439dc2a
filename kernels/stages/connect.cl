// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Traces shadow rays: a light sample that is not occluded adds its radiance.
#include "stages/times.cl"
#include "trace/shadow.cl"

static __global const RayRecord* traced_ray_at(const Stage* g, uint item) {
  return g->shadows.path_shadow + g->shadows.queue_shadow[item];
}
static void traced_hit(const Stage* g, uint item, const HitRecord* hit) {
  const uint path = g->shadows.queue_shadow[item];
  if (shadow_is_free(&g->tree, hit, g->shadows.path_shadow_target[path]))
    g->radiance.path_radiance[path] += g->shadows.path_shadow_radiance[path];
}
#define TRACED_TREE(g) (&(g)->tree)
#define TRACED_ROOT(g, item) world_root_at(&(g)->tree, TRACED_TIME(g, item))
#define TRACED_ENOUGH(g, item) \
  ((g)->shadows.path_shadow_target[(g)->shadows.queue_shadow[item]].enough)
#define TRACED_TIME(g, item) PATH_TIME(g, (g)->shadows.queue_shadow[item])
#include "trace/many.cl"
