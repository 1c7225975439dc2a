// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This BSDF is a metal under a coat (layered.cl). wo.z > 0 (bsdf.cl mirrors the frame).
#ifndef CAPLET_BSDF_COATEDCONDUCTOR_CL
#define CAPLET_BSDF_COATEDCONDUCTOR_CL

#include "bsdf/layered.cl"

static inline void coatedconductor_make(const MaterialPoint* m, Bsdf* b) {
  const CoatPlaces at = {coatedconductor_at_interface_eta,
                         coatedconductor_at_interface_alpha_u,
                         coatedconductor_at_interface_alpha_v,
                         coatedconductor_at_thickness,
                         coatedconductor_at_albedo,
                         coatedconductor_at_g,
                         coatedconductor_at_maxdepth,
                         coatedconductor_at_nsamples};
  coat_make(m, b, &at);
  bsdf_roughness(b, material_number(m, coatedconductor_at_conductor_alpha_u),
                 material_number(m, coatedconductor_at_conductor_alpha_v));
  // The limits are those of a metal (conductor.cl), seen from within the coat.
  b->eta = clamp(material_spectrum(m, coatedconductor_at_conductor_eta) / b->coat.eta, 0.0f, 1e4f);
  b->k = clamp(material_spectrum(m, coatedconductor_at_conductor_k) / b->coat.eta, 0.0f, 1e4f);
}

static inline int coatedconductor_is_specular(const Bsdf* b) { return layered_is_specular(b); }

static inline float4 coatedconductor_eval(const Bsdf* b, int inside, float3 wo, float3 wi,
                                          float* pdf) {
  (void)inside;
  return layered_eval(b, wo, wi, pdf);
}

static inline int coatedconductor_sample(const Bsdf* b, int inside, int smooth, float3 wo,
                                         float u_component, float2 u, BsdfSample* s) {
  (void)inside, (void)smooth;
  return layered_sample(b, wo, u_component, u, s);
}

static inline float4 coatedconductor_directional_albedo(const Bsdf* b, float3 wo) {
  return layered_albedo(b, wo);
}

#endif
