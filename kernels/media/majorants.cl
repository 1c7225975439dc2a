// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Walks a ray through the cells of a medium that varies (Amanatides and Woo, "A fast voxel
// traversal algorithm for ray tracing", 1987): one stretch of the ray after the other, with a
// majorant of the extinction along it.
#ifndef CAPLET_MEDIA_MAJORANTS_CL
#define CAPLET_MEDIA_MAJORANTS_CL

#include "media/media_types.cl"

typedef struct {
  float t, end;       // where the next stretch begins, and the last ends
  float3 next, step;  // t of the next plane across each axis, and from one to the next
  int3 cell, ahead;   // ahead: 1 or -1
  Floats majorants;
  int size;
} MajorantWalk;

static inline float walk_least(float3 v) { return fmin(v.x, fmin(v.y, v.z)); }

// Finds the part of the ray o + t d, t0 <= t <= t1 (t1 may be infinite), that is in the box.
// Returns 0 if there is none.
static inline int majorants_begin(const MediumBox* box, float3 world_o, float3 world_d, float t0,
                                  float t1, MajorantWalk* w) {
  const float3 o = transform_point(box->place, world_o), d = transform_vector(box->place, world_d);
  const float largest = max3(fabs(d));
  if (!(largest > 0.0f)) return 0;
  // A vanishing component becomes 2^-40 of the largest: its planes are not met within the box.
  const float least = largest * 0x1p-40f;
  const float3 s =
      (float3)(copysign(fmax(fabs(d.x), least), d.x), copysign(fmax(fabs(d.y), least), d.y),
               copysign(fmax(fabs(d.z), least), d.z));
  const float3 low = -o / s, high = (1.0f - o) / s;
  const float3 near = fmin(low, high), far = fmax(low, high);
  w->t = fmax(max3(near), t0);
  w->end = fmin(walk_least(far), t1);
  if (!(w->t < w->end)) return 0;
  const float size = (float)box->size;
  const float3 at = clamp((o + w->t * d) * size, 0.0f, size - 0.5f);
  w->cell = (int3)((int)at.x, (int)at.y, (int)at.z);
  w->ahead = (int3)(s.x < 0.0f ? -1 : 1, s.y < 0.0f ? -1 : 1, s.z < 0.0f ? -1 : 1);
  w->step = fabs(1.0f / (s * size));
  const float3 plane =
      (float3)((float)(w->cell.x + (s.x < 0.0f ? 0 : 1)), (float)(w->cell.y + (s.y < 0.0f ? 0 : 1)),
               (float)(w->cell.z + (s.z < 0.0f ? 0 : 1))) /
      size;
  w->next = (plane - o) / s;
  w->majorants = box->majorants;
  w->size = box->size;
  return 1;
}

// Returns the next stretch, from *t0 to *t1, with the cell's number. Returns 0 if there is none.
static inline int majorants_next(MajorantWalk* w, float* t0, float* t1, float* majorant) {
  if (!(w->t < w->end)) return 0;
  const int size = w->size;
  if (w->cell.x < 0 || w->cell.x >= size || w->cell.y < 0 || w->cell.y >= size || w->cell.z < 0 ||
      w->cell.z >= size) {
    // Rounding took the point out of the box just before its end: the stretch counts as in its last
    // cell.
    w->cell = clamp(w->cell, 0, size - 1);
    w->next = (float3)(INFINITY);
  }
  *majorant = *floats_at(w->majorants, (size_t)((w->cell.z * size + w->cell.y) * size + w->cell.x));
  *t0 = w->t;
  const float leave = walk_least(w->next);
  *t1 = fmax(fmin(leave, w->end), w->t);
  w->t = *t1;
  if (leave < w->end) {
    if (w->next.x == leave) {
      w->cell.x += w->ahead.x;
      w->next.x += w->step.x;
    } else if (w->next.y == leave) {
      w->cell.y += w->ahead.y;
      w->next.y += w->step.y;
    } else {
      w->cell.z += w->ahead.z;
      w->next.z += w->step.z;
    }
  }
  return 1;
}

#endif
