// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This BSDF mixes metal, glass and a diffuse base under a dielectric interface, below a clear coat
// (Burley 2012 and 2015, in the terms of Mitsuba 3's plugin of this name; docs/materials.md says
// where it differs). wo.z > 0 (bsdf.cl mirrors the frame).
//
// Energy: light from below an interface is scaled by the smaller of two factors, one of each
// direction, such that neither direction reflects more than all. The value is reciprocal, and
// integrates to 1 at most.
#ifndef CAPLET_BSDF_PRINCIPLED_CL
#define CAPLET_BSDF_PRINCIPLED_CL

#include "bsdf/bsdf_types.cl"
#include "bsdf/fresnel.cl"
#include "bsdf/ggx.cl"

// Returns the luminance of a colour under D65, by Gauss' quadrature of four points for that weight
// (nm).
static inline float principled_luminance(const MaterialPoint* m, int at) {
  MaterialPoint seen = *m;
  seen.point.lambda = (float4)(462.599f, 529.741f, 591.536f, 658.857f);
  return dot(material_albedo(&seen, at), (float4)(0.051648f, 0.495640f, 0.415109f, 0.037603f));
}

static inline float principled_schlick(float cosine) {
  const float x = clamp(1.0f - cosine, 0.0f, 1.0f), x2 = x * x;
  return x2 * x2 * x;
}

static inline void principled_make(const MaterialPoint* m, Bsdf* b) {
  const float4 base = material_albedo(m, principled_at_base_color);
  b->reflectance = base;
  b->principled_metallic = fmin(material_number(m, principled_at_metallic), 1.0f);
  b->principled_transmission =
      (1.0f - b->principled_metallic) * fmin(material_number(m, principled_at_spec_trans), 1.0f);
  b->transmittance = (float4)(b->principled_transmission);
  b->principled_roughness = fmin(material_number(m, principled_at_roughness), 1.0f);
  // Burley 2012 squares the roughness and stretches it by the aspect.
  const float aspect =
      sqrt(1.0f - 0.9f * fmin(material_number(m, principled_at_anisotropic), 1.0f));
  b->alpha_u = fmax(sqr(b->principled_roughness) / aspect, CAPLET_ALPHA_SMOOTH);
  b->alpha_v = fmax(sqr(b->principled_roughness) * aspect, CAPLET_ALPHA_SMOOTH);
  // An interface of index 1 does not bend light and has no half vector.
  const float eta = clamp(material_number(m, principled_at_eta), 1.001f, 100.0f);
  b->eta = (float4)(eta);

  const float sheen = fmin(material_number(m, principled_at_sheen), 1.0f);
  const float sheen_tint = fmin(material_number(m, principled_at_sheen_tint), 1.0f);
  b->principled_tint = fmin(material_number(m, principled_at_spec_tint), 1.0f);
  float4 hue = (float4)(1.0f);
  if (b->principled_tint > 0.0f || (sheen > 0.0f && sheen_tint > 0.0f)) {
    const float luminance = principled_luminance(m, principled_at_base_color);
    if (luminance > 0.0f) hue = base / luminance;
  }
  b->principled_normal_tinted = fmin(hue * sqr((eta - 1.0f) / (eta + 1.0f)), 1.0f);
  b->k = sheen * mix((float4)(1.0f), hue, sheen_tint);

  b->principled_coat = fmin(material_number(m, principled_at_coat), 1.0f);
  b->coat.alpha_u =
      fmax(sqr(fmin(material_number(m, principled_at_coat_roughness), 1.0f)), CAPLET_ALPHA_SMOOTH);
  b->coat.eta = clamp(material_number(m, principled_at_coat_eta), 1.0f, 100.0f);
  b->coat.albedo =
      mix((float4)(1.0f), material_albedo(m, principled_at_coat_color), b->principled_coat);
}

static inline int principled_is_specular(const Bsdf* b) {
  (void)b;
  return 0;
}

// --- Albedos ---

// Returns the cosine at which a smooth interface reflects no less than the total reflection of
// facets of roughness alpha: a fit for indices of 1.05 to 3, to 1e-3.
static inline float principled_seen_cosine(float cosine, float alpha) {
  return sqrt(cosine * cosine +
              fmax(alpha * (0.227f - 0.062f * alpha) - 0.006f, 0.0f) * sqr(1.0f - cosine));
}

static inline float principled_interface_albedo(float cosine, float eta, float alpha) {
  float cos_t;
  return fresnel_dielectric(principled_seen_cosine(cosine, alpha), eta, &cos_t);
}

// Returns the albedo of Burley's diffuse lobe of reflectance 1, in closed form: 2 cos^2 of the
// angle to the half vector is 1 + dot(wo, wi), and the rest are powers of cosines.
static inline float principled_diffuse_albedo(float c, float roughness) {
  const float f = principled_schlick(c), r = roughness, r2 = r * r;
  const float m0 = 1.0f / 21.0f, m1 = 1.0f / 84.0f,
              m2 = 1.0f / 252.0f;  // 2 mu^(1 + k) (1 - mu)^5, integrated
  const float diffuse = (1.0f - 0.5f * m0) * (1.0f - 0.5f * f);
  const float back = r * (f * (1.0f + 2.0f / 3.0f * c) + m0 + c * m1);
  const float both = r2 * (m0 + 2.0f * c * m1 + c * c * m2 + 0.5f * (1.0f - c * c) * (m0 - m2)) -
                     r * (m0 + c * m1);
  return diffuse + back + f * both;
}

