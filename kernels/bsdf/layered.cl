// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This BSDF is a base under a coat: a rough or clear dielectric interface, and between both a layer
// that absorbs, or scatters by Henyey and Greenstein's law. A random walk follows light between the
// two (Guo, Hasan and Zhao 2018; Pharr, Jakob and Humphreys 2023, 14.3). Coats are the same from
// both sides. wo.z > 0 (bsdf.cl mirrors the frame).
//
// Within the walk z is 0 at the base and coat.thickness at the interface, and w is the direction of
// the walk. Weights of the interface leave out the 1 / eta^2 of radiance: entering multiplies by it
// and leaving divides by it.
#ifndef CAPLET_BSDF_LAYERED_CL
#define CAPLET_BSDF_LAYERED_CL

#include "bsdf/bsdf_types.cl"
#include "bsdf/fresnel.cl"
#include "bsdf/ggx.cl"
#include "math/phase.cl"
#include "math/rng.cl"

// WalkNumbers makes independent numbers in [0, 1) from a key and their count.
typedef struct {
  uint key, next;
} WalkNumbers;

static inline float walk_1d(WalkNumbers* numbers) {
  return unit_float(hash_combine(numbers->key, numbers->next++));
}
static inline float2 walk_2d(WalkNumbers* numbers) {
  const float x = walk_1d(numbers);
  return (float2)(x, walk_1d(numbers));
}

// --- The interface ---

// CoatPlaces says where the numbers of a coat are in the material's data.
typedef struct {
  int eta, alpha_u, alpha_v, thickness, albedo, g, max_depth, samples;
} CoatPlaces;

static inline void coat_make(const MaterialPoint* m, Bsdf* b, const CoatPlaces* at) {
  bsdf_roughness(b, material_number(m, at->alpha_u), material_number(m, at->alpha_v));
  b->coat.alpha_u = b->alpha_u;
  b->coat.alpha_v = b->alpha_v;
  b->coat.eta = clamp(material_spectrum(m, at->eta).x, 1e-2f, 1e2f);
  b->coat.thickness = fmax(material_number(m, at->thickness), 1e-30f);
  b->coat.albedo = material_albedo(m, at->albedo);
  b->coat.g = clamp(material_signed(m, at->g), -0.99f, 0.99f);
  b->coat.max_depth = (int)m->data[at->max_depth];
  b->coat.samples = max((int)m->data[at->samples], 1);
}

static inline int coat_is_smooth(const BsdfCoat* coat) {
  return (coat->alpha_u < CAPLET_ALPHA_SMOOTH && coat->alpha_v < CAPLET_ALPHA_SMOOTH) ||
         fabs(coat->eta - 1.0f) < CAPLET_ETA_MATCHED;
}

#define COAT_REFLECTS 1
#define COAT_TRANSMITS 2

// pdf: per solid angle, or the probability of reflection or transmission where the interface is
// clear.
typedef struct {
  float3 wi;
  float weight, pdf;
  int transmitted;
} CoatSample;

// Samples a direction wi for wo, which is above or below. `ways` names what is allowed; u_component
// chooses where both reflection and transmission are.
static inline int coat_sample(const BsdfCoat* coat, float3 wo, int ways, float u_component,
                              float2 u, CoatSample* s) {
  const int below = wo.z < 0.0f, smooth = coat_is_smooth(coat);
  const float eta = below ? 1.0f / coat->eta : coat->eta;
  if (below) wo.z = -wo.z;
  const float3 m =
      smooth ? (float3)(0.0f, 0.0f, 1.0f) : ggx_sample_visible(wo, coat->alpha_u, coat->alpha_v, u);
  const float cos_o = dot(wo, m);
  if (!(cos_o > 0.0f)) return 0;
  float cos_t;
  const float fresnel = fresnel_dielectric(cos_o, eta, &cos_t);
  const float reflection = ways == COAT_REFLECTS ? 1.0f : ways == COAT_TRANSMITS ? 0.0f : fresnel;
  const int reflected = u_component < reflection;
  const float share = reflected ? fresnel : 1.0f - fresnel;
  s->transmitted = !reflected;
  s->pdf = reflected ? reflection : 1.0f - reflection;
  s->weight = share / s->pdf;
  s->wi = reflected ? 2.0f * cos_o * m - wo : (cos_o / eta - cos_t) * m - wo / eta;
  if (smooth) s->wi.z = reflected ? wo.z : -cos_t;
  s->wi = normalize(s->wi);
  if (!(share > 0.0f) || (reflected ? !(s->wi.z > 0.0f) : !(s->wi.z < 0.0f))) return 0;
  if (!smooth) {
    const float cos_i = dot(s->wi, m), denominator = cos_i + cos_o / eta;
    s->pdf *= ggx_visible_over_cos(wo, m, coat->alpha_u, coat->alpha_v) *
              (reflected ? 0.25f : cos_o * fabs(cos_i) / (denominator * denominator));
    s->weight *= ggx_masking(wo, s->wi, coat->alpha_u, coat->alpha_v);
  }
  if (below) s->wi.z = -s->wi.z;
  return s->pdf > 0.0f && !isinf(s->pdf);
}

