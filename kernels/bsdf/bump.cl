// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes shading normals from a material's normal map or displacement (Pharr, Jakob and Humphreys
// 2023, 10.5.3 and 10.5.4).
#ifndef CAPLET_BSDF_BUMP_CL
#define CAPLET_BSDF_BUMP_CL

#include "textures/textures.cl"

enum {
  any_normalmap = 0
#define TEXTURE(name) | (texture_##name == texture_normalmap)
#include "rows/textures.def"
#undef TEXTURE
  ,
  any_displacement = 0
#define TEXTURE(name) | (texture_##name == texture_displacement)
#include "rows/textures.def"
#undef TEXTURE
  ,
  any_bump = any_normalmap | any_displacement
};

// BumpDerivatives holds the derivatives of a point and of its normal by u and v; only displacements
// read the normal's.
typedef struct {
  float3 dpdu, dpdv, dndu, dndv;
} BumpDerivatives;

// Returns the shading normal of material number `material` at a place whose own normal is ns, of
// unit length, on the side of the geometric normal of the place.
static inline float3 bump_normal(const Materials* materials, const Spectra* spectra, uint material,
                                 const TexturePlace* place, float3 ns, const BumpDerivatives* of) {
  const uint bump = materials->materials[material].bump;
  if (bump == CAPLET_NONE) return ns;
  TexturePoint at = {materials, spectra, *place, (float4)(550.0f)};
  float3 n = ns;
  int is_map = any_normalmap;
  if (any_displacement != 0)
    is_map &= materials->materials[material].bump_kind == texture_normalmap;
  if (is_map) {
    const Frame frame = frame_from_tangent(ns, of->dpdu);
    const float4 turned = texture_eval(bump, &at);
    n = to_world(&frame, turned.xyz);
  } else {
    // The derivatives are made perpendicular to the shading normal, so that even heights leave it
    // as it is.
    const float3 dpdu = of->dpdu - dot(of->dpdu, ns) * ns;
    const float3 dpdv = of->dpdv - dot(of->dpdv, ns) * ns;
    const float3 normal = cross(dpdu, dpdv);
    if (!(dot(normal, normal) > 0.0f)) return ns;
    // The step is half of the footprint, or a small one where the footprint is not known.
    float2 step = 0.5f * (fabs(place->duvdx) + fabs(place->duvdy));
    step = (float2)(step.x > 0.0f ? step.x : 5e-4f, step.y > 0.0f ? step.y : 5e-4f);
    // In close-ups the step is not smaller than floats of places and heights can resolve.
    step = fmax(step, 0x1p-18f * fmax(fabs(place->uv.x), fabs(place->uv.y)));
    float height[3];
#pragma unroll 1
    for (int i = 0; i < 3; ++i) {
      const float2 move = (float2)(i == 1 ? step.x : 0.0f, i == 2 ? step.y : 0.0f);
      at.place.uv = place->uv + move;
      at.place.p = place->p + move.x * dpdu + move.y * dpdv;
      height[i] = texture_eval(bump, &at).x;
    }
    // The slopes give the derivatives of the point that is moved by the height along the normal.
    const float2 slope = (float2)(height[1] - height[0], height[2] - height[0]) / step;
    n = cross(dpdu + slope.x * ns + height[0] * of->dndu,
              dpdv + slope.y * ns + height[0] * of->dndv);
  }
  const float scale = max3(fabs(n));
  if (!(scale > 0.0f && scale < INFINITY)) return ns;
  n = normalize(n / scale);
  return dot(n, place->n) < 0.0f ? -n : n;
}

#endif
