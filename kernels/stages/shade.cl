// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What a ray hit: emission and environment weighted against light sampling (Veach 1997, chapter 9), then one light sample,
// one BSDF sample and Russian roulette. Fills queue_shadow and queue_next.
#include "globals.cl"
#include "math/vector.cl"
#include "math/spectrum.cl"
#include "shapes/surface.cl"
#include "bsdf/bsdf.cl"
#include "lights/lights.cl"
#include "stages/path.cl"
#include "stages/sort_key.cl"

// First-hit layers of the film.
static inline void store_first_hit(const Globals* g, uint path, const Surface* s, const Bsdf* bsdf, float3 wo_local, float3 wo,
                                   float depth, float4 wavelengths, float4 pdfs, uint instance) {
  const float3 normal = dot(s->ns, wo) < 0.0f ? -s->ns : s->ns;
  uint object = g->geometries[s->geometry].object;
  if (instance != CAPLET_NONE && g->instances[instance].object != CAPLET_NONE) object = g->instances[instance].object;
  const uint primitive = s->primitive - g->geometries[s->geometry].primitive_begin;
  // Under the white of the film's colour space, whatever lights there are: a white surface has albedo 1 1 1.
  const float4 white = spectrum_table_at4(g->spectrum_tables + g->params->illuminant_table, wavelengths);
  const float3 xyz = xyz_from_spectrum(g, bsdf_albedo(bsdf, wo_local) * white, wavelengths, pdfs);
  vstore4((float4)(xyz.x, xyz.y, xyz.z, depth), path, g->path_albedo);
  vstore4((float4)(normal.x, normal.y, normal.z, as_float(object)), path, g->path_normal);
  vstore4((float4)(s->p.x, s->p.y, s->p.z, as_float(primitive)), path, g->path_position);
}

// One light sample: its unoccluded contribution waits in path_shadow_radiance for `connect`.
static inline void sample_light(const Globals* g, uint path, const Surface* s, const Frame* frame, const Bsdf* bsdf, float3 wo_local,
                                float3 wo, float4 throughput, float4 wavelengths, uint u_select, float2 u) {
  LightSample light;
  // From the side that wo is on, as the density of a reflected ray that meets the light is: within an emitting solid it matters.
  if (!light_sample(g, offset_origin(s->p, s->ng, s->error, wo), wavelengths, u_select, u, &light)) return;
  const float3 wi_local = to_local(frame, light.wi);
  // Shading normals must not let light through what is geometrically opaque, nor reflect it into the surface.
  const int transmitted = wi_local.z * wo_local.z < 0.0f;
  const int crosses = dot(light.wi, s->ng) * dot(wo, s->ng) < 0.0f;
  if (transmitted != crosses) return;
  // A refracted ray sees its own primitive from the other side than this sample did: it alone finds that light.
  if (transmitted && light.index == s->primitive_light) return;
  float bsdf_pdf;
  const float4 f = bsdf_eval(bsdf, wo_local, wi_local, &bsdf_pdf);
  const float weight = light.delta ? 1.0f : power_heuristic(light.pdf, bsdf_pdf);
  const float4 contribution = throughput * f * light.radiance * (weight / light.pdf);
  if (!(max4(fabs(contribution)) > 0.0f)) return;  // the filter's weight may be negative
  RayRecord ray;
  const float3 origin = offset_origin(s->p, s->ng, s->error, light.wi);
  const float3 direction = light.infinite ? light.wi : light.target - origin;
  ray.ox = origin.x; ray.oy = origin.y; ray.oz = origin.z; ray.t_min = 0.0f;
  ray.dx = direction.x; ray.dy = direction.y; ray.dz = direction.z; ray.t_max = light.infinite ? INFINITY : 1.0f;
  g->path_shadow[path] = ray;
  vstore4(contribution, path, g->path_shadow_radiance);
  g->queue_shadow[atomic_inc(&g->counters[COUNTER_SHADOW])] = path;
}

