// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Lambert's law on both sides; reflection only. wo.z > 0 (bsdf.cl mirrors the frame).
#ifndef CAPLET_BSDF_DIFFUSE_CL
#define CAPLET_BSDF_DIFFUSE_CL

#include "bsdf/bsdf_types.cl"

static inline float4 diffuse_eval(const Bsdf* b, float3 wi, float* pdf) {
  *pdf = wi.z > 0.0f ? wi.z * CAPLET_INV_PI : 0.0f;
  return b->reflectance * *pdf;
}

static inline int diffuse_sample(const Bsdf* b, float2 u, BsdfSample* s) {
  s->wi = sample_cosine_hemisphere(u);
  s->pdf = s->wi.z * CAPLET_INV_PI;
  s->weight = b->reflectance;
  s->specular = s->transmitted = 0;
  s->eta_scale = 1.0f;
  return s->wi.z > 0.0f;
}

#endif
