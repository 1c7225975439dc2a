// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Treats rays as cones to find the width of their footprints (Amanatides 1984; Akenine-Moller et
// al., "Improved shader and texture level of detail using ray cones", JCGT 2021). Programs without
// textures have no cones.
#ifndef CAPLET_STAGES_CONE_CL
#define CAPLET_STAGES_CONE_CL

#include "shapes/surface.cl"
#include "stages/cone_share.cl"
#include "textures/texture_types.cl"

// Computes the sides of the footprint of a cone of width `width` along the unit vector d, and the
// footprint in uv, where the surface has derivatives.
static inline void cone_footprint(TexturePlace* place, float3 d, float width, float3 dpdu,
                                  float3 dpdv) {
  const float slant = dot(d, place->n);
  const float3 across = d - slant * place->n;
  const float3 x = dot(across, across) > 1e-12f ? normalize(across) : perpendicular(place->n);
  width = fmin(fabs(width), 1e18f);
  place->dpdx = x * (width / fmax(fabs(slant), 1e-3f));
  place->dpdy = cross(place->n, x) * width;
  // This is a least-squares solution, scaled so that nothing overflows.
  const float u_length = length(dpdu), v_length = length(dpdv);
  if (!(u_length > 0.0f && v_length > 0.0f && u_length < INFINITY && v_length < INFINITY)) return;
  const float3 u = dpdu / u_length, v = dpdv / v_length;
  const float mixed = dot(u, v), determinant = 1.0f - mixed * mixed;
  if (!(determinant > 1e-6f)) return;
  const float2 a = (float2)(dot(u, place->dpdx), dot(v, place->dpdx)),
               b = (float2)(dot(u, place->dpdy), dot(v, place->dpdy));
  place->duvdx = (a - mixed * a.yx) / (determinant * (float2)(u_length, v_length));
  place->duvdy = (b - mixed * b.yx) / (determinant * (float2)(u_length, v_length));
}

// Returns the surface point nearest to a point beside a hit.
static inline Surface surface_beside(const Tree* tree, const Surfaces* surfaces,
                                     const RayRecord* ray, const HitRecord* hit, float3 beside) {
  RayRecord to = *ray;
  to.ox = beside.x;
  to.oy = beside.y;
  to.oz = beside.z;
  HitRecord at = *hit;
  at.t = 0.0f;
  return surface_at(tree, surfaces, &to, &at);
}

// Returns the curvature of the surface at a hit of a ray, over a length of `reach`: the greater
// change of its normal along two directions across each other, over the distance there. It is
// positive where the surface is convex as seen from the side that ng points to.
static inline float surface_bend(const Tree* tree, const Surfaces* surfaces, const RayRecord* ray,
                                 const HitRecord* hit, const Surface* s, float reach) {
  const Frame frame = frame_from_tangent(s->ng, s->dpdu);
  float bend = 0.0f;
#pragma unroll 1
  for (int i = 0; i < 2; ++i) {
    const float3 along = i == 0 ? frame.s : frame.t;
    const Surface there = surface_beside(tree, surfaces, ray, hit, s->p + reach * along);
    const float way = dot(there.p - s->p, along);
    const float change = dot(there.ng - s->ng, along);
    if (way > 0.1f * reach && fabs(change) > fabs(bend * way)) bend = change / way;
  }
  return bend;
}

// Computes dn/du and dn/dv of the shading normal at a hit, by differences from surface points
// beside it. The distance of a step is measured, not taken from its length, so that the derivatives
// are exact for round shapes however long it is; where a triangle ends the step goes back.
static inline void normal_derivatives(const Tree* tree, const Surfaces* surfaces,
                                      const RayRecord* ray, const HitRecord* hit, const Surface* s,
                                      float3* dndu, float3* dndv) {
  *dndu = *dndv = (float3)(0.0f);
  const Frame frame = frame_from_tangent(s->ng, s->dpdu);
  const float reach = 1024.0f * s->error;  // a normal's rounding is then a thousandth of its change
  float3 way[2], change[2];
  way[0] = way[1] = change[0] = change[1] = (float3)(0.0f);
#pragma unroll 1
  for (int i = 0; i < 4; ++i) {
    if (i % 2 == 1 && dot(way[i / 2], way[i / 2]) > 0.5f) continue;
    const float step = i % 2 == 0 ? reach : -reach;
    const Surface there =
        surface_beside(tree, surfaces, ray, hit, s->p + step * (i < 2 ? frame.s : frame.t));
    way[i / 2] = (there.p - s->p) / step;
    change[i / 2] = (there.ns - s->ns) / step;
  }
  const float aa = dot(way[0], way[0]), ab = dot(way[0], way[1]), bb = dot(way[1], way[1]);
  const float determinant = aa * bb - ab * ab;
  if (!(determinant > 1e-6f * aa * bb)) return;
  // Either derivative of the point is a sum of the two steps, and that of the normal the same sum
  // of the changes.
  const float ua = dot(s->dpdu, way[0]), ub = dot(s->dpdu, way[1]), va = dot(s->dpdv, way[0]),
              vb = dot(s->dpdv, way[1]);
  const float3 of_u =
      ((ua * bb - ub * ab) * change[0] + (ub * aa - ua * ab) * change[1]) / determinant;
  const float3 of_v =
      ((va * bb - vb * ab) * change[0] + (vb * aa - va * ab) * change[1]) / determinant;
  if (!(norm1(of_u) + norm1(of_v) < INFINITY)) return;
  // The change of a unit vector is perpendicular to it, but differences over one step have a part
  // along it.
  *dndu = of_u - dot(of_u, s->ns) * s->ns;
  *dndv = of_v - dot(of_v, s->ns) * s->ns;
}

// Returns the cone that goes on from a surface that it met with `width`, spreading by `spread`. A
// mirror turns it, or an interface that refracts, whose index on the side of the ray over that
// beyond is `eta` (reflection: 0). bend: positive where the ray is on the convex side.
static inline float2 cone_turned(float width, float spread, float bend, float cosine, float eta) {
  const float turn = bend * width / fmax(cosine, 0.1f);
  if (eta == 0.0f) return (float2)(width, spread + 2.0f * turn);
  return (float2)(width, eta * spread + (eta - 1.0f) * turn);
}

#endif
