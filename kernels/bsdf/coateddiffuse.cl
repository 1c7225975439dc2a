// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This BSDF is Lambert's law under a coat (layered.cl). wo.z > 0 (bsdf.cl mirrors the frame).
#ifndef CAPLET_BSDF_COATEDDIFFUSE_CL
#define CAPLET_BSDF_COATEDDIFFUSE_CL

#include "bsdf/layered.cl"

static inline void coateddiffuse_make(const MaterialPoint* m, Bsdf* b) {
  const CoatPlaces at = {coateddiffuse_at_eta,      coateddiffuse_at_alpha_u,
                         coateddiffuse_at_alpha_v,  coateddiffuse_at_thickness,
                         coateddiffuse_at_albedo,   coateddiffuse_at_g,
                         coateddiffuse_at_maxdepth, coateddiffuse_at_nsamples};
  coat_make(m, b, &at);
  b->reflectance = material_albedo(m, coateddiffuse_at_reflectance);
}

static inline int coateddiffuse_is_specular(const Bsdf* b) { return layered_is_specular(b); }

static inline float4 coateddiffuse_eval(const Bsdf* b, int inside, float3 wo, float3 wi,
                                        float* pdf) {
  (void)inside;
  return layered_eval(b, wo, wi, pdf);
}

static inline int coateddiffuse_sample(const Bsdf* b, int inside, int smooth, float3 wo,
                                       float u_component, float2 u, BsdfSample* s) {
  (void)inside, (void)smooth;
  return layered_sample(b, wo, u_component, u, s);
}

static inline float4 coateddiffuse_directional_albedo(const Bsdf* b, float3 wo) {
  return layered_albedo(b, wo);
}

#endif
