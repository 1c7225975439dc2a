// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds where rays meet the face that closes a solid in the clipping plane: camera rays that begin
// at the plane, and rays within a solid that end at it.
#include "media/passing.cl"
#include "stages/clip_face.cl"
#include "stages/crossings.cl"
#include "stages/path.cl"
#include "stages/times.cl"

#define CAPLET_CLIP_SOLIDS 16  // solids that are told apart on one ray

// ClipSolid is a solid that a ray meets: a primitive, or all sheets of a mesh.
typedef struct {
  uint2 key;
  HitRecord first, last;
  int is_odd;  // the ray crosses its sheets an odd number of times
} ClipSolid;

static inline uint clip_geometry(const Tree* tree, const Surfaces* surfaces, const HitRecord* hit) {
  return geometry_at(tree, surfaces, hit->slot);
}

// Returns whether a crossing is one with the same edge or corner of a mesh as the one before.
static inline int clip_repeats(const RayRecord* ray, const HitRecord* hit, const HitRecord* last) {
  return ((hit->surface ^ last->surface) & CAPLET_LEAVING) == 0u &&
         hit->t - last->t <= crossings_apart(ray, hit->t);
}

// Finds a solid that holds the point of the ray at its t_min: one that the ray leaves before it
// enters it, or whose sheets it crosses an odd number of times; of several the one that it leaves
// first. *holder becomes the crossing there. Returns 0 if there is none.
static inline int clip_holder(const Tree* tree, const Surfaces* surfaces,
                              const Materials* materials, RayRecord ray, HitRecord* holder) {
  ClipSolid solids[CAPLET_CLIP_SOLIDS];
  uint count = 0u, sheets = 0u;
  RayCrossings crossings;
  crossings_begin(&crossings, ray);
  while (crossings_next(tree, &crossings)) {
    const HitRecord hit = crossings.hits[crossings.at - 1u];
    const uint index = clip_geometry(tree, surfaces, &hit);
    __global const GeometryRecord* geometry = surfaces->geometries + index;
    if ((geometry->flags & CAPLET_GEOMETRY_OPEN) != 0u || geometry->alpha != CAPLET_NONE ||
        surface_passes(tree, surfaces, materials, &hit))
      continue;
    const int is_primitive = clip_is_primitive(geometry->shape);
    const uint2 key = (uint2)(is_primitive ? hit.slot : index | 0x80000000u, hit.instance);
    uint i = 0u;
    while (i < count && (solids[i].key.x != key.x || solids[i].key.y != key.y)) ++i;
    if (i == count) {
      if (is_primitive && (hit.surface & CAPLET_LEAVING) != 0u && sheets == 0u) {
        *holder = hit;
        return 1;
      }
      if (count == CAPLET_CLIP_SOLIDS) continue;
      count += 1u;
      solids[i].key = key;
      solids[i].first = solids[i].last = hit;
      solids[i].is_odd = !is_primitive || (hit.surface & CAPLET_LEAVING) != 0u;
      sheets += is_primitive ? 0u : 1u;
    } else if (!is_primitive) {
      if (!clip_repeats(&ray, &hit, &solids[i].last)) solids[i].is_odd = !solids[i].is_odd;
      solids[i].last = hit;
    }
  }
  for (uint i = 0u; i < count; ++i)
    if (solids[i].is_odd) {
      *holder = solids[i].first;
      return 1;
    }
  return 0;
}

// Returns the hit with the face, at `t`, of the solid that is left at the crossing `hit`.
static inline HitRecord clip_hit(const Tree* tree, const Surfaces* surfaces, HitRecord hit, float t,
                                 int goes_out) {
  __global const GeometryRecord* geometry =
      surfaces->geometries + clip_geometry(tree, surfaces, &hit);
  const int is_flipped = (geometry->flags & CAPLET_GEOMETRY_FLIP_NORMAL) != 0u;
  const int is_primitive = clip_is_primitive(geometry->shape);
  // Normals that are stored of sheets point outward where this crossing is along them.
  const int is_outward = is_primitive || (hit.surface & CAPLET_LEAVING) != 0u;
  const uint leaving = (goes_out == is_outward) ? CAPLET_LEAVING : 0u;
  hit.t = t;
  hit.surface = (hit.surface & CAPLET_SURFACE_MASK) | leaving | CAPLET_CLIPPED |
                (is_outward == is_flipped ? CAPLET_CLIPPED_REVERSED : 0u);
  return hit;
}

static void stage_item(const Stage* g, uint item) {
  const uint path = g->queues.queue[item];
  SEE_AT(PATH_TIME(g, path));
  const uint flags = g->carried.path_flags[path];
  RayRecord ray = g->rays.path_ray[path];
  const int comes_in = (flags & PATH_FROM_PLANE) != 0u && ray.t_min < INFINITY;
  const int goes_out = (flags & (PATH_INSIDE | PATH_CROSSED)) != 0u && ray.t_max < INFINITY &&
                       g->rays.path_hit[path].slot == CAPLET_NONE;
  if (!comes_in && !goes_out) return;
  const float t = comes_in ? ray.t_min : ray.t_max;
  ray.t_min = t;
  ray.t_max = INFINITY;
  HitRecord hit;
  if (!clip_holder(&g->tree, &g->surfaces, &g->materials, ray, &hit)) return;
  hit = clip_hit(&g->tree, &g->surfaces, hit, t, !comes_in);
  g->rays.path_hit[path] = hit;
  if (goes_out) g->carried.path_flags[path] = flags | PATH_INSIDE;
#ifdef CLIP_IN_MEDIA
  // The solid's medium begins behind the face.
  if (comes_in) {
    const uint boundary = boundary_of(&g->tree, &g->surfaces, &g->media, &hit);
    if (boundary == CAPLET_NONE) return;
    MediumStack stack = {g->medium_stacks.path_inside[path], g->medium_stacks.path_around[path]};
    medium_stack_leave(&g->media, &stack, boundary);
    g->medium_stacks.path_inside[path] = stack.inside;
    g->medium_stacks.path_around[path] = stack.around;
  }
#endif
}
