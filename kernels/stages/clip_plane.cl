// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Cuts away what lies beyond the clipping plane of ViewRecord: rays end at the plane, and camera
// rays that begin beyond it see nothing before it. A solid is closed where it is cut
// (stages/clip.cl finds where), by a face in the plane.
#ifndef CAPLET_STAGES_CLIP_PLANE_CL
#define CAPLET_STAGES_CLIP_PLANE_CL

#include "groups.cl"

// has_clip says whether views may have a clipping plane.
#ifdef CAPLET_CLIP
enum { has_clip = 1 };
#else
enum { has_clip = 0 };
#endif

static inline float3 clip_normal(__global const ViewRecord* view) {
  return (float3)(view->clip_x, view->clip_y, view->clip_z);
}

// Returns how far a point lies beyond the plane.
static inline float clip_height(__global const ViewRecord* view, float3 p) {
  return dot(clip_normal(view), p) - view->clip_offset;
}

// Ends a ray where it goes beyond the plane. One that begins beyond it and comes back begins at the
// plane; *comes_in is then 1.
static inline void clip_ray(__global const ViewRecord* view, RayRecord* ray, int* comes_in) {
  const float height = clip_height(view, (float3)(ray->ox, ray->oy, ray->oz)),
              rate = dot(clip_normal(view), (float3)(ray->dx, ray->dy, ray->dz));
  *comes_in = height > 0.0f && rate < 0.0f;
  if (*comes_in)
    ray->t_min = fmax(ray->t_min, height / -rate);
  else if (height > 0.0f)
    ray->t_max = 0.0f;
  else if (rate > 0.0f)
    ray->t_max = fmin(ray->t_max, -height / rate);
}

// Ends a ray that begins at a surface or in a medium, which rounding may have put beyond the plane.
static inline void clip_onward(__global const ViewRecord* view, RayRecord* ray) {
  const float t_min = ray->t_min;
  int comes_in;
  clip_ray(view, ray, &comes_in);
  ray->t_min = t_min;
}

#endif
