// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This BSDF is a sheet that reflects and transmits by Lambert's law, alike from both sides. wo.z >
// 0 (bsdf.cl mirrors the frame).
#ifndef CAPLET_BSDF_DIFFUSETRANSMISSION_CL
#define CAPLET_BSDF_DIFFUSETRANSMISSION_CL

#include "bsdf/bsdf_types.cl"

static inline void diffusetransmission_make(const MaterialPoint* m, Bsdf* b) {
  const float scale = material_number(m, diffusetransmission_at_scale);
  b->reflectance = fmin(scale * material_albedo(m, diffusetransmission_at_reflectance), 1.0f);
  b->transmittance = fmin(scale * material_albedo(m, diffusetransmission_at_transmittance), 1.0f);
}

static inline int diffusetransmission_is_specular(const Bsdf* b) {
  (void)b;
  return 0;
}

// Returns the probability of reflection, by the greatest of the four wavelengths.
static inline float diffusetransmission_reflected(const Bsdf* b) {
  const float r = max4(b->reflectance), t = max4(b->transmittance);
  return r + t > 0.0f ? r / (r + t) : 1.0f;
}

static inline float4 diffusetransmission_eval(const Bsdf* b, int inside, float3 wo, float3 wi,
                                              float* pdf) {
  (void)inside, (void)wo;
  const float cosine = fabs(wi.z) * CAPLET_INV_PI, probability = diffusetransmission_reflected(b);
  *pdf = cosine * (wi.z > 0.0f ? probability : 1.0f - probability);
  return cosine * (wi.z > 0.0f ? b->reflectance : b->transmittance);
}

static inline int diffusetransmission_sample(const Bsdf* b, int inside, int smooth, float3 wo,
                                             float u_component, float2 u, BsdfSample* s) {
  (void)inside, (void)smooth, (void)wo;
  const float reflected = diffusetransmission_reflected(b);
  s->transmitted = u_component >= reflected;
  const float probability = s->transmitted ? 1.0f - reflected : reflected;
  s->wi = sample_cosine_hemisphere(u);
  s->pdf = s->wi.z * CAPLET_INV_PI * probability;
  s->weight = (s->transmitted ? b->transmittance : b->reflectance) / probability;
  s->specular = 0;
  s->eta_scale = 1.0f;
  if (s->transmitted) s->wi.z = -s->wi.z;
  return s->pdf > 0.0f;
}

static inline float4 diffusetransmission_directional_albedo(const Bsdf* b, float3 wo) {
  (void)wo;
  return fmin(b->reflectance + b->transmittance, 1.0f);
}

#endif