// Returns the reflection of a rough interface on the outside: f |cos wi|.
static inline float coat_reflected(const BsdfCoat* coat, float3 wo, float3 wi) {
  const float3 m = normalize(wo + wi);
  float cos_t;
  return 0.25f * fresnel_dielectric(dot(wo, m), coat->eta, &cos_t) *
         ggx_visible_over_cos(wo, m, coat->alpha_u, coat->alpha_v) *
         ggx_masking(wo, wi, coat->alpha_u, coat->alpha_v);
}

// Transmits through a rough interface from outside to inside: returns the weight of coat_sample
// there, and the density with which it takes `inner` by transmission alone.
static inline float coat_transmitted(const BsdfCoat* coat, float3 outer, float3 inner, float* pdf) {
  *pdf = 0.0f;
  float3 m = outer + coat->eta * inner;
  if (!(dot(m, m) > 0.0f)) return 0.0f;
  m = normalize(m);
  if (m.z < 0.0f) m = -m;
  const float cos_o = dot(outer, m), cos_i = dot(inner, m);
  if (!(cos_o > 0.0f) || !(cos_i < 0.0f) || !(m.z > 0.0f)) return 0.0f;
  const float denominator = cos_i + cos_o / coat->eta;
  *pdf = ggx_visible_over_cos(outer, m, coat->alpha_u, coat->alpha_v) * cos_o * -cos_i /
         (denominator * denominator);
  float cos_t;
  return (1.0f - fresnel_dielectric(cos_o, coat->eta, &cos_t)) *
         ggx_masking(outer, inner, coat->alpha_u, coat->alpha_v);
}

// --- The base, seen from within: wo.z > 0 ---

static inline int base_is_metal(const Bsdf* b) {
  return any_metal_base && b->kind == material_coatedconductor;
}
static inline int base_is_specular(const Bsdf* b) { return base_is_metal(b) && bsdf_is_smooth(b); }

// Returns f |cos wi| and its density.
static inline float4 base_eval(const Bsdf* b, float3 wo, float3 wi, float* pdf) {
  *pdf = 0.0f;
  if (!(wi.z > 0.0f)) return (float4)(0.0f);
  if (!base_is_metal(b)) {
    *pdf = wi.z * CAPLET_INV_PI;
    return b->reflectance * *pdf;
  }
  if (bsdf_is_smooth(b)) return (float4)(0.0f);
  const float3 m = normalize(wo + wi);
  *pdf = 0.25f * ggx_visible_over_cos(wo, m, b->alpha_u, b->alpha_v);
  return fresnel_conductor(dot(wo, m), b->eta, b->k) *
         (*pdf * ggx_masking(wo, wi, b->alpha_u, b->alpha_v));
}

// Samples a direction; *weight is multiplied by f |cos wi| / pdf.
static inline int base_sample(const Bsdf* b, float3 wo, float2 u, float3* wi, float4* weight,
                              float* pdf) {
  if (!base_is_metal(b)) {
    *wi = sample_cosine_hemisphere(u);
    *weight *= b->reflectance;
    *pdf = wi->z * CAPLET_INV_PI;
    return wi->z > 0.0f;
  }
  const int smooth = bsdf_is_smooth(b);
  const float3 m =
      smooth ? (float3)(0.0f, 0.0f, 1.0f) : ggx_sample_visible(wo, b->alpha_u, b->alpha_v, u);
  const float cos_m = dot(wo, m);
  *wi = normalize(2.0f * cos_m * m - wo);
  if (!(cos_m > 0.0f) || !(wi->z > 0.0f)) return 0;
  *weight *= fresnel_conductor(cos_m, b->eta, b->k);
  *pdf = 1.0f;
  if (smooth) return 1;
  *weight *= ggx_masking(wo, *wi, b->alpha_u, b->alpha_v);
  *pdf = 0.25f * ggx_visible_over_cos(wo, m, b->alpha_u, b->alpha_v);
  return *pdf > 0.0f;
}

// --- The layer between ---

static inline int coat_scatters(const BsdfCoat* coat) { return max4(coat->albedo) > 0.0f; }

// Returns the transmittance over the height dz in direction w.
static inline float coat_passes(float dz, float3 w) { return exp(-fabs(dz / w.z)); }

// Applies Russian roulette to a walk: returns 0 where it ends.
static inline int walk_goes_on(int depth, float4* weight, WalkNumbers* numbers) {
  const float most = max4(*weight);
  if (depth <= 3 || most >= 0.25f) return 1;
  if (walk_1d(numbers) >= most) return 0;
  *weight /= most;
  return 1;
}

