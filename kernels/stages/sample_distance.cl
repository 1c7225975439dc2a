// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Moves each ray to its hit through media: paths that are scattered on the way take one light
// sample and one of the phase function, and go on from there.
#include "lights/lights.cl"
#include "math/phase.cl"
#include "media/sample_distance.cl"
#include "stages/cone_share.cl"
#include "stages/media.cl"
#include "stages/path.cl"

// These are random numbers beside those of dimensions.def, for the distances of a path's rays.
#define MEDIUM_SAMPLE(depth) (0x40000000u + (depth))

static inline void sample_medium_light(const Stage* g, Outbox* out, const Scene* scene, uint path, float3 p, float3 direction, float asymmetry, MediumStack stack, int is_alone, float4 throughput,
                                       float4 wavelengths, uint u_select, float2 u) {
  LightSample light;
  const LightReceiver at = {p, CAPLET_NONE};
  if (!light_sample(scene, at, wavelengths, u_select, u, &light)) return;
  const float phase = phase_density(dot(direction, light.wi), asymmetry);
  const float4 contribution = throughput * light.radiance * (phase / light.pdf);
  if (!(max4(fabs(contribution)) > 0.0f)) return;
  set_shadow_medium_stack(g, path, stack, is_alone);
  g->medium_stacks.shadow_pdfs[path] = (float2)(light.pdf, light.delta ? 0.0f : path_pdf(g->view.view, phase));
  ShadowTarget target;
  g->shadows.path_shadow[path] = shadow_ray(&light, p, &target);
  g->shadows.path_shadow_target[path] = target;
  g->shadows.path_shadow_radiance[path] = contribution;
  append_shadow(g, out, path);
}

static void sending_item(const Stage* g, Outbox* out, uint item) {
  const uint path = g->queues.queue[item];
  const RayRecord ray = g->rays.path_ray[path];
  const HitRecord hit = g->rays.path_hit[path];
  const uint depth = g->carried.path_flags[path] >> PATH_DEPTH_SHIFT;
  MediumStack stack;
  MediumWeights weights;
  const int begins = depth == 0u && ray.t_min == 0.0f;
  if (begins) {
    const uint first = g->camera.camera->origins ? path : 0u;  // whose origin it has
    stack = path_medium_stack(g, first);
    if (path != first) set_path_medium_stack(g, path, stack);
    weights.scattering = weights.light = (float4)(1.0f);
    g->medium_stacks.path_ratio[path] = weights.scattering;
    g->medium_stacks.path_light_ratio[path] = weights.light;
    g->medium_stacks.path_within[path] = 0u;
  } else {
    stack = path_medium_stack(g, path);
    weights.scattering = g->medium_stacks.path_ratio[path];
    weights.light = g->medium_stacks.path_light_ratio[path];
  }
  const MediumStack here = medium_stack_before(&g->tree, &g->surfaces, &g->media, &hit, 1, stack);
  const uint medium = medium_stack_medium(&g->media, &here);
  if (medium == CAPLET_NONE || (g->view.view->strategy & CAPLET_STRATEGY_OCCLUSION) != 0u) return;

  const uint within = g->medium_stacks.path_within[path];
  const int is_within = medium_is_within(&g->media, medium);
  const int may_scatter = is_within || depth - within < g->view.view->max_depth;
  const PathSample at = path_sample(g->batch.batch, g->view.view, path);
  MediumNumbers numbers = {hash_combine(path_hash(at, depth) ^ 0x2c1b3c6du, as_uint(ray.t_min)), 0u};
  const float u = ray.t_min == 0.0f ? sampler_1d(at, MEDIUM_SAMPLE(depth)) : medium_number(&numbers);
  const float4 wavelengths = g->carried.path_wavelengths[path];
  const float3 o = (float3)(ray.ox, ray.oy, ray.oz), d = (float3)(ray.dx, ray.dy, ray.dz);
  weights.throughput = g->carried.path_throughput[path];
  float4 emitted = (float4)(0.0f);
  float t;
  const int end = medium_sample_distance(&g->media, &g->spectra, medium, wavelengths, o, d, ray.t_min, hit.t, may_scatter, u, &numbers, &weights, &emitted, &t);
  if (max4(fabs(emitted)) > 0.0f) g->radiance.path_radiance[path] += emitted;
  float4 throughput = weights.throughput;
  if (end == medium_passed) {
    g->carried.path_throughput[path] = throughput;
    g->medium_stacks.path_ratio[path] = weights.scattering;
    g->medium_stacks.path_light_ratio[path] = weights.light;
    return;
  }
  g->rays.path_hit[path].slot = CAPLET_SCATTERED;
  if (end == medium_ended) return;

  const float3 p = o + t * d;
  const float asymmetry = medium_g(g->media.mediums[medium].kind, g->media.media_data + g->media.mediums[medium].data);
  g->medium_stacks.path_ratio[path] = weights.scattering;
  g->medium_stacks.path_light_ratio[path] = weights.scattering;
  if (!begins) set_path_medium_stack(g, path, here);  // others may still ask what holds the first path
  // A point at either end may come to lie beyond the surface that is there.
  const float ends = 0x1p-20f * (max3(fabs(o)) + t * max3(fabs(d))) / length(d);
  const int is_alone = t - ray.t_min > ends && hit.t - t > ends;
  g->medium_stacks.path_near[path] = is_alone ? CAPLET_ALONE : CAPLET_RECOUNT;
  const Scene scene = {g->tree, g->surfaces, g->spectra, g->lights, g->materials};
  if (g->lights.lighting->sampled_light_count > 0 && (g->view.view->strategy & CAPLET_STRATEGY_NO_LIGHTS) == 0u)
    sample_medium_light(g, out, &scene, path, p, d, asymmetry, here, is_alone, throughput, wavelengths,
                        sampler_bits(at, SCATTERING_SAMPLE(choices, depth)),
                        sampler_2d(at, SCATTERING_SAMPLE(light, depth)));

  float4 scatter = g->carried.path_scatter[path];
  float pdf;
  const float3 wi = phase_sample(d, asymmetry, sampler_2d(at, SCATTERING_SAMPLE(bsdf, depth)), &pdf);
  scatter.x = path_pdf(g->view.view, pdf);
  scatter.z = as_float(CAPLET_NONE);
  if (!path_survives(at, depth, scatter.y, &throughput)) return;
  if (is_within) {
    if (!within_survives(within, within_number(path_hash(at, depth), within), &throughput)) return;
    g->medium_stacks.path_within[path] = within + 1u;
  }
  g->rays.path_ray[path] = path_onward(p, wi);
  g->carried.path_throughput[path] = throughput;
  g->carried.path_scatter[path] = scatter;
#ifdef CAPLET_LIGHT_TREE
  g->carried.path_normal[path] = CAPLET_NONE;
#endif
  g->carried.path_flags[path] = ((depth + 1) << PATH_DEPTH_SHIFT) | path_flag(g->view.view, 0);
  if (has_cones) {
    const float2 cone = g->cones.path_cone[path];
    g->cones.path_cone[path] = (float2)(fabs(cone.x + cone.y * t), cone.y);
  }
  media_goes_on(g, out, path, p, wi);
}

#include "stages/sending.cl"