#define STAGE_NAME shade
static void stage_item(const Globals* g, uint item) {
  const uint path = g->queue[item];
  const RayRecord ray = g->path_ray[path];
  const HitRecord hit = g->path_hit[path];
  float4 throughput = vload4(path, g->path_throughput);
  const float4 wavelengths = vload4(path, g->path_wavelengths);
  float4 pdfs = vload4(path, g->path_wavelength_pdfs);
  float4 scatter = vload4(path, g->path_scatter);  // last pdf, eta scale, bits of the light that was crossed
  const uint flags = g->path_flags[path];
  const uint depth = flags >> PATH_DEPTH_SHIFT;
  const int specular = (flags & PATH_SPECULAR) != 0;
  const float3 direction = (float3)(ray.dx, ray.dy, ray.dz);

  if (hit.slot == CAPLET_NONE) {
    const float4 sky = light_infinite(g, direction, wavelengths, scatter.x, specular);
    vstore4(vload4(path, g->path_radiance) + throughput * sky, path, g->path_radiance);
    return;
  }

  const Surface s = surface_at(g, &ray, &hit);
  const float3 wo = -direction;
  if (s.light != CAPLET_NONE) {
    const float4 emitted = light_emitted(g, s.light, s.ng, wo, wavelengths);
    if (max4(emitted) > 0.0f) {
      float weight = 1.0f;
      // What a refracted ray finds of the primitive that it crossed has no other strategy.
      if (!specular && as_uint(scatter.z) != s.light)
        weight = power_heuristic(scatter.x, light_area_pdf(g, s.light, (float3)(ray.ox, ray.oy, ray.oz), &s, direction));
      vstore4(vload4(path, g->path_radiance) + throughput * emitted * weight, path, g->path_radiance);
    }
  }

  const Frame frame = frame_from_tangent(s.ns, s.dpdu);
  const float3 wo_local = to_local(&frame, wo);
  const Bsdf bsdf = bsdf_make(g, s.material, wavelengths);
  if (depth == 0) store_first_hit(g, path, &s, &bsdf, wo_local, wo, hit.t, wavelengths, pdfs, hit.instance);
  if (depth >= g->params->max_depth) return;
  if (bsdf_is_dispersive(&bsdf) && pdfs.y > 0.0f) {
    // A direction that depends on wavelength belongs to the hero wavelength alone: the others end here, whatever comes of the samples.
    pdfs = (float4)(pdfs.x * 0.25f, 0.0f, 0.0f, 0.0f);
    throughput = (float4)(throughput.x, 0.0f, 0.0f, 0.0f);
    vstore4(pdfs, path, g->path_wavelength_pdfs);
  }

  const PathSample at = path_sample(g, path);
  const float2 choices = sampler_2d(at.seed, at.sample, SAMPLE_CHOICES(depth));
  if (g->params->sampled_light_count > 0 && !bsdf_is_specular(&bsdf))
    sample_light(g, path, &s, &frame, &bsdf, wo_local, wo, throughput, wavelengths,
                 sampler_bits(at.seed, at.sample, SAMPLE_CHOICES(depth)), sampler_2d(at.seed, at.sample, SAMPLE_LIGHT(depth)));

  BsdfSample sample;
  if (!bsdf_sample(&bsdf, wo_local, choices.y, sampler_2d(at.seed, at.sample, SAMPLE_BSDF(depth)), &sample)) return;
  const float3 wi = to_world(&frame, sample.wi);
  if (sample.transmitted != (dot(wi, s.ng) * dot(wo, s.ng) < 0.0f)) return;
  throughput *= sample.weight;
  scatter.x = sample.pdf;
  scatter.y *= sample.eta_scale;
  scatter.z = as_float(sample.transmitted ? s.primitive_light : CAPLET_NONE);

  // The square root keeps paths longer than their throughput alone would, and the first three scatterings always go on: variance falls
  // faster than time grows (docs/performance.md).
  const float survival = fmin(1.0f, sqrt(max4(fabs(throughput)) * scatter.y));
  if (depth >= 3 && survival < 1.0f) {
    if (sampler_1d(at.seed, at.sample, SAMPLE_ROULETTE(depth)) >= survival) return;
    throughput /= survival;
  }
  if (!(max4(fabs(throughput)) > 0.0f)) return;

  const float3 origin = offset_origin(s.p, s.ng, s.error, wi);
  RayRecord next;
  next.ox = origin.x; next.oy = origin.y; next.oz = origin.z; next.t_min = 0.0f;
  next.dx = wi.x; next.dy = wi.y; next.dz = wi.z; next.t_max = INFINITY;
  g->path_ray[path] = next;
  vstore4(throughput, path, g->path_throughput);
  vstore4(scatter, path, g->path_scatter);
  g->path_flags[path] = ((depth + 1) << PATH_DEPTH_SHIFT) | (sample.specular ? PATH_SPECULAR : 0u);
  const uint position = atomic_inc(&g->counters[COUNTER_NEXT]);
  g->queue_next[position] = path;
  if (g->params->sort_bits == CAPLET_NONE) return;
  const uint key = sort_key(g->params, origin, wi);
  g->sort_keys[position] = key;
  atomic_inc(&g->sort_bins[key]);
}
#include "stages/kernel.cl"