// Moves *z by a free flight in the direction w. Returns 1 if the walk comes to a side, 0 if it
// comes to a scattering, -1 if it does not move.
static inline int walk_advance(const BsdfCoat* coat, float3 w, float* z, float4* weight,
                               WalkNumbers* numbers) {
  if (!coat_scatters(coat)) {
    *z = w.z > 0.0f ? coat->thickness : 0.0f;
    *weight *= coat_passes(coat->thickness, w);
    return 1;
  }
  const float to = *z - log(1.0f - walk_1d(numbers)) * w.z;
  if (to == *z) return -1;
  *z = clamp(to, 0.0f, coat->thickness);
  return !(to > 0.0f && to < coat->thickness);
}

// --- Both together ---

static inline int layered_is_specular(const Bsdf* b) {
  return coat_is_smooth(&b->coat) && base_is_specular(b) && !coat_scatters(&b->coat);
}

// Makes one walk from wo, with connections to wi. Returns an estimate of f |cos wi| without the
// outside reflection of the interface. Two strategies connect to wi, weighted against each other as
// densities of the direction within: transmission into the coat from wi, and sampling by a
// scattering within (Veach 1997, 9).
static inline float4 layered_walk(const Bsdf* b, float3 wo, float3 wi, WalkNumbers* numbers) {
  const BsdfCoat* coat = &b->coat;
  const int coat_specular = coat_is_smooth(coat), base_specular = base_is_specular(b);
  const float inside_out = wi.z / (coat->eta * coat->eta);  // over the cosine within
  float4 sum = (float4)(0.0f);
  CoatSample enter, leave;
  if (!coat_sample(coat, wo, COAT_TRANSMITS, 0.0f, walk_2d(numbers), &enter)) return sum;
  if (!coat_sample(coat, wi, COAT_TRANSMITS, 0.0f, walk_2d(numbers), &leave)) return sum;
  const float3 out = -leave.wi;
  const float out_value = leave.weight * inside_out / out.z;
  float4 beta = (float4)(enter.weight);
  float3 w = enter.wi;
  float z = coat->thickness;
  for (int depth = 0; depth < coat->max_depth; ++depth) {
    if (!walk_goes_on(depth, &beta, numbers)) break;
    const int came = walk_advance(coat, w, &z, &beta, numbers);
    if (came < 0) continue;
    float pdf = 0.0f;  // of the next w
    if (came == 0) {
      const float phase = phase_density(dot(w, out), coat->g);
      const float weight = coat_specular ? 1.0f : power_heuristic(leave.pdf, phase);
      beta *= coat->albedo;
      sum += beta * (phase * weight * coat_passes(coat->thickness - z, out) * out_value);
      w = phase_sample(w, coat->g, walk_2d(numbers), &pdf);
      if (!(fabs(w.z) > 0.0f)) break;
    } else if (z > 0.0f) {
      CoatSample back;
      if (!coat_sample(coat, -w, COAT_REFLECTS, 0.0f, walk_2d(numbers), &back)) break;
      beta *= back.weight;
      w = back.wi;
      continue;
    } else {
      float value_pdf;
      const float4 value = base_eval(b, -w, out, &value_pdf);
      const float weight = coat_specular ? 1.0f : power_heuristic(leave.pdf, value_pdf);
      sum += beta * value * (weight * coat_passes(coat->thickness, out) * out_value);
      if (!base_sample(b, -w, walk_2d(numbers), &w, &beta, &pdf)) break;
    }
    if (coat_specular || !(w.z > 0.0f)) continue;
    float leave_pdf;
    const float value = coat_transmitted(coat, wi, -w, &leave_pdf);
    const float weight = base_specular && came > 0 ? 1.0f : power_heuristic(pdf, leave_pdf);
    sum += beta *
           (weight * value * leave_pdf * coat_passes(coat->thickness - z, w) * inside_out / w.z);
  }
  return sum;
}

