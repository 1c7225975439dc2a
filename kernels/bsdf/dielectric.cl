// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This BSDF is a dielectric such as glass: GGX reflection and refraction (Walter et al. 2007), or a
// clear interface. wo.z > 0 (bsdf.cl mirrors the frame). Radiance is transported: refraction scales
// it by 1 / eta^2.
#ifndef CAPLET_BSDF_DIELECTRIC_CL
#define CAPLET_BSDF_DIELECTRIC_CL

#include "bsdf/bsdf_types.cl"
#include "bsdf/fresnel.cl"
#include "bsdf/ggx.cl"
#include "bsdf/multiscatter.cl"

static inline void dielectric_make(const MaterialPoint* m, Bsdf* b) {
  bsdf_roughness(b, material_number(m, dielectric_at_alpha_u),
                 material_number(m, dielectric_at_alpha_v));
  b->eta = clamp(material_spectrum(m, dielectric_at_eta), 1e-2f, 1e2f);
}

static inline int dielectric_is_specular(const Bsdf* b) {
  return fabs(b->eta.x - 1.0f) < CAPLET_ETA_MATCHED || bsdf_is_smooth(b);
}

// Returns the index beyond the interface over that of wo's side.
static inline float dielectric_relative_eta(const Bsdf* b, int inside) {
  return inside ? 1.0f / b->eta.x : b->eta.x;
}

static inline float dielectric_facets(const Bsdf* b, float eta, float3 wo, float3 wi, float* pdf) {
  const int reflected = wi.z > 0.0f;
  float3 m = reflected ? wo + wi : wo + eta * wi;
  if (wi.z == 0.0f || !(dot(m, m) > 0.0f)) return 0.0f;
  m = normalize(m);
  if (m.z < 0.0f) m = -m;
  const float cos_o = dot(wo, m), cos_i = dot(wi, m);
  if (!(cos_o > 0.0f) || (reflected ? !(cos_i > 0.0f) : !(cos_i < 0.0f)) || !(m.z > 0.0f))
    return 0.0f;
  float cos_t;
  const float fresnel = fresnel_dielectric(cos_o, eta, &cos_t);
  const float visible = ggx_visible_over_cos(wo, m, b->alpha_u, b->alpha_v);
  const float masking = ggx_masking(wo, wi, b->alpha_u, b->alpha_v);
  if (reflected) {
    *pdf = 0.25f * fresnel * visible;
    return *pdf * masking;
  }
  const float denominator = cos_i + cos_o / eta;
  *pdf = (1.0f - fresnel) * visible * cos_o * -cos_i / (denominator * denominator);
  return *pdf * masking / (eta * eta);
}

static inline float dielectric_value(const Bsdf* b, float eta, float3 wo, float3 wi, float* pdf) {
  const float value = dielectric_facets(b, eta, wo, wi, pdf);
#ifdef CAPLET_MULTISCATTER
  if (bsdf_multiscatters(b)) return value + interface_multiscattered(b, eta, wo, wi, pdf);
#endif
  return value;
}

static inline float4 dielectric_eval(const Bsdf* b, int inside, float3 wo, float3 wi, float* pdf) {
  return bsdf_all_wavelengths(
      b, (float4)(dielectric_value(b, dielectric_relative_eta(b, inside), wo, wi, pdf)));
}

#ifdef CAPLET_MULTISCATTER
// Samples a direction of the multiple-scattering lobe (multiscatter.cl). u_component in [0, 1)
// chooses the side.
static inline int dielectric_sample_multiscattered(const Bsdf* b, float eta, float3 wo,
                                                   float u_component, float2 u, BsdfSample* s) {
  s->wi = sample_cosine_hemisphere(u);
  s->specular = 0;
  s->transmitted = u_component < interface_lost_beyond(loss_roughness(b), eta);
  s->eta_scale = s->transmitted ? eta * eta : 1.0f;
  if (s->transmitted) s->wi.z = -s->wi.z;
  s->pdf = 0.0f;
  s->weight = (float4)(dielectric_value(b, eta, wo, s->wi, &s->pdf) / s->pdf);
  return s->pdf > 0.0f && !isinf(s->pdf);
}
#endif

static inline int dielectric_sample(const Bsdf* b, int inside, int smooth, float3 wo,
                                    float u_component, float2 u, BsdfSample* s) {
  const float eta = dielectric_relative_eta(b, inside);
#ifdef CAPLET_MULTISCATTER
  const int multiscatters = !smooth && bsdf_multiscatters(b);
  if (multiscatters) {
    const float lost = interface_loss(wo.z, loss_roughness(b), eta);
    if (u_component < lost)
      return dielectric_sample_multiscattered(b, eta, wo, u_component / lost, u, s);
    u_component = fmin((u_component - lost) / (1.0f - lost), 0x1.fffffep-1f);
  }
#endif
  const float3 m =
      smooth ? (float3)(0.0f, 0.0f, 1.0f) : ggx_sample_visible(wo, b->alpha_u, b->alpha_v, u);
  const float cos_o = dot(wo, m);
  if (!(cos_o > 0.0f)) return 0;
  float cos_t;
  const float fresnel = fresnel_dielectric(cos_o, eta, &cos_t);
  const int reflected = u_component < fresnel;
  float weight = 1.0f;
  s->specular = smooth;
  s->transmitted = !reflected;
  s->eta_scale = reflected ? 1.0f : eta * eta;
  if (reflected) {
    s->wi = smooth ? (float3)(-wo.x, -wo.y, wo.z) : normalize(2.0f * cos_o * m - wo);
    s->pdf = fresnel;
  } else {
    s->wi = normalize((cos_o / eta - cos_t) * m - wo / eta);
    s->pdf = 1.0f - fresnel;
    weight = 1.0f / (eta * eta);
  }
  if (reflected ? !(s->wi.z > 0.0f) : !(s->wi.z < 0.0f)) return 0;
  if (!smooth) {
    const float visible = ggx_visible_over_cos(wo, m, b->alpha_u, b->alpha_v);
    const float cos_i = dot(s->wi, m);
    const float denominator = cos_i + cos_o / eta;
    s->pdf *=
        reflected ? 0.25f * visible : visible * cos_o * fabs(cos_i) / (denominator * denominator);
    weight *= ggx_masking(wo, s->wi, b->alpha_u, b->alpha_v);
#ifdef CAPLET_MULTISCATTER
    if (multiscatters) {
      s->pdf = 0.0f;
      weight = dielectric_value(b, eta, wo, s->wi, &s->pdf) / s->pdf;
    }
#endif
  }
  s->weight = (float4)(weight);
  return s->pdf > 0.0f && !isinf(s->pdf);
}

static inline float4 dielectric_directional_albedo(const Bsdf* b, float3 wo) {
  (void)b, (void)wo;
  return (float4)(1.0f);
}

#endif
