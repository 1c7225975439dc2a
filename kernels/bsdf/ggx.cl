// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Anisotropic GGX microfacets (Walter et al. 2007; Heitz 2014) are sampled by visible normals with
// spherical caps (Dupuy and Benyoub 2023). All directions are on the upper side: w.z >= 0, m.z > 0.
// alpha_u is the roughness along x, alpha_v along y.
#ifndef CAPLET_BSDF_GGX_CL
#define CAPLET_BSDF_GGX_CL

#include "math/vector.cl"

// Returns the density of microfacet normals m per solid angle; the integral of D(m) m.z is 1.
static inline float ggx_d(float3 m, float alpha_u, float alpha_v) {
  const float s = sqr(m.x / alpha_u) + sqr(m.y / alpha_v) + sqr(m.z);
  return 1.0f / (CAPLET_PI * alpha_u * alpha_v * s * s);
}

// Returns |w.z| (1 + 2 Lambda(w)): twice the projected area of the microsurface seen from w, less
// |w.z|. It is positive at grazing angles too.
static inline float ggx_stretched(float3 w, float alpha_u, float alpha_v) {
  return sqrt(sqr(alpha_u * w.x) + sqr(alpha_v * w.y) + sqr(w.z));
}

// Returns the density per solid angle of the normals m visible from wo (dot(wo, m) > 0) over
// dot(wo, m): G1(wo) D(m) / wo.z, finite at grazing.
static inline float ggx_visible_over_cos(float3 wo, float3 m, float alpha_u, float alpha_v) {
  return 2.0f * ggx_d(m, alpha_u, alpha_v) / (wo.z + ggx_stretched(wo, alpha_u, alpha_v));
}

// Returns G2(wo, wi) / G1(wo): the share of a visible normal's light that is left after masking
// towards wi. Masking is height-correlated Smith (Heitz 2014, 99): G2 = 1 / (1 + Lambda(wo) +
// Lambda(wi)).
static inline float ggx_masking(float3 wo, float3 wi, float alpha_u, float alpha_v) {
  const float zo = fabs(wo.z), zi = fabs(wi.z);
  const float so = ggx_stretched(wo, alpha_u, alpha_v), si = ggx_stretched(wi, alpha_u, alpha_v);
  return zi * (so + zo) / (zi * so + zo * si);
}

// Samples a normal visible from wo (wo.z > 0). u in [0, 1)^2.
static inline float3 ggx_sample_visible(float3 wo, float alpha_u, float alpha_v, float2 u) {
  const float3 w = normalize((float3)(alpha_u * wo.x, alpha_v * wo.y, wo.z));
  const float phi = 2.0f * CAPLET_PI * u.x;
  const float height = (1.0f - u.y) * (1.0f + w.z);  // of the cap's point above -w.z
  const float z = height - w.z;
  const float sin_theta = sqrt(clamp(1.0f - z * z, 0.0f, 1.0f));
  const float3 m = (float3)(sin_theta * cos(phi) + w.x, sin_theta * sin(phi) + w.y, height);
  return normalize((float3)(alpha_u * m.x, alpha_v * m.y, fmax(m.z, 1e-12f)));
}

#endif
