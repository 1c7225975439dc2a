// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This BSDF is a thin pane of glass. Its two faces reflect and transmit in all orders, straight on
// or mirrored (Pharr, Jakob and Humphreys 2023, 9.5.1). It is the same from both sides. wo.z > 0
// (bsdf.cl mirrors the frame).
#ifndef CAPLET_BSDF_THINDIELECTRIC_CL
#define CAPLET_BSDF_THINDIELECTRIC_CL

#include "bsdf/bsdf_types.cl"
#include "bsdf/fresnel.cl"

static inline void thindielectric_make(const MaterialPoint* m, Bsdf* b) {
  b->eta = clamp(material_spectrum(m, thindielectric_at_eta), 1e-2f, 1e2f);
}

static inline int thindielectric_is_specular(const Bsdf* b) {
  (void)b;
  return 1;
}

// Returns R + T R T + T R R R T + ...
static inline float thin_reflectance(float cos_o, float eta) {
  float cos_t;
  const float r = fresnel_dielectric(cos_o, eta, &cos_t), t = 1.0f - r;
  return r < 1.0f ? r + t * t * r / (1.0f - r * r) : 1.0f;
}

static inline float4 thin_reflectances(const Bsdf* b, float cos_o) {
  return (float4)(thin_reflectance(cos_o, b->eta.x), thin_reflectance(cos_o, b->eta.y),
                  thin_reflectance(cos_o, b->eta.z), thin_reflectance(cos_o, b->eta.w));
}

static inline float4 thindielectric_eval(const Bsdf* b, int inside, float3 wo, float3 wi,
                                         float* pdf) {
  (void)b, (void)inside, (void)wo, (void)wi, (void)pdf;
  return (float4)(0.0f);
}

// Directions are the same at all wavelengths: one choice, by the mean reflectance, serves all four.
static inline int thindielectric_sample(const Bsdf* b, int inside, int smooth, float3 wo,
                                        float u_component, float2 u, BsdfSample* s) {
  (void)inside, (void)smooth, (void)u;
  const float4 reflectance = thin_reflectances(b, wo.z);
  const float mean = mean4(reflectance);
  const int reflected = u_component < mean;
  s->wi = (float3)(-wo.x, -wo.y, reflected ? wo.z : -wo.z);
  s->pdf = reflected ? mean : 1.0f - mean;
  s->weight = (reflected ? reflectance : 1.0f - reflectance) / s->pdf;
  s->specular = 1;
  s->transmitted = !reflected;
  s->eta_scale = 1.0f;
  return s->pdf > 0.0f;
}

static inline float4 thindielectric_directional_albedo(const Bsdf* b, float3 wo) {
  (void)b, (void)wo;
  return (float4)(1.0f);
}

#endif
