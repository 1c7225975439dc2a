// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file finds the medium at a point of a ray: that within the boundary of the highest number of
// those whose solids hold the point. A boundary counts once for each such solid (docs/media.md). A
// ray carries the boundaries that it is within, at most CAPLET_MEDIUM_STACK_SIZE of them; of more,
// the lowest numbers are forgotten.
#ifndef CAPLET_MEDIA_MEDIUM_STACK_CL
#define CAPLET_MEDIA_MEDIUM_STACK_CL

#include "groups.cl"
#include "slots.cl"

// MediumStack is the state of a ray. inside: for each boundary its number + 1 above a count in bits
// 0..7, 0 where there is none. around: the medium where no solid is.
typedef struct {
  uint4 inside;
  uint around;
} MediumStack;

static inline uint medium_stack_top(const MediumStack* stack) {
  return max(max(stack->inside.x, stack->inside.y), max(stack->inside.z, stack->inside.w));
}

static inline uint medium_stack_medium(const Media* media, const MediumStack* stack) {
  const uint highest = medium_stack_top(stack);
  return highest == 0u ? stack->around : media->boundaries[(highest >> 8) - 1u].inside;
}

static inline int medium_stack_contains(const MediumStack* stack, uint boundary) {
  const uint key = boundary + 1u;
  return (stack->inside.x >> 8) == key || (stack->inside.y >> 8) == key ||
         (stack->inside.z >> 8) == key || (stack->inside.w >> 8) == key;
}

static inline void medium_stack_enter(MediumStack* stack, uint boundary) {
  const uint key = boundary + 1u;
  uint all[CAPLET_MEDIUM_STACK_SIZE];
  vstore4(stack->inside, 0, all);
  int place = 0;
  for (int i = 0; i < CAPLET_MEDIUM_STACK_SIZE; ++i) {
    if ((all[i] >> 8) == key) {
      if ((all[i] & 255u) < 255u) all[i] += 1u;
      stack->inside = vload4(0, all);
      return;
    }
    if (all[i] < all[place]) place = i;
  }
  const uint entry = key << 8 | 1u;
  if (all[place] < entry) all[place] = entry;
  stack->inside = vload4(0, all);
}

static inline void medium_stack_leave(const Media* media, MediumStack* stack, uint boundary) {
  const uint key = boundary + 1u;
  uint all[CAPLET_MEDIUM_STACK_SIZE];
  vstore4(stack->inside, 0, all);
  for (int i = 0; i < CAPLET_MEDIUM_STACK_SIZE; ++i)
    if ((all[i] >> 8) == key) all[i] = (all[i] & 255u) > 1u ? all[i] - 1u : 0u;
  stack->inside = vload4(0, all);
  if (medium_stack_top(stack) == 0u) stack->around = media->boundaries[boundary].outside;
}

// Returns the boundary of a hit, or CAPLET_NONE.
static inline uint boundary_of(const Tree* tree, const Surfaces* surfaces, const Media* media,
                               const HitRecord* hit) {
  return media->geometry_boundary[geometry_at(tree, surfaces, hit->slot)];
}

// Returns 1 if a ray that goes through the surface of a hit leaves the boundary.
static inline int boundary_is_left(const Tree* tree, const Surfaces* surfaces, const Media* media,
                                   uint boundary, const HitRecord* hit) {
  const int leaving = (hit->surface & CAPLET_LEAVING) != 0;
  if (!(media->boundaries[boundary].flags & CAPLET_BOUNDARY_SHEET)) return leaving;
  const uint flags = surfaces->geometries[geometry_at(tree, surfaces, hit->slot)].flags;
  return leaving != ((flags & CAPLET_GEOMETRY_FLIP_NORMAL) != 0);
}

// Updates the boundaries of a ray that went through the surface of a hit.
static inline void medium_stack_cross(const Tree* tree, const Surfaces* surfaces,
                                      const Media* media, const HitRecord* hit,
                                      MediumStack* stack) {
  const uint boundary = boundary_of(tree, surfaces, media, hit);
  if (boundary == CAPLET_NONE) return;
  if (boundary_is_left(tree, surfaces, media, boundary, hit))
    medium_stack_leave(media, stack, boundary);
  else
    medium_stack_enter(stack, boundary);
}

// Returns the boundaries of a ray on its way to a hit. A ray meets only one of the solids that
// touch at a point; when it leaves the other one, that shows that it was inside. endless: the ray
// goes on for ever where it hits nothing.
static inline MediumStack medium_stack_before(const Tree* tree, const Surfaces* surfaces,
                                              const Media* media, const HitRecord* hit, int endless,
                                              MediumStack stack) {
  if (hit->slot == CAPLET_NONE && !endless) return stack;
  if (hit->slot == CAPLET_NONE) {
    // No closed solid contains a ray that goes on for ever: the surfaces by which it left were met
    // together with others.
    uint all[CAPLET_MEDIUM_STACK_SIZE];
    vstore4(stack.inside, 0, all);
    for (int i = 0; i < CAPLET_MEDIUM_STACK_SIZE; ++i)
      if (all[i] != 0u &&
          (media->boundaries[(all[i] >> 8) - 1u].flags & CAPLET_BOUNDARY_CLOSED) != 0) {
        all[i] = 1u | (all[i] & ~255u);
        stack.inside = vload4(0, all);
        medium_stack_leave(media, &stack, (all[i] >> 8) - 1u);
        vstore4(stack.inside, 0, all);
      }
    return stack;
  }
  const uint boundary = boundary_of(tree, surfaces, media, hit);
  if (boundary == CAPLET_NONE || (media->boundaries[boundary].flags & CAPLET_BOUNDARY_CLOSED) == 0)
    return stack;
  if (!medium_stack_contains(&stack, boundary) &&
      boundary_is_left(tree, surfaces, media, boundary, hit))
    medium_stack_enter(&stack, boundary);
  return stack;
}

#endif
