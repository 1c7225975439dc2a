// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// These are area lights whose radiance varies by an image over uv, and those of shapes that let
// rays through: where a ray is stopped with a probability (alpha), light arrives with that
// probability. They are sampled as `area` is.
#ifndef CAPLET_LIGHTS_TEXTURED_AREA_CL
#define CAPLET_LIGHTS_TEXTURED_AREA_CL

#include "lights/area.cl"
#include "textures/textures.cl"

// The image's bottom row is at v = 0; beyond its edges the edge texels continue.
static inline float4 textured_area_light_emitted(const Spectra* spectra, const Lights* lights,
                                                 __global const LightRecord* light, float2 uv,
                                                 float4 lambda) {
  const Picture picture = picture_of(lights, textured_area_picture(light_data_of(lights, light)));
  if (picture.width == 0u) return light_spectrum(spectra, light, lambda, 1.0f);
  const float2 size = (float2)((float)picture.width, (float)picture.height);
  const float2 at = clamp((float2)(uv.x, 1.0f - uv.y), 0.0f, 1.0f) * size - 0.5f;
  const float2 low = floor(at), t = at - low;
  const int width = (int)picture.width, height = (int)picture.height;
  const int x0 = clamp((int)low.x, 0, width - 1), x1 = clamp((int)low.x + 1, 0, width - 1);
  const size_t top = (size_t)clamp((int)low.y, 0, height - 1) * picture.width,
               bottom = (size_t)clamp((int)low.y + 1, 0, height - 1) * picture.width;
  __global const float* illuminant = picture_illuminant(spectra, light);
  const float4 r00 = sigmoid_illuminant(illuminant, picture_texel(&picture, top + x0), lambda);
  const float4 r10 = sigmoid_illuminant(illuminant, picture_texel(&picture, top + x1), lambda);
  const float4 r01 = sigmoid_illuminant(illuminant, picture_texel(&picture, bottom + x0), lambda);
  const float4 r11 = sigmoid_illuminant(illuminant, picture_texel(&picture, bottom + x1), lambda);
  return mix(mix(r00, r10, t.x), mix(r01, r11, t.x), t.y) * light->scale;
}

static inline int textured_area_light_sample(const Scene* scene, __global const LightRecord* light,
                                             float3 p, float4 lambda, float2 u, LightSample* s) {
  AreaSample point;
  if (!area_sample_towards(scene, light, p, u, &point, s)) return 0;
  const float3 d = point.p - p;
  const RayRecord ray = {p.x, p.y, p.z, 0.0f, d.x, d.y, d.z, INFINITY};
  const HitRecord hit = {1.0f, light->slot, light->instance, point.surface};
  const Surface found = surface_at(&scene->tree, &scene->surfaces, &ray, &hit);
  const uint alpha = scene->surfaces.geometries[light->geometry].alpha;
  float stopped = 1.0f;
  // In pbrt-v4 a light that no ray stops at shines as if it were there.
  if (light->flags & CAPLET_LIGHT_UNSEEN) {
    s->delta = 1;
    s->slot = CAPLET_NONE;
  } else if (alpha != CAPLET_NONE)
    stopped = alpha_chance(&scene->materials, &scene->spectra, alpha, found.uv, found.p, found.ng);
  if (!(stopped > 0.0f)) return 0;
  s->radiance =
      textured_area_light_emitted(&scene->spectra, &scene->lights, light, found.uv, lambda) *
      stopped;
  return max4(s->radiance) > 0.0f;
}

static inline float textured_area_light_pdf(const Scene* scene, __global const LightRecord* light,
                                            float3 p, const Surface* hit, float3 wi) {
  __global const GeometryRecord* geometry = scene->surfaces.geometries + light->geometry;
  const int is_ball = area_ball(&scene->lights, light) != 0;
  const int by_area = geometry->shape == shape_triangle || geometry->shape == shape_disk ||
                      geometry->shape == shape_cylinder;
  if (geometry->alpha != CAPLET_NONE && (is_ball || !by_area)) {
    // Light from behind a hole of the primitive's own is not sampled.
    HitRecord first;
    const float3 away = hit->p - p;
    const float distance = sqrt(dot(away, away));
    if (primitive_crossing(&scene->tree, &scene->surfaces, light->slot, light->instance, p, wi,
                           0.0f, &first) &&
        first.t < distance * (1.0f - 1e-4f) - hit->error)
      return 0.0f;
  }
  return area_pdf(scene, light, p, hit->p, hit->ng, wi);
}

#endif
