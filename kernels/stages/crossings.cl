// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Lists the crossings of a ray one after the other, including those at the same t, and finds which
// solids contain it from those that are still to come.
#ifndef CAPLET_STAGES_CROSSINGS_CL
#define CAPLET_STAGES_CROSSINGS_CL

#define CAPLET_LIST_SPACE __private
#include "media/medium_stack.cl"
#include "trace/list.cl"

#define CAPLET_CROSSINGS \
  16  // that are found at a time; of more at the same t the rest are not told

// RayCrossings holds the crossings of `ray` that are found but not yet returned, and the number of
// the next one.
typedef struct {
  RayRecord ray;
  uint at, count;
  int more;
  HitRecord hits[CAPLET_CROSSINGS];
} RayCrossings;

static inline void crossings_begin(RayCrossings* c, RayRecord ray) {
  c->ray = ray;
  c->at = c->count = 0u;
  c->more = 1;
}

// Moves to the next crossing, which is then hits[at - 1]. Returns 0 if there is none.
static inline int crossings_next(const Tree* tree, RayCrossings* c) {
  if (c->at == c->count) {
    if (!c->more) return 0;
    const uint found = trace_all(tree, c->ray, CAPLET_CROSSINGS, c->hits);
    c->more = found > CAPLET_CROSSINGS;
    c->at = 0u;
    c->count = min(found, (uint)CAPLET_CROSSINGS);
    if (c->count == 0u) return 0;
    if (c->more) {
      // Crossings at the same t as the last one are kept for the next round, so that they come
      // together.
      const float last = c->hits[CAPLET_CROSSINGS - 1].t;
      while (c->count > 0u && c->hits[c->count - 1u].t == last) c->count -= 1u;
      if (c->count == 0u) c->count = CAPLET_CROSSINGS;
      c->ray.t_min = c->hits[c->count - 1u].t;
    }
  }
  c->at += 1u;
  return 1;
}

// Returns how far apart two crossings at about t can be if their surfaces are at one place:
// rounding may move either by this much.
static inline float crossings_apart(const RayRecord* ray, float t) {
  const float3 o = (float3)(ray->ox, ray->oy, ray->oz), d = (float3)(ray->dx, ray->dy, ray->dz);
  return 0x1p-17f * (max3(fabs(o)) + t * max3(fabs(d))) / length(d);
}

// Returns whether the last crossing is a repetition: where the ray meets an edge or corner of a
// mesh there is a crossing for each face.
static inline int crossing_repeats(const Tree* tree, const Surfaces* surfaces, const Media* media,
                                   const RayCrossings* c) {
  const HitRecord hit = c->hits[c->at - 1u];
  const uint geometry = geometry_at(tree, surfaces, hit.slot);
  if ((media->boundaries[media->geometry_boundary[geometry]].flags & CAPLET_BOUNDARY_SHEET) == 0)
    return 0;
  const float first = hit.t - crossings_apart(&c->ray, hit.t);
  for (uint i = c->at - 1u; i > 0u && c->hits[i - 1u].t >= first; --i) {
    const HitRecord before = c->hits[i - 1u];
    if (before.instance == hit.instance &&
        ((before.surface ^ hit.surface) & CAPLET_LEAVING) == 0u &&
        geometry_at(tree, surfaces, before.slot) == geometry)
      return 1;
  }
  return 0;
}

#define CAPLET_COUNTED_BOUNDARIES 16  // boundaries that are counted at a time

// Finds the boundaries that contain a ray behind its t_min: the closed solids that it leaves more
// often than it enters them, and from `before` those that are told by normals alone.
static inline MediumStack medium_stack_counted(const Tree* tree, const Surfaces* surfaces,
                                               const Media* media, RayRecord ray,
                                               MediumStack before) {
  uint boundary[CAPLET_COUNTED_BOUNDARIES];
  int count[CAPLET_COUNTED_BOUNDARIES];
  for (int i = 0; i < CAPLET_COUNTED_BOUNDARIES; ++i) count[i] = 0;
  RayCrossings crossings;
  ray.t_max = INFINITY;
  crossings_begin(&crossings, ray);
  while (crossings_next(tree, &crossings)) {
    const HitRecord hit = crossings.hits[crossings.at - 1u];
    const uint met = boundary_of(tree, surfaces, media, &hit);
    if (met == CAPLET_NONE || (media->boundaries[met].flags & CAPLET_BOUNDARY_CLOSED) == 0)
      continue;
    if (crossing_repeats(tree, surfaces, media, &crossings)) continue;
    int place = -1, empty = -1;
    for (int i = 0; i < CAPLET_COUNTED_BOUNDARIES; ++i) {
      if (count[i] != 0 && boundary[i] == met) place = i;
      if (count[i] == 0) empty = i;
    }
    if (place < 0) place = empty;
    if (place < 0) continue;
    boundary[place] = met;
    count[place] += boundary_is_left(tree, surfaces, media, met, &hit) ? 1 : -1;
  }
  MediumStack stack = {(uint4)(0u), before.around};
  for (int i = 0; i < CAPLET_COUNTED_BOUNDARIES; ++i)
    for (int k = 0; k < count[i]; ++k) medium_stack_enter(&stack, boundary[i]);
  uint all[CAPLET_MEDIUM_STACK_SIZE];
  vstore4(before.inside, 0, all);
  for (int i = 0; i < CAPLET_MEDIUM_STACK_SIZE; ++i)
    if (all[i] != 0u && (media->boundaries[(all[i] >> 8) - 1u].flags & CAPLET_BOUNDARY_CLOSED) == 0)
      for (uint k = 0; k < (all[i] & 255u); ++k) medium_stack_enter(&stack, (all[i] >> 8) - 1u);
  return stack;
}

#endif
