// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This BSDF reflects by Lambert's law on both sides and transmits nothing. wo.z > 0 (bsdf.cl
// mirrors the frame).
#ifndef CAPLET_BSDF_DIFFUSE_CL
#define CAPLET_BSDF_DIFFUSE_CL

#include "bsdf/bsdf_types.cl"

static inline void diffuse_make(const MaterialPoint* m, Bsdf* b) {
  b->reflectance = material_albedo(m, diffuse_at_reflectance);
}

static inline int diffuse_is_specular(const Bsdf* b) {
  (void)b;
  return 0;
}

static inline float4 diffuse_eval(const Bsdf* b, int inside, float3 wo, float3 wi, float* pdf) {
  (void)inside, (void)wo;
  *pdf = wi.z > 0.0f ? wi.z * CAPLET_INV_PI : 0.0f;
  return b->reflectance * *pdf;
}

static inline int diffuse_sample(const Bsdf* b, int inside, int smooth, float3 wo,
                                 float u_component, float2 u, BsdfSample* s) {
  (void)inside, (void)smooth, (void)wo, (void)u_component;
  s->wi = sample_cosine_hemisphere(u);
  s->pdf = s->wi.z * CAPLET_INV_PI;
  s->weight = b->reflectance;
  s->specular = s->transmitted = 0;
  s->eta_scale = 1.0f;
  return s->wi.z > 0.0f;
}

static inline float4 diffuse_directional_albedo(const Bsdf* b, float3 wo) {
  (void)wo;
  return b->reflectance;
}

#endif
