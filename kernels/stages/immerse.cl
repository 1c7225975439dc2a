// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What holds the camera: the solids that a ray from there leaves more often than it enters them. Of the first path, or of each where their rays begin
// at different points.
#include "media/immersion.cl"
#include "trace/trace.cl"

#define CAPLET_HELD_COUNTED 16  // boundaries that are counted at a time

static void stage_item(const Stage* g, uint item) {
  const RayRecord from = g->rays.path_ray[item];
  RayRecord ray;
  ray.ox = from.ox; ray.oy = from.oy; ray.oz = from.oz; ray.t_min = 0.0f;
  ray.dx = 0.371391f; ray.dy = 0.557086f; ray.dz = 0.742781f; ray.t_max = INFINITY;  // any direction that scenes do not prefer
  uint boundary[CAPLET_HELD_COUNTED];
  int count[CAPLET_HELD_COUNTED];
  for (int i = 0; i < CAPLET_HELD_COUNTED; ++i) count[i] = 0;
  for (;;) {
    const HitRecord hit = trace_closest(&g->tree, ray);
    if (hit.slot == CAPLET_NONE) break;
    ray.t_min = hit.t;
    const uint met = boundary_of(&g->tree, &g->surfaces, &g->media, &hit);
    if (met == CAPLET_NONE || (g->media.boundaries[met].flags & CAPLET_BOUNDARY_CLOSED) == 0) continue;
    int place = -1, empty = -1;
    for (int i = 0; i < CAPLET_HELD_COUNTED; ++i) {
      if (count[i] != 0 && boundary[i] == met) place = i;
      if (count[i] == 0) empty = i;
    }
    if (place < 0) place = empty;
    if (place < 0) continue;
    boundary[place] = met;
    count[place] += boundary_is_left(&g->tree, &g->surfaces, &g->media, met, &hit) ? 1 : -1;
  }
  Held held = {(uint4)(0u), g->camera.camera->medium};
  for (int i = 0; i < CAPLET_HELD_COUNTED; ++i)
    for (int k = 0; k < count[i]; ++k) held_enter(&held, boundary[i]);
  g->immersion.path_inside[item] = held.inside;
  g->immersion.path_around[item] = held.around;
}
