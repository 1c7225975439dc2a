// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This BSDF is a metal: GGX microfacets with the complex Fresnel reflectance, or a perfect mirror.
// wo.z > 0 (bsdf.cl mirrors the frame).
#ifndef CAPLET_BSDF_CONDUCTOR_CL
#define CAPLET_BSDF_CONDUCTOR_CL

#include "bsdf/bsdf_types.cl"
#include "bsdf/fresnel.cl"
#include "bsdf/ggx.cl"
#include "bsdf/multiscatter.cl"

static inline void conductor_make(const MaterialPoint* m, Bsdf* b) {
  bsdf_roughness(b, material_number(m, conductor_at_alpha_u),
                 material_number(m, conductor_at_alpha_v));
  // Beyond 1e4 the reflectance is 1 to 4e-4, and fourth powers stay finite.
  b->eta = clamp(material_spectrum(m, conductor_at_eta), 0.0f, 1e4f);
  b->k = clamp(material_spectrum(m, conductor_at_k), 0.0f, 1e4f);
}

static inline int conductor_is_specular(const Bsdf* b) { return bsdf_is_smooth(b); }

static inline float4 conductor_eval(const Bsdf* b, int inside, float3 wo, float3 wi, float* pdf) {
  (void)inside;
  if (!(wi.z > 0.0f)) return (float4)(0.0f);
  const float3 m = normalize(wo + wi);
  const float cos_m = dot(wo, m);
  if (!(cos_m > 0.0f)) return (float4)(0.0f);
  *pdf = 0.25f * ggx_visible_over_cos(wo, m, b->alpha_u, b->alpha_v);
  const float4 value =
      fresnel_conductor(cos_m, b->eta, b->k) * (*pdf * ggx_masking(wo, wi, b->alpha_u, b->alpha_v));
#ifdef CAPLET_MULTISCATTER
  if (bsdf_multiscatters(b)) return value + metal_multiscattered(b, wo, wi, pdf);
#endif
  return value;
}

static inline int conductor_sample(const Bsdf* b, int inside, int smooth, float3 wo,
                                   float u_component, float2 u, BsdfSample* s) {
  (void)inside, (void)u_component;
  s->specular = smooth;
  s->transmitted = 0;
  s->eta_scale = 1.0f;
  if (smooth) {
    s->wi = (float3)(-wo.x, -wo.y, wo.z);
    s->pdf = 1.0f;
    s->weight = fresnel_conductor(wo.z, b->eta, b->k);
    return 1;
  }
  const float3 m = ggx_sample_visible(wo, b->alpha_u, b->alpha_v, u);
  const float cos_m = dot(wo, m);
  s->wi = normalize(2.0f * cos_m * m - wo);
#ifdef CAPLET_MULTISCATTER
  if (bsdf_multiscatters(b)) {
    if (u_component < metal_loss(wo.z, loss_roughness(b))) s->wi = sample_cosine_hemisphere(u);
    s->pdf = 0.0f;
    const float4 value = conductor_eval(b, inside, wo, s->wi, &s->pdf);
    s->weight = value / s->pdf;
    return s->pdf > 0.0f;
  }
#endif
  if (!(cos_m > 0.0f) || !(s->wi.z > 0.0f)) return 0;
  s->pdf = 0.25f * ggx_visible_over_cos(wo, m, b->alpha_u, b->alpha_v);
  s->weight =
      fresnel_conductor(cos_m, b->eta, b->k) * ggx_masking(wo, s->wi, b->alpha_u, b->alpha_v);
  return s->pdf > 0.0f;
}

static inline float4 conductor_directional_albedo(const Bsdf* b, float3 wo) {
  return fresnel_conductor(fabs(wo.z), b->eta, b->k);
}

#endif
