// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Spot light: a point light within a cone, with a smooth edge (pbrt-v4's).
#ifndef CAPLET_LIGHTS_SPOT_CL
#define CAPLET_LIGHTS_SPOT_CL

#include "lights/point.cl"

// 3 t^2 - 2 t^3 of the cosine's place between the cone's edge and where the falloff starts; an edge without width is a step.
static inline float spot_falloff(float cosine, float cos_total, float cos_falloff_start) {
  if (cosine <= cos_total) return 0.0f;
  if (cosine >= cos_falloff_start) return 1.0f;
  const float t = (cosine - cos_total) / (cos_falloff_start - cos_total);
  return t * t * (3.0f - 2.0f * t);
}

// `data`: position, axis, cos_total, cos_falloff_start. As point_sample.
static inline float spot_sample(__global const float* data, float3 p, float3* wi) {
  const float weight = point_sample(data, p, wi);
  return weight > 0.0f ? weight * spot_falloff(-dot(*wi, load3(data + 3)), data[6], data[7]) : 0.0f;
}

#endif
