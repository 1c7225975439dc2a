// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is a slide projector without a lens: a point light whose intensity is the colour of an
// image's nearest texel. The image stands upright around the z axis (Pharr, Jakob and Humphreys
// 2023, section 12.2.2).
#ifndef CAPLET_LIGHTS_PROJECTION_CL
#define CAPLET_LIGHTS_PROJECTION_CL

#include "lights/point.cl"

static inline int projection_light_sample(const Scene* scene, __global const LightRecord* light,
                                          float3 p, float4 lambda, float2 u, LightSample* s) {
  (void)u;
  __global const float* data = light_data_of(&scene->lights, light);
  float3 w;
  const float weight =
      lamp_weight(projection_position(data), projection_light_from_world(data), p, &w, s);
  if (!(weight > 0.0f) || !(w.z >= 1e-3f)) return 0;
  const float2 uv =
      0.5f + (float2)(w.x / w.z * projection_across(data), w.y / w.z * projection_down(data));
  if (!(uv.x >= 0.0f && uv.x <= 1.0f && uv.y >= 0.0f && uv.y <= 1.0f)) return 0;
  const Picture picture = picture_of(&scene->lights, projection_picture(data));
  const float4 texel = picture_texel(&picture, picture_nearest(&picture, uv));
  if (!(texel.w > 0.0f)) return 0;
  s->radiance = sigmoid_illuminant(picture_illuminant(&scene->spectra, light), texel, lambda) *
                (light->scale * weight);
  return 1;
}

#endif
