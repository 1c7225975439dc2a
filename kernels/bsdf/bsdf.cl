// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file dispatches to all BSDFs. Local frame: n = (0, 0, 1) outward, wo and wi unit and away
// from the surface, z < 0: inside. Dispersive materials (bsdf_is_dispersive) act at the hero
// wavelength, component 0, alone: components 1..3 of their values and weights are 0. The caller
// compensates once a path, by 4 on component 0 (or by a quarter of its pdf). Stochastic materials
// (trait_stochastic) return unbiased estimates of their values, and weights of a random path
// through them. Their densities are meant for multiple importance sampling: they integrate to 1 at
// most and are the same at each call.
//
// A material of materials.def has a file in this folder with its name, which defines
//   void NAME_make(m, b)  reads its parameters (material_albedo and the like) at a point
//   int NAME_is_specular(b)  1: there is nothing but delta scattering
//   float4 NAME_eval(b, inside, wo, wi, pdf)
//       f |cos wi| and its density; *pdf is 0 before; is not called for specular materials
//   int NAME_sample(b, inside, smooth, wo, u_component, u, s)  smooth: NAME_is_specular
//   float4 NAME_directional_albedo(b, wo)
// These see a frame that is mirrored so that wo.z > 0; inside: it was mirrored. A CHOICE defines
// instead
//   uint NAME_part(m, u)
//       the material in its place; *u, in [0, 1), is used up and replaced by a new number in [0, 1)
#ifndef CAPLET_BSDF_BSDF_CL
#define CAPLET_BSDF_BSDF_CL

#include "bsdf/bsdf_types.cl"
#include "bsdf/{materials}.cl"

// Returns the BSDF of material number `material`, which bsdf_chosen returned, at a place of a
// surface, at four wavelengths (nm).
static inline Bsdf bsdf_make(const Materials* materials, const Spectra* spectra, uint material,
                             const TexturePlace* place, float4 lambda) {
  __global const MaterialRecord* record = materials->materials + material;
  const MaterialPoint m = {materials->material_data + record->data,
                           record->textured,
                           {materials, spectra, *place, lambda}};
  Bsdf b;
  b.kind = record->kind;
  b.flags = record->flags;
  b.random = 0u;
  b.reflectance = b.transmittance = b.eta = b.k = (float4)(0.0f);
  b.alpha_u = b.alpha_v = 0.0f;
  switch (b.kind) {
#define MATERIAL(name, traits) \
  case material_##name:        \
    name##_make(&m, &b);       \
    break;
#define CHOICE(name, traits)
#include "rows/materials.def"
#undef MATERIAL
    default: break;
  }
  return b;
}

// Returns the material to use where a surface has `material`: that material, or a part of a mix. u
// in [0, 1).
static inline uint bsdf_chosen(const Materials* materials, const Spectra* spectra, uint material,
                               const TexturePlace* place, float4 lambda, float u) {
  for (;;) {
    __global const MaterialRecord* record = materials->materials + material;
    const MaterialPoint m = {materials->material_data + record->data,
                             record->textured,
                             {materials, spectra, *place, lambda}};
    switch (record->kind) {
#define MATERIAL(name, traits)
#define CHOICE(name, traits)        \
  case material_##name:             \
    material = name##_part(&m, &u); \
    break;
#include "rows/materials.def"
#undef MATERIAL
      default: return material;
    }
  }
}

// Returns the tangent for the local frame's x. It is dpdu, except for hair on a chain (along_u):
// hair lies along y, so there it is a tangent across the fibre.
static inline float3 bsdf_tangent(const Materials* materials, uint material, float3 dpdu, float3 ns,
                                  int along_u) {
  return along_u && materials->materials[material].kind == material_hair ? cross(dpdu, ns) : dpdu;
}

// Returns 1 if there is nothing but delta scattering.
static inline int bsdf_is_specular(const Bsdf* b) {
  switch (b->kind) {
#define MATERIAL(name, traits) \
  case material_##name:        \
    return name##_is_specular(b);
#define CHOICE(name, traits)
#include "rows/materials.def"
#undef MATERIAL
    default: return 0;
  }
}

// Returns 1 if the BSDF scatters light only to the side that it comes from.
static inline int bsdf_is_opaque(const Bsdf* b) {
  switch (b->kind) {
#define MATERIAL(name, traits)             \
  case material_##name:                    \
    return ((traits)&trait_opaque) != 0 || \
           (((traits)&trait_sheer) != 0 && !(max4(b->transmittance) > 0.0f));
#define CHOICE(name, traits)
#include "rows/materials.def"
#undef MATERIAL
    default: return 0;
  }
}

// Returns f |cos wi|, and the solid-angle density with which bsdf_sample takes wi; 0 for delta
// scattering.
static inline float4 bsdf_eval(const Bsdf* b, float3 wo, float3 wi, float* pdf) {
  *pdf = 0.0f;
  if (wo.z == 0.0f || bsdf_is_specular(b)) return (float4)(0.0f);
  const int inside = wo.z < 0.0f;
  if (inside) {
    wo.z = -wo.z;
    wi.z = -wi.z;
  }
  switch (b->kind) {
#define MATERIAL(name, traits) \
  case material_##name:        \
    return name##_eval(b, inside, wo, wi, pdf);
#define CHOICE(name, traits)
#include "rows/materials.def"
#undef MATERIAL
    default: return (float4)(0.0f);
  }
}

// Samples a direction wi for wo. u_component chooses between reflection and refraction; all u in
// [0, 1). Returns 0 if the light is absorbed; *s must not be used then.
static inline int bsdf_sample(const Bsdf* b, float3 wo, float u_component, float2 u,
                              BsdfSample* s) {
  if (wo.z == 0.0f) return 0;
  const int inside = wo.z < 0.0f, smooth = bsdf_is_specular(b);
  int scattered = 0;
  if (inside) wo.z = -wo.z;
  switch (b->kind) {
#define MATERIAL(name, traits)                                           \
  case material_##name:                                                  \
    scattered = name##_sample(b, inside, smooth, wo, u_component, u, s); \
    break;
#define CHOICE(name, traits)
#include "rows/materials.def"
#undef MATERIAL
    default: break;
  }
  if (!scattered) return 0;
  if (inside) s->wi.z = -s->wi.z;
  s->weight = bsdf_all_wavelengths(b, s->weight);
  return 1;
}

// Returns the directional reflectance for the albedo layer, for all wavelengths. It is exact for
// diffuse, smooth metals and clear glass; rough materials use their smooth counterparts.
static inline float4 bsdf_albedo(const Bsdf* b, float3 wo) {
  switch (b->kind) {
#define MATERIAL(name, traits) \
  case material_##name:        \
    return name##_directional_albedo(b, wo);
#define CHOICE(name, traits)
#include "rows/materials.def"
#undef MATERIAL
    default: return (float4)(0.0f);
  }
}

#endif
