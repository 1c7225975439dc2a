// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This BSDF is a fibre that scatters by its whole cross-section (Chiang, Bitterli, Tappan and
// Burley 2016; Marschner et al. 2003; d'Eon et al. 2011): light is reflected, goes through, or
// leaves after one or more internal reflections. wo.z > 0 (bsdf.cl mirrors the frame).
//
// The fibre lies along y of the local frame. dp/dv of capsules, cylinders and cones points along
// it, and so does dp/du of chains (bsdf_tangent). The offset of the ray from the axis, over the
// radius, is the sine of the angle between the normal and wo across the fibre, so no coordinate of
// the shape is needed.
#ifndef CAPLET_BSDF_HAIR_CL
#define CAPLET_BSDF_HAIR_CL

#include "bsdf/bsdf_types.cl"
#include "bsdf/fresnel.cl"

#define HAIR_LOBES 4  // the last: all orders from three on
#define HAIR_ROUGHNESS_MIN 0.01f

static inline void hair_make(const MaterialPoint* m, Bsdf* b) {
  b->eta = (float4)(clamp(material_number(m, hair_at_eta), 1.0f, 10.0f));
  b->alpha_u = clamp(material_number(m, hair_at_beta_m), HAIR_ROUGHNESS_MIN, 1.0f);
  b->alpha_v = clamp(material_number(m, hair_at_beta_n), HAIR_ROUGHNESS_MIN, 1.0f);
  b->hair_tilt = material_signed(m, hair_at_alpha) * (CAPLET_PI / 180.0f);
  if (hair_is_color(m->data) != 0.0f) {
    // The absorption gives this colour after many fibres: it is the fit of Chiang et al. 2016,
    // equation 9.
    const float n = b->alpha_v, n2 = n * n;
    const float fit = 5.969f - 0.215f * n + 2.532f * n2 - 10.73f * n * n2 + 5.574f * n2 * n2 +
                      0.245f * n * n2 * n2;
    const float4 root = log(clamp(material_albedo(m, hair_at_pigment), 1e-5f, 1.0f)) / fit;
    b->k = root * root;
  } else {
    b->k = material_spectrum(m, hair_at_pigment);
  }
}

static inline int hair_is_specular(const Bsdf* b) {
  (void)b;
  return 0;
}

// HairLobes holds, for a direction wo, the values of each lobe that are the same for all wi.
typedef struct {
  float4 share[HAIR_LOBES];  // of the light
  float probability[HAIR_LOBES];
  float variance[HAIR_LOBES];                  // along the fibre
  float sin_o[HAIR_LOBES], cos_o[HAIR_LOBES];  // of wo's inclination, turned by the scales
  float turn[HAIR_LOBES - 1];                  // azimuth from wo
  float width;                                 // of the logistic distribution around it
} HairLobes;

static inline float hair_azimuth(float3 w) { return atan2(w.z, -w.x); }

static inline HairLobes hair_lobes(const Bsdf* b, float3 wo) {
  HairLobes lobes;
  const float sin_o = clamp(wo.y, -1.0f, 1.0f), cos_o = sqrt(fmax(0.0f, 1.0f - sin_o * sin_o));
  const float across = sqrt(wo.x * wo.x + wo.z * wo.z);
  const float h = across > 0.0f ? clamp(wo.x / across, -1.0f, 1.0f) : 0.0f;
  const float eta = b->eta.x;

  const float m = b->alpha_u, m2 = m * m, n = b->alpha_v, n2 = n * n;
  const float root = 0.726f * m + 0.812f * m2 + 3.7f * pow(m, 20.0f);
  lobes.variance[0] = root * root;
  lobes.variance[1] = 0.25f * lobes.variance[0];
  lobes.variance[2] = lobes.variance[3] = 4.0f * lobes.variance[0];
  lobes.width = 0.626657069f * (0.265f * n + 1.194f * n2 + 5.372f * pow(n, 22.0f));  // sqrt(pi / 8)

  // `index` is that of the cross-section (Bravais); `through` is the transmittance of the path
  // inside it.
  const float index = sqrt(fmax(eta * eta - sin_o * sin_o, 0.0f)) / fmax(cos_o, 1e-6f);
  const float gamma_o = asin(h), sin_t = clamp(h / index, -1.0f, 1.0f), gamma_t = asin(sin_t);
  const float inclined = sqrt(fmax(0.0f, 1.0f - sqr(sin_o / eta)));
  const float4 through = exp(-b->k * (2.0f * sqrt(1.0f - sin_t * sin_t) / fmax(inclined, 1e-6f)));
  float cos_beyond;
  const float fresnel =
      fresnel_dielectric(cos_o * sqrt(fmax(0.0f, 1.0f - h * h)), eta, &cos_beyond);
  lobes.share[0] = (float4)(fresnel);
  lobes.share[1] = sqr(1.0f - fresnel) * through;
  lobes.share[2] = lobes.share[1] * through * fresnel;
  lobes.share[3] = lobes.share[2] * through * fresnel / fmax(1.0f - through * fresnel, 1e-6f);
  const float sum = mean4(lobes.share[0] + lobes.share[1] + lobes.share[2] + lobes.share[3]);

  const float turns[HAIR_LOBES] = {2.0f * b->hair_tilt, -b->hair_tilt, -4.0f * b->hair_tilt, 0.0f};
  for (int p = 0; p < HAIR_LOBES; ++p) {
    const float s = sin(turns[p]), c = cos(turns[p]);
    lobes.sin_o[p] = sin_o * c - cos_o * s;
    lobes.cos_o[p] = fabs(cos_o * c + sin_o * s);
    lobes.probability[p] = sum > 0.0f ? mean4(lobes.share[p]) / sum : 0.25f;
  }
  for (int p = 0; p < HAIR_LOBES - 1; ++p)
    lobes.turn[p] = 2.0f * (float)p * gamma_t - 2.0f * gamma_o + (float)p * CAPLET_PI;
  return lobes;
}

