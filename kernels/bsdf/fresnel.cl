// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes Fresnel reflectances of unpolarised light (Born and Wolf, Principles of Optics, 1.5 and
// 14.2).
#ifndef CAPLET_BSDF_FRESNEL_CL
#define CAPLET_BSDF_FRESNEL_CL

#include "math/vector.cl"

// Returns the reflectance of a dielectric interface. cos_i >= 0 on the side the light is on; eta:
// index of the other side over this side's. *cos_t: cosine beyond the interface, 0 under total
// internal reflection.
static inline float fresnel_dielectric(float cos_i, float eta, float* cos_t) {
  cos_i = clamp(cos_i, 0.0f, 1.0f);
  const float sin2_t = (1.0f - cos_i * cos_i) / (eta * eta);
  if (!(sin2_t < 1.0f)) {
    *cos_t = 0.0f;
    return 1.0f;
  }
  const float c = sqrt(1.0f - sin2_t);
  *cos_t = c;
  const float parallel = (eta * cos_i - c) / (eta * cos_i + c);
  const float perpendicular = (cos_i - eta * c) / (cos_i + eta * c);
  return fmin(1.0f, 0.5f * (parallel * parallel + perpendicular * perpendicular));
}

// Returns the reflectance of a metal of complex index eta + i k seen from vacuum. cos_i >= 0.
static inline float4 fresnel_conductor(float cos_i, float4 eta, float4 k) {
  const float c = clamp(cos_i, 0.0f, 1.0f);
  const float c2 = c * c, s2 = 1.0f - c2;
  const float4 e = eta * eta - k * k - s2;
  const float4 squared = sqrt(
      e * e + 4.0f * eta * eta * k * k);  // a^2 + b^2, where a + i b = sqrt((eta + i k)^2 - sin^2)
  const float4 a = sqrt(fmax(0.5f * (squared + e), 0.0f));
  // The ratios below are 0/0 only at grazing incidence (reflectance 1) or where the other
  // polarisation determines the value.
  const float4 t1 = squared + c2, t2 = 2.0f * c * a;
  const float4 rs =
      select((float4)(1.0f), (t1 - t2) / (t1 + t2), isgreater(t1 + t2, (float4)(0.0f)));
  const float4 t3 = c2 * squared + s2 * s2, t4 = t2 * s2;
  const float4 ratio =
      select((float4)(1.0f), (t3 - t4) / (t3 + t4), isgreater(t3 + t4, (float4)(0.0f)));
  return clamp(0.5f * (rs + rs * ratio), 0.0f, 1.0f);
}

#endif