// Returns the density for multiple importance sampling. It sums the interface's own reflection; the
// base as a clear interface would show it, its lobe widened by the roughness of the coat (two
// refractions turn the half vector by (1 - 1 / eta) / sqrt(2) of the coat's slope); and a cosine
// for the rest. Each integrates to 1 at most.
static inline float layered_pdf(const Bsdf* b, float3 wo, float3 wi) {
  const BsdfCoat* coat = &b->coat;
  const float diffuse = wi.z * CAPLET_INV_PI;
  float cos_t;
  const float fresnel = fresnel_dielectric(wo.z, coat->eta, &cos_t);
  float own = 0.0f, base = diffuse;
  if (!coat_is_smooth(coat))
    own = 0.25f * ggx_visible_over_cos(wo, normalize(wo + wi), coat->alpha_u, coat->alpha_v);
  if (base_is_metal(b)) {
    const float2 o = wo.xy / coat->eta, i = wi.xy / coat->eta;
    const float zo2 = 1.0f - dot(o, o), zi2 = 1.0f - dot(i, i);
    const float wider = 0.5f * sqr(1.0f - 1.0f / coat->eta);
    const float alpha_u = sqrt(sqr(b->alpha_u) + wider * sqr(coat->alpha_u)),
                alpha_v = sqrt(sqr(b->alpha_v) + wider * sqr(coat->alpha_v));
    if (zo2 > 0.0f && zi2 > 0.0f && fmin(alpha_u, alpha_v) > CAPLET_ALPHA_MIN) {
      const float3 from = (float3)(o.x, o.y, sqrt(zo2)), to = (float3)(i.x, i.y, sqrt(zi2));
      base = 0.25f * ggx_visible_over_cos(from, normalize(from + to), alpha_u, alpha_v) * wi.z /
             (coat->eta * coat->eta * to.z);
    }
  }
  if (coat_scatters(coat)) base = mix(diffuse, base, exp(-2.0f * coat->thickness));
  return 0.9f * (fresnel * own + (1.0f - fresnel) * base) + 0.1f * diffuse;
}

static inline float4 layered_eval(const Bsdf* b, float3 wo, float3 wi, float* pdf) {
  if (!(wi.z > 0.0f)) return (float4)(0.0f);
  *pdf = layered_pdf(b, wo, wi);
  WalkNumbers numbers = {hash_combine(b->random, 0u), 0u};
  float4 sum = (float4)(0.0f);
  for (int walk = 0; walk < b->coat.samples; ++walk) sum += layered_walk(b, wo, wi, &numbers);
  sum /= (float)b->coat.samples;
  if (!coat_is_smooth(&b->coat)) sum += coat_reflected(&b->coat, wo, wi);
  return bsdf_all_wavelengths(b, sum);
}

static inline int layered_sample(const Bsdf* b, float3 wo, float u_component, float2 u,
                                 BsdfSample* s) {
  const BsdfCoat* coat = &b->coat;
  const int coat_specular = coat_is_smooth(coat);
  CoatSample step;
  if (!coat_sample(coat, wo, COAT_REFLECTS | COAT_TRANSMITS, u_component, u, &step)) return 0;
  int out = !step.transmitted, specular = coat_specular;
  float4 weight = (float4)(step.weight);
  float3 w = step.wi;
  float z = coat->thickness;
  WalkNumbers numbers = {hash_combine(b->random, 1u), 0u};
  for (int depth = 0; !out && depth < coat->max_depth; ++depth) {
    if (!walk_goes_on(depth, &weight, &numbers)) return 0;
    const int came = walk_advance(coat, w, &z, &weight, &numbers);
    if (came < 0) return 0;
    float pdf;
    if (came == 0) {
      weight *= coat->albedo;
      w = phase_sample(w, coat->g, walk_2d(&numbers), &pdf);
      if (!(fabs(w.z) > 0.0f)) return 0;
      specular = 0;
    } else if (z > 0.0f) {
      const float choice = walk_1d(&numbers);
      if (!coat_sample(coat, -w, COAT_REFLECTS | COAT_TRANSMITS, choice, walk_2d(&numbers), &step))
        return 0;
      weight *= step.weight;
      w = step.wi;
      out = step.transmitted;
    } else {
      if (!base_sample(b, -w, walk_2d(&numbers), &w, &weight, &pdf)) return 0;
      specular &= base_is_specular(b);
    }
  }
  if (!out) return 0;
  s->wi = w;
  s->weight = weight;
  s->specular = specular;
  s->transmitted = 0;
  s->eta_scale = 1.0f;
  s->pdf = specular ? 1.0f : layered_pdf(b, wo, w);
  return s->pdf > 0.0f && max4(weight) > 0.0f;
}

// Returns the albedo of a clear interface over the base: its reflectance, and the light that the
// base sends through it in all orders. The internal reflectance of diffuse light is that of Egan
// and Hilgeman (1973).
static inline float4 layered_albedo(const Bsdf* b, float3 wo) {
  const float eta = b->coat.eta;
  float cos_t;
  const float fresnel = fresnel_dielectric(fabs(wo.z), eta, &cos_t);
  if (base_is_metal(b))
    return fresnel + sqr(1.0f - fresnel) * fresnel_conductor(cos_t, b->eta, b->k);
  const float within =
      clamp(-1.440f / (eta * eta) + 0.710f / eta + 0.668f + 0.0636f * eta, 0.0f, 0.99f);
  return fresnel +
         (1.0f - fresnel) * b->reflectance * (1.0f - within) / (1.0f - within * b->reflectance);
}

#endif
