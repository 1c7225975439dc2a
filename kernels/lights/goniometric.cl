// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is a point light whose intensity in each direction is that of an image's nearest texel, by
// the equal-area octahedral map (Pharr, Jakob and Humphreys 2023, section 12.2.3).
#ifndef CAPLET_LIGHTS_GONIOMETRIC_CL
#define CAPLET_LIGHTS_GONIOMETRIC_CL

#include "lights/environment.cl"
#include "lights/point.cl"

static inline int goniometric_light_sample(const Scene* scene, __global const LightRecord* light,
                                           float3 p, float4 lambda, float2 u, LightSample* s) {
  (void)u;
  __global const float* data = light_data_of(&scene->lights, light);
  float3 w;
  const float weight =
      lamp_weight(goniometric_position(data), goniometric_light_from_world(data), p, &w, s);
  if (!(weight > 0.0f)) return 0;
  const Picture picture = picture_of(&scene->lights, goniometric_picture(data));
  return lamp_shines(
      scene, light, lambda,
      weight * *floats_at(picture.texels, picture_nearest(&picture, sphere_to_square(w))), s);
}

#endif
