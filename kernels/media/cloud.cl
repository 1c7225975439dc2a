// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This medium is a cloud of noise, thinner upwards along y of its space (Pharr, Jakob and Humphreys
// 2023, 11.4.4, as pbrt-v4 has it).
#ifndef CAPLET_MEDIA_CLOUD_CL
#define CAPLET_MEDIA_CLOUD_CL

#include "media/media_types.cl"
#include "textures/noise.cl"

static inline MediumBox cloud_medium_box(const MediumView* m) {
  MediumBox box;
  box.place = cloud_medium_place(m->data);
  box.majorants = floats_from(m->grids, cloud_medium_majorants(m->data));
  box.size = 1;
  box.extinction = cloud_medium_scale(m->data) *
                   (spectrum_eval(m->spectra, cloud_medium_sigma_a(m->data), m->lambda) +
                    spectrum_eval(m->spectra, cloud_medium_sigma_s(m->data), m->lambda));
  return box;
}

// Returns the gradient of the noise, by differences.
static inline float3 cloud_slope(float3 p) {
  const float step = 0.01f, here = noise_at(p);
  return ((float3)(noise_at(p + (float3)(step, 0.0f, 0.0f)),
                   noise_at(p + (float3)(0.0f, step, 0.0f)),
                   noise_at(p + (float3)(0.0f, 0.0f, step))) -
          here) /
         step;
}

// Returns the density, from 0 to 1, at a point of the medium's space.
static inline float cloud_density(__global const float* data, float3 p) {
  const float wispiness = cloud_medium_wispiness(data);
  float3 at = cloud_medium_frequency(data) * p;
  if (wispiness > 0.0f) {
    float high = 0.05f * wispiness, fine = 10.0f;
    for (int i = 0; i < 2; ++i) {
      at += high * cloud_slope(fine * at);
      high *= 0.5f;
      fine *= 1.99f;
    }
  }
  float sum = 0.0f, high = 0.5f, fine = 1.0f;
  for (int i = 0; i < 5; ++i) {
    sum += high * noise_at(fine * at);
    high *= 0.5f;
    fine *= 1.99f;
  }
  const float above = clamp((1.0f - p.y) * 4.5f * cloud_medium_density(data) * sum, 0.0f, 1.0f);
  return clamp(above + 2.0f * fmax(0.0f, 0.5f - p.y), 0.0f, 1.0f);
}

static inline MediumPoint cloud_medium_at(const MediumView* m, float3 p, float3 q) {
  (void)p;
  __global const float* data = m->data;
  const float density =
      cloud_medium_scale(data) *
      cloud_density(data, load3(cloud_medium_low(data)) + q * load3(cloud_medium_sides(data)));
  MediumPoint at;
  at.sigma_a = density * spectrum_eval(m->spectra, cloud_medium_sigma_a(data), m->lambda);
  at.sigma_s = density * spectrum_eval(m->spectra, cloud_medium_sigma_s(data), m->lambda);
  at.le = (float4)(0.0f);
  return at;
}

#endif
