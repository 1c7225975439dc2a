// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Lights at infinity that rays meet: constant (found by BSDF sampling alone) and image (sampled, and weighted against it).
#ifndef CAPLET_LIGHTS_INFINITE_CL
#define CAPLET_LIGHTS_INFINITE_CL

#include "lights/environment.cl"
#include "math/spectrum.cl"

static inline float4 image_texels(const Spectra* spectra, const Lights* lights, __global const LightRecord* light, float2 uv, float4 lambda) {
  return environment_radiance(lights, spectra->spectrum_tables + spectra->spectra[light->spectrum].table, uv, lambda) * light->scale;
}

// `data`: light_from_world. Direction, radiance and solid-angle density (returned; 0: nothing) of a sample of the image light.
static inline float image_sample(const Spectra* spectra, const Lights* lights, __global const LightRecord* light, float4 lambda, float2 u, float3* wi,
                                 float4* radiance) {
  __global const float* m = lights->light_data + light->data;
  float3 d;
  float2 uv;
  const float pdf = environment_sample(lights, u, &d, &uv);
  if (!(pdf > 0.0f)) return 0.0f;
  // A rotation's inverse is its transpose.
  *wi = normalize(load3(m) * d.x + load3(m + 3) * d.y + load3(m + 6) * d.z);
  *radiance = image_texels(spectra, lights, light, uv, lambda);
  return pdf;
}

// Radiance from direction wi (world), and the density that image_sample has for it.
static inline float4 image_radiance(const Spectra* spectra, const Lights* lights, __global const LightRecord* light, float3 wi, float4 lambda, float* pdf) {
  __global const float* m = lights->light_data + light->data;
  const float3 d = (float3)(dot(load3(m), wi), dot(load3(m + 3), wi), dot(load3(m + 6), wi));
  const float2 uv = environment_locate(lights, d, pdf);
  return image_texels(spectra, lights, light, uv, lambda);
}

// Sum over infinite lights of radiance times MIS weight, for a ray of direction wi (unit) that left the scene. bsdf_pdf:
// solid-angle density that the ray was made with; `specular`: no light sample could have made it (also camera rays).
static inline float4 light_infinite(const Spectra* spectra, const Lights* lights, float3 wi, float4 lambda, float bsdf_pdf, int specular) {
  float4 sum = (float4)(0.0f);
  for (uint i = lights->lighting->infinite_begin; i < lights->lighting->light_count; ++i) {
    __global const LightRecord* light = lights->lights + i;
    if (light->kind == light_image) {
      float pdf;
      const float4 radiance = image_radiance(spectra, lights, light, wi, lambda, &pdf);
      pdf *= lights->lighting->sampled_light_count > 0u ? lights->light_alias[i].probability : 0.0f;
      sum += radiance * (specular ? 1.0f : power_heuristic(bsdf_pdf, pdf));
    } else {
      sum += spectrum_eval(spectra, light->spectrum, lambda) * light->scale;
    }
  }
  return sum;
}

#endif