// Returns the log of the modified Bessel function of order 0 (Abramowitz and Stegun 9.8.1, 9.8.2).
// x >= 0.
static inline float log_bessel(float x) {
  if (x < 3.75f) {
    const float t = sqr(x / 3.75f);
    return log(1.0f +
               t * (3.5156229f +
                    t * (3.0899424f +
                         t * (1.2067492f + t * (0.2659732f + t * (0.0360768f + t * 0.0045813f))))));
  }
  const float t = 3.75f / x;
  const float p =
      0.39894228f +
      t * (0.01328592f +
           t * (0.00225319f +
                t * (-0.00157565f +
                     t * (0.00916281f +
                          t * (-0.02057706f +
                               t * (0.02635537f + t * (-0.01647633f + t * 0.00392377f)))))));
  return x + log(p) - 0.5f * log(x);
}

// Returns the longitudinal density (d'Eon et al. 2011, equation 7) of wi's inclination, which peaks
// at minus the inclination of wo.
static inline float hair_longitudinal(float sin_i, float cos_i, float sin_o, float cos_o,
                                      float variance) {
  const float inverse = 1.0f / variance;
  return exp(log_bessel(cos_i * cos_o * inverse) - (sin_i * sin_o + 1.0f) * inverse) /
         (variance * (1.0f - exp(-2.0f * inverse)));
}

// The azimuthal density is a logistic distribution over [-pi, pi].
static inline float hair_logistic_end(float width) {
  return 1.0f / (1.0f + exp(CAPLET_PI / width));
}
static inline float hair_azimuthal(float angle, float width) {
  angle -= 2.0f * CAPLET_PI * floor(angle / (2.0f * CAPLET_PI) + 0.5f);
  const float e = exp(-fabs(angle) / width);
  return e / (width * sqr(1.0f + e) * (1.0f - 2.0f * hair_logistic_end(width)));
}

// Returns f |cos wi| and its density.
static inline float4 hair_value(const HairLobes* lobes, float3 wo, float3 wi, float* pdf) {
  const float sin_i = clamp(wi.y, -1.0f, 1.0f), cos_i = sqrt(fmax(0.0f, 1.0f - sin_i * sin_i));
  const float azimuth = hair_azimuth(wi) - hair_azimuth(wo);
  float4 sum = (float4)(0.0f);
  *pdf = 0.0f;
  for (int p = 0; p < HAIR_LOBES; ++p) {
    const float around = p < HAIR_LOBES - 1 ? hair_azimuthal(azimuth - lobes->turn[p], lobes->width)
                                            : 0.5f * CAPLET_INV_PI;
    const float density = around * hair_longitudinal(sin_i, cos_i, lobes->sin_o[p], lobes->cos_o[p],
                                                     lobes->variance[p]);
    sum += density * lobes->share[p];
    *pdf += density * lobes->probability[p];
  }
  return sum;
}

static inline float4 hair_eval(const Bsdf* b, int inside, float3 wo, float3 wi, float* pdf) {
  (void)inside;
  const HairLobes lobes = hair_lobes(b, wo);
  return hair_value(&lobes, wo, wi, pdf);
}

static inline int hair_sample(const Bsdf* b, int inside, int smooth, float3 wo, float u_component,
                              float2 u, BsdfSample* s) {
  (void)inside, (void)smooth;
  const HairLobes lobes = hair_lobes(b, wo);
  int p = 0;
  float before = 0.0f;
  while (p < HAIR_LOBES - 1 && u_component >= before + lobes.probability[p])
    before += lobes.probability[p++];
  const float chosen =
      clamp((u_component - before) / fmax(lobes.probability[p], 1e-12f), 1e-6f, 1.0f - 1e-6f);

  const float v = lobes.variance[p];
  const float along =
      clamp(1.0f + v * log(fmax(u.x, 1e-7f) + (1.0f - u.x) * exp(-2.0f / v)), -1.0f, 1.0f);
  const float beside = sqrt(fmax(0.0f, 1.0f - along * along)) * cos(2.0f * CAPLET_PI * u.y);
  const float sin_i = clamp(-along * lobes.sin_o[p] + beside * lobes.cos_o[p], -1.0f, 1.0f);
  const float cos_i = sqrt(fmax(0.0f, 1.0f - sin_i * sin_i));
  float azimuth = hair_azimuth(wo);
  if (p < HAIR_LOBES - 1) {
    const float end = hair_logistic_end(lobes.width);
    const float x = -lobes.width * log(1.0f / (chosen * (1.0f - 2.0f * end) + end) - 1.0f);
    azimuth += lobes.turn[p] + clamp(x, -CAPLET_PI, CAPLET_PI);
  } else {
    azimuth += 2.0f * CAPLET_PI * chosen;
  }
  s->wi = normalize((float3)(-cos_i * cos(azimuth), sin_i, cos_i * sin(azimuth)));
  const float4 value = hair_value(&lobes, wo, s->wi, &s->pdf);
  s->weight = value / s->pdf;
  s->specular = 0;
  s->transmitted = s->wi.z < 0.0f;
  s->eta_scale = 1.0f;
  return s->pdf > 0.0f && !isinf(s->pdf) && s->wi.z != 0.0f;
}

static inline float4 hair_directional_albedo(const Bsdf* b, float3 wo) {
  if (wo.z < 0.0f) wo.z = -wo.z;
  const HairLobes lobes = hair_lobes(b, wo);
  return fmin(lobes.share[0] + lobes.share[1] + lobes.share[2] + lobes.share[3], 1.0f);
}

#endif
