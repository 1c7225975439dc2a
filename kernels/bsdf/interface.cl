// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This BSDF is an invisible surface that separates media (kernels/media/medium_stack.cl): paths go
// through it without a scattering. As a BSDF it sends light straight on.
#ifndef CAPLET_BSDF_INTERFACE_CL
#define CAPLET_BSDF_INTERFACE_CL

#include "bsdf/bsdf_types.cl"

static inline void interface_make(const MaterialPoint* m, Bsdf* b) { (void)m, (void)b; }

static inline int interface_is_specular(const Bsdf* b) {
  (void)b;
  return 1;
}

static inline float4 interface_eval(const Bsdf* b, int inside, float3 wo, float3 wi, float* pdf) {
  (void)b, (void)inside, (void)wo, (void)wi, (void)pdf;
  return (float4)(0.0f);
}

static inline int interface_sample(const Bsdf* b, int inside, int smooth, float3 wo,
                                   float u_component, float2 u, BsdfSample* s) {
  (void)b, (void)inside, (void)smooth, (void)u_component, (void)u;
  s->wi = -wo;
  s->pdf = 1.0f;
  s->weight = (float4)(1.0f);
  s->specular = s->transmitted = 1;
  s->eta_scale = 1.0f;
  return 1;
}

static inline float4 interface_directional_albedo(const Bsdf* b, float3 wo) {
  (void)b, (void)wo;
  return (float4)(1.0f);
}

#endif