// Returns the albedo of the sheen, (1 - cos)^5 of the angle to the half vector: a fit to 2.5e-5.
static inline float principled_sheen_albedo(float c) {
  return 0.088479f + c * (-0.250838f + c * (0.271506f + c * (-0.137031f + c * 0.028142f)));
}

// Returns the reflectance of the interface over the diffuse base, for light at that cosine to a
// facet. (The tinted part is Schlick's approximation, from the index's reflectance at normal
// incidence.)
static inline float4 principled_interface(const Bsdf* b, float cosine) {
  float cos_t;
  const float4 tinted = b->principled_normal_tinted +
                        (1.0f - b->principled_normal_tinted) * principled_schlick(cosine);
  return (1.0f - b->principled_tint) * fresnel_dielectric(cosine, b->eta.x, &cos_t) +
         b->principled_tint * tinted;
}

// Returns the albedo of the diffuse lobe and the sheen.
static inline float4 principled_soft_albedo(const Bsdf* b, float cosine) {
  return b->reflectance * principled_diffuse_albedo(cosine, b->principled_roughness) +
         b->k * principled_sheen_albedo(cosine);
}

// Returns the factor on it that leaves room for what the interface reflects.
static inline float4 principled_soft_room(const Bsdf* b, float cosine) {
  const float seen = principled_seen_cosine(cosine, fmin(b->alpha_u, b->alpha_v));
  return fmin(
      (1.0f - principled_interface(b, seen)) / fmax(principled_soft_albedo(b, cosine), 1e-6f),
      1.0f);
}

// Returns the transmittance of the coat at a cosine.
static inline float principled_through_coat(const Bsdf* b, float cosine) {
  return 1.0f -
         b->principled_coat * principled_interface_albedo(cosine, b->coat.eta, b->coat.alpha_u);
}

// --- Values ---

// PrincipledShares holds the probability of each lobe. interface: facets of metal and over the
// diffuse base.
typedef struct {
  float coat, glass, interface, soft;
} PrincipledShares;

// Returns the share of light that a facet reflects, of metal and over the diffuse base.
static inline float4 principled_facet(const Bsdf* b, float cosine) {
  const float4 metal = b->reflectance + (1.0f - b->reflectance) * principled_schlick(cosine);
  return b->principled_metallic * metal +
         (1.0f - b->principled_metallic - b->principled_transmission) *
             principled_interface(b, cosine);
}

static inline PrincipledShares principled_shares(const Bsdf* b, int inside, float3 wo) {
  const float soft = 1.0f - b->principled_metallic - b->principled_transmission,
              through = principled_through_coat(b, wo.z);
  float cos_t;
  const float fresnel = fresnel_dielectric(wo.z, inside ? 1.0f / b->eta.x : b->eta.x, &cos_t);
  PrincipledShares s;
  s.coat = (1.0f - through) * (inside ? 1.0f - b->principled_transmission : 1.0f);
  s.glass = b->principled_transmission * (fresnel + (1.0f - fresnel) * sqrt(mean4(b->reflectance)));
  s.interface = through * mean4(principled_facet(b, wo.z));
  s.soft = through * soft * mean4(principled_soft_room(b, wo.z) * principled_soft_albedo(b, wo.z));
  const float sum = s.coat + s.glass + s.interface + s.soft;
  const float scale = sum > 0.0f ? 1.0f / sum : 0.0f;
  s.coat *= scale;
  s.glass *= scale;
  s.interface *= scale;
  s.soft *= scale;
  return s;
}

