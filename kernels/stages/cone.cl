// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Rays as cones: how wide what they see is (Amanatides 1984; Akenine-Moller et al., "Improved shader and texture level of detail using ray
// cones", JCGT 2021). Programs without textures have none.
#ifndef CAPLET_STAGES_CONE_CL
#define CAPLET_STAGES_CONE_CL

#include "shapes/surface.cl"
#include "stages/cone_share.cl"
#include "textures/texture_types.cl"

// The sides of what a cone of width `width` along the unit vector d takes in, and what that is in uv, where the surface has derivatives.
static inline void cone_footprint(TexturePlace* place, float3 d, float width, float3 dpdu, float3 dpdv) {
  const float slant = dot(d, place->n);
  const float3 across = d - slant * place->n;
  const float3 x = dot(across, across) > 1e-12f ? normalize(across) : perpendicular(place->n);
  width = fmin(fabs(width), 1e18f);
  place->dpdx = x * (width / fmax(fabs(slant), 1e-3f));
  place->dpdy = cross(place->n, x) * width;
  // Least squares; scaled, so that nothing overflows.
  const float u_length = length(dpdu), v_length = length(dpdv);
  if (!(u_length > 0.0f && v_length > 0.0f && u_length < INFINITY && v_length < INFINITY)) return;
  const float3 u = dpdu / u_length, v = dpdv / v_length;
  const float mixed = dot(u, v), determinant = 1.0f - mixed * mixed;
  if (!(determinant > 1e-6f)) return;
  const float2 a = (float2)(dot(u, place->dpdx), dot(v, place->dpdx)), b = (float2)(dot(u, place->dpdy), dot(v, place->dpdy));
  place->duvdx = (a - mixed * a.yx) / (determinant * (float2)(u_length, v_length));
  place->duvdy = (b - mixed * b.yx) / (determinant * (float2)(u_length, v_length));
}

// How the surface bends at a hit of a ray, over a length of `reach`: the greater change of its normal along two directions across each
// other, over the way there. Positive where it is convex as seen from the side that ng points to.
static inline float surface_bend(const Tree* tree, const Surfaces* surfaces, const RayRecord* ray, const HitRecord* hit, const Surface* s, float reach) {
  const Frame frame = frame_from_tangent(s->ng, s->dpdu);
  float bend = 0.0f;
#pragma unroll 1
  for (int i = 0; i < 2; ++i) {
    const float3 along = i == 0 ? frame.s : frame.t;
    // The surface point nearest to one beside it.
    const float3 beside = s->p + reach * along;
    RayRecord to = *ray;
    to.ox = beside.x;
    to.oy = beside.y;
    to.oz = beside.z;
    HitRecord at = *hit;
    at.t = 0.0f;
    const Surface there = surface_at(tree, surfaces, &to, &at);
    const float way = dot(there.p - s->p, along);
    const float change = dot(there.ng - s->ng, along);
    if (way > 0.1f * reach && fabs(change) > fabs(bend * way)) bend = change / way;
  }
  return bend;
}

// The cone that goes on from a surface it met with `width`, spreading by `spread`: turned by a mirror or an interface that bends, whose
// index on the side of the ray over that beyond is `eta` (reflection: 0). bend: positive where the ray is on the convex side.
static inline float2 cone_turned(float width, float spread, float bend, float cosine, float eta) {
  const float turn = bend * width / fmax(cosine, 0.1f);
  if (eta == 0.0f) return (float2)(width, spread + 2.0f * turn);
  return (float2)(width, eta * spread + (eta - 1.0f) * turn);
}

#endif
