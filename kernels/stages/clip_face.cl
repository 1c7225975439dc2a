// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The faces in the clipping plane, which close solids where they are cut. stages/clip.cl finds
// where rays meet them.
#ifndef CAPLET_STAGES_CLIP_FACE_CL
#define CAPLET_STAGES_CLIP_FACE_CL

#include "shapes/surface.cl"
#include "shapes/traits.cl"
#include "stages/clip_plane.cl"

// Returns whether a hit is on the face that the plane makes.
static inline int on_clip_face(const HitRecord* hit) {
  return has_clip && (hit->surface & CAPLET_CLIPPED) != 0u;
}

// Returns whether a solid is one primitive, whose hits tell whether they enter or leave it. Others
// consist of sheets, which may be wound either way.
static inline int clip_is_primitive(uint shape) {
  return shape_is_solid(shape) || shape == shape_csg;
}

// Returns whether a direction leads from a surface into a closed solid. Where such a ray meets
// nothing before the plane it meets the face there. was_inside: so did the ray that came.
static inline int clip_leads_inside(const Surfaces* surfaces, const Surface* s,
                                    const HitRecord* hit, int was_inside, int crosses) {
  if ((s->flags & CAPLET_GEOMETRY_OPEN) != 0u) return was_inside;
  const int is_told =
      !on_clip_face(hit) && clip_is_primitive(surfaces->geometries[s->geometry].shape);
  const int leaving = is_told ? s->leaving : was_inside;
  return crosses ? !leaving : leaving;
}

// Makes the surface at a hit with CAPLET_CLIPPED that of the face in the plane. It has the material
// of its solid and does not shine. Its point is o + t d, moved on to the plane. The first has an
// error of at most 3 eps (|o| + t |d|) a component, eps = 2^-24; the height is a sum of three
// products, so that its error is at most 4 eps (|p|_1 + |offset|). t is rounded too, but the face
// holds any t.
static inline void clip_surface(__global const ViewRecord* view, const RayRecord* ray,
                                const HitRecord* hit, Surface* s) {
  const float3 o = (float3)(ray->ox, ray->oy, ray->oz), d = (float3)(ray->dx, ray->dy, ray->dz),
               n = clip_normal(view);
  const float3 p = o + hit->t * d;
  s->p = p - clip_height(view, p) * n;
  s->ng = s->ns = (hit->surface & CAPLET_CLIPPED_REVERSED) != 0u ? -n : n;
  s->dpdu = perpendicular(n);
  s->dpdv = cross(n, s->dpdu);
  s->error =
      0x1p-21f * (norm1(p) + fabs(view->clip_offset)) + 0x1p-22f * (norm1(o) + hit->t * norm1(d));
  s->light = CAPLET_NONE;
  s->along_u = 0;
  if (!(fabs(s->uv.x) + fabs(s->uv.y) < INFINITY)) s->uv = (float2)(0.0f);
}

#endif
