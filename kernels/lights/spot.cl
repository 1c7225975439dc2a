// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A spot light is a point light within a cone, with a smooth edge (pbrt-v4's).
#ifndef CAPLET_LIGHTS_SPOT_CL
#define CAPLET_LIGHTS_SPOT_CL

#include "lights/point.cl"

// Returns 3 t^2 - 2 t^3, where t is the cosine's place between the cone's edge and where the
// falloff starts; an edge without width is a step.
static inline float spot_falloff(float cosine, float cos_total, float cos_falloff_start) {
  if (cosine <= cos_total) return 0.0f;
  if (cosine >= cos_falloff_start) return 1.0f;
  const float t = (cosine - cos_total) / (cos_falloff_start - cos_total);
  return t * t * (3.0f - 2.0f * t);
}

static inline int spot_light_sample(const Scene* scene, __global const LightRecord* light, float3 p,
                                    float4 lambda, float2 u, LightSample* s) {
  (void)u;
  __global const float* data = light_data_of(&scene->lights, light);
  s->target = load3(spot_position(data));
  s->pdf = 1.0f;
  const float weight = point_weight(s->target, p, &s->wi);
  if (!(weight > 0.0f)) return 0;
  return lamp_shines(scene, light, lambda,
                     weight * spot_falloff(-dot(s->wi, load3(spot_axis(data))),
                                           spot_cos_total(data), spot_cos_falloff_start(data)),
                     s);
}

#endif
