// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is a luminaire as it was measured (ANSI/IES LM-63, type C): a point light whose intensity is
// linear between polar angles, from straight down (the light's -z) on, and between azimuths, from
// its +x towards its +y.
#ifndef CAPLET_LIGHTS_IES_CL
#define CAPLET_LIGHTS_IES_CL

#include "lights/environment.cl"
#include "lights/point.cl"

// Returns the cell of `angles` (at least two, ascending) that holds `angle`, and in *part how far
// into the cell it is.
static inline uint ies_cell(__global const float* angles, uint count, float angle, float* part) {
  const uint cell = cdf_cell(angles, count - 1u, angle);
  *part = clamp((angle - angles[cell]) / fmax(angles[cell + 1u] - angles[cell], 1e-9f), 0.0f, 1.0f);
  return cell;
}

static inline float ies_intensity(const Picture* profile, float3 w) {
  const uint polar_count = profile->height, azimuth_count = profile->width;
  __global const float *polar = floats_at(profile->texels, 0), *azimuths = polar + polar_count,
                       *values = azimuths + azimuth_count;
  const float theta = atan2(sqrt(w.x * w.x + w.y * w.y), -w.z);
  if (theta < polar[0] || theta > polar[polar_count - 1u]) return 0.0f;
  float down;
  const uint row = ies_cell(polar, polar_count, theta, &down);
  if (azimuth_count == 1u) return mix(values[row], values[row + 1u], down);
  float phi = atan2(w.y, w.x), around;
  if (phi < 0.0f) phi += 2.0f * CAPLET_PI;
  const uint column = ies_cell(azimuths, azimuth_count, phi, &around);
  __global const float *low = values + column * polar_count + row, *high = low + polar_count;
  return mix(mix(low[0], low[1], down), mix(high[0], high[1], down), around);
}

static inline int ies_light_sample(const Scene* scene, __global const LightRecord* light, float3 p,
                                   float4 lambda, float2 u, LightSample* s) {
  (void)u;
  __global const float* data = light_data_of(&scene->lights, light);
  float3 w;
  const float weight = lamp_weight(ies_position(data), ies_light_from_world(data), p, &w, s);
  if (!(weight > 0.0f)) return 0;
  const Picture profile = picture_of(&scene->lights, ies_profile(data));
  return lamp_shines(scene, light, lambda, weight * ies_intensity(&profile, w), s);
}

#endif