// Returns f |cos wi| and its density. From inside glass there is no coat, and what is not glass is
// as from outside.
static inline float4 principled_value(const Bsdf* b, int inside, const PrincipledShares* shares,
                                      float3 wo, float3 wi, float* pdf) {
  const int reflected = wi.z > 0.0f;
  const float eta = inside ? 1.0f / b->eta.x : b->eta.x;
  float3 m = reflected ? wo + wi : wo + eta * wi;
  *pdf = 0.0f;
  if (wi.z == 0.0f || !(dot(m, m) > 0.0f)) return (float4)(0.0f);
  m = normalize(m);
  if (m.z < 0.0f) m = -m;
  const float cos_o = dot(wo, m), cos_i = dot(wi, m);
  const int is_facet = cos_o > 0.0f && (reflected ? cos_i > 0.0f : cos_i < 0.0f) && m.z > 0.0f;
  if (!is_facet) return (float4)(0.0f);
  const float visible = ggx_visible_over_cos(wo, m, b->alpha_u, b->alpha_v),
              masking = ggx_masking(wo, wi, b->alpha_u, b->alpha_v);
  float cos_t;
  const float fresnel = fresnel_dielectric(cos_o, eta, &cos_t);
  const float through_o = principled_through_coat(b, wo.z),
              through_i = principled_through_coat(b, fabs(wi.z));
  if (!reflected) {
    const float denominator = cos_i + cos_o / eta;
    const float lobe = (1.0f - fresnel) * visible * cos_o * -cos_i / (denominator * denominator);
    *pdf = shares->glass * lobe;
    return sqrt(b->reflectance * b->coat.albedo) *
           (b->principled_transmission * (inside ? through_i : through_o) * lobe * masking /
            (eta * eta));
  }
  const float lobe = 0.25f * visible;
  float4 below = principled_facet(b, cos_o) * (lobe * masking);
  float4 value = (float4)(0.0f);
  *pdf = (shares->interface + shares->glass * fresnel) * lobe + shares->soft * wi.z * CAPLET_INV_PI;
  if (b->principled_transmission > 0.0f) {
    const float4 glass = (float4)(b->principled_transmission * fresnel * lobe * masking);
    if (inside)
      value = glass;
    else
      below += glass;
  }
  const float soft = 1.0f - b->principled_metallic - b->principled_transmission;
  if (soft > 0.0f) {
    // The diffuse lobe and the sheen are those of Burley 2012, 5.3 and 5.4.
    const float fo = principled_schlick(wo.z), fi = principled_schlick(wi.z),
                back = b->principled_roughness * (1.0f + dot(wo, wi));
    const float diffuse =
        (1.0f - 0.5f * fo) * (1.0f - 0.5f * fi) + back * (fo + fi + fo * fi * (back - 1.0f));
    const float4 room = fmin(principled_soft_room(b, wo.z), principled_soft_room(b, wi.z));
    below += room *
             (b->reflectance * (diffuse * CAPLET_INV_PI) + b->k * principled_schlick(cos_o)) *
             (soft * wi.z);
  }
  value += below * b->coat.albedo * fmin(through_o, through_i);
  if (b->principled_coat > 0.0f) {
    const float alpha = b->coat.alpha_u,
                coat_lobe = 0.25f * ggx_visible_over_cos(wo, m, alpha, alpha);
    *pdf += shares->coat * coat_lobe;
    value += b->principled_coat * (inside ? 1.0f - b->principled_transmission : 1.0f) *
             fresnel_dielectric(cos_o, b->coat.eta, &cos_t) * coat_lobe *
             ggx_masking(wo, wi, alpha, alpha);
  }
  return value;
}

static inline float4 principled_eval(const Bsdf* b, int inside, float3 wo, float3 wi, float* pdf) {
  const PrincipledShares shares = principled_shares(b, inside, wo);
  return principled_value(b, inside, &shares, wo, wi, pdf);
}

static inline int principled_sample(const Bsdf* b, int inside, int smooth, float3 wo,
                                    float u_component, float2 u, BsdfSample* s) {
  (void)smooth;
  const PrincipledShares shares = principled_shares(b, inside, wo);
  const float eta = inside ? 1.0f / b->eta.x : b->eta.x;
  s->specular = s->transmitted = 0;
  s->eta_scale = 1.0f;
  if (u_component < shares.soft) {
    s->wi = sample_cosine_hemisphere(u);
  } else {
    const int coat = u_component < shares.soft + shares.coat;
    const float3 m = ggx_sample_visible(wo, coat ? b->coat.alpha_u : b->alpha_u,
                                        coat ? b->coat.alpha_u : b->alpha_v, u);
    const float cos_o = dot(wo, m);
    if (!(cos_o > 0.0f)) return 0;
    const float of_glass = u_component - shares.soft - shares.coat - shares.interface;
    float cos_t;
    s->transmitted =
        shares.glass > 0.0f && of_glass >= shares.glass * fresnel_dielectric(cos_o, eta, &cos_t);
    if (s->transmitted) {
      // Rounding may lead here where nothing is refracted.
      if (!(fresnel_dielectric(cos_o, eta, &cos_t) < 1.0f)) return 0;
      s->wi = normalize((cos_o / eta - cos_t) * m - wo / eta);
      s->eta_scale = eta * eta;
    } else {
      s->wi = normalize(2.0f * cos_o * m - wo);
    }
  }
  if (s->transmitted ? !(s->wi.z < 0.0f) : !(s->wi.z > 0.0f)) return 0;
  const float4 value = principled_value(b, inside, &shares, wo, s->wi, &s->pdf);
  if (!(s->pdf > 0.0f) || isinf(s->pdf)) return 0;
  s->weight = value / s->pdf;
  return 1;
}

static inline float4 principled_directional_albedo(const Bsdf* b, float3 wo) {
  const float cosine = fabs(wo.z),
              soft = 1.0f - b->principled_metallic - b->principled_transmission,
              through = principled_through_coat(b, cosine);
  const float4 below = principled_facet(b, cosine) +
                       soft * principled_soft_room(b, cosine) * principled_soft_albedo(b, cosine) +
                       (float4)(b->principled_transmission);
  return fmin(below * b->coat.albedo * through + (1.0f - through), 1.0f);
}

#endif
