// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Moves each ray to its hit through media: paths that are scattered on the way take one light
// sample and one of the phase function, and go on from there.
#include "lights/lights.cl"
#include "math/phase.cl"
#include "media/sample_distance.cl"
#include "stages/media.cl"
#include "stages/times.cl"

// A point of a medium where a path is scattered.
typedef struct {
  float3 p, direction;  // of the path
  float asymmetry;      // of the phase function
  MediumStack stack;
  int is_alone;  // no surface is near
} ScatteringPoint;

// Returns the stack of the path's media where its ray begins, and the weights of its wavelengths.
static inline MediumStack load_media(const Stage* g, uint path, int begins,
                                     MediumWeights* weights) {
  if (!begins) {
    weights->scattering = g->medium_stacks.path_ratio[path];
    weights->light = g->medium_stacks.path_light_ratio[path];
    return path_medium_stack(g, path);
  }
  const uint first = g->camera.camera->origins ? path : 0u;  // whose origin it has
  const MediumStack stack = path_medium_stack(g, first);
  if (path != first) set_path_medium_stack(g, path, stack);
  weights->scattering = weights->light = (float4)(1.0f);
  g->medium_stacks.path_ratio[path] = weights->scattering;
  g->medium_stacks.path_light_ratio[path] = weights->light;
  g->medium_stacks.path_within[path] = 0u;
  return stack;
}

// Takes one light sample at a point of a medium.
static inline void sample_light(const Stage* g, Outbox* out, const Scene* scene, uint path,
                                const ScatteringPoint* point, const PathState* state,
                                PathSample at) {
  LightSample light;
  const LightReceiver receiver = {point->p, CAPLET_NONE};
  if (!light_sample(scene, receiver, state->wavelengths,
                    sampler_bits(at, SCATTERING_SAMPLE(choices, state->depth)),
                    sampler_2d(at, SCATTERING_SAMPLE(light, state->depth)), &light))
    return;
  const float phase = phase_density(dot(point->direction, light.wi), point->asymmetry);
  const float4 contribution = state->throughput * light.radiance * (phase / light.pdf);
  if (!(max4(fabs(contribution)) > 0.0f)) return;
  set_shadow_medium_stack(g, path, point->stack, point->is_alone);
  g->medium_stacks.shadow_pdfs[path] =
      (float2)(light.pdf, light.delta ? 0.0f : path_pdf(g->view.view, phase));
  send_shadow_ray(g, out, path, &light, point->p, contribution, state->inside);
}

// Scatters a path at a point of a medium, `t` along its ray.
static inline void scatter(const Stage* g, Outbox* out, uint path, const ScatteringPoint* point,
                           float t, int is_within, PathState* state) {
  const PathSample at = path_sample(g->batch.batch, g->view.view, path);
  const uint depth = state->depth, uncounted = media_uncounted(g, path);
  float pdf;
  const float3 wi = phase_sample(point->direction, point->asymmetry,
                                 sampler_2d(at, SCATTERING_SAMPLE(bsdf, depth)), &pdf);
  state->last_pdf = path_pdf(g->view.view, pdf);
  state->crossed_light = CAPLET_NONE;
  if (!path_survives(at, depth, state->eta_scale, &state->throughput)) return;
  if (is_within &&
      !path_survives_within(g, path, uncounted, path_hash(at, depth), &state->throughput))
    return;
  state->depth = depth + 1u;
  state->specular = 0;
  if (has_cones) {
    const float2 cone = g->cones.path_cone[path];
    g->cones.path_cone[path] = (float2)(fabs(cone.x + cone.y * t), cone.y);
  }
  continue_path(g, out, path, state, CAPLET_NONE, point->p, wi);
}

static void sending_item(const Stage* g, Outbox* out, uint item) {
  const uint path = g->queues.queue[item];
  SEE_AT(PATH_TIME(g, path));
  const RayRecord ray = g->rays.path_ray[path];
  const HitRecord hit = g->rays.path_hit[path];
  PathState state = load_path_state(g, path);
  MediumWeights weights;
  const int begins = path_begins(g->carried.path_flags[path], &ray);
  const MediumStack stack = load_media(g, path, begins, &weights);
  // Behind a clipping plane there is no medium.
  const float t_end = has_clip ? fmin(hit.t, ray.t_max) : hit.t;
  const MediumStack here =
      medium_stack_before(&g->tree, &g->surfaces, &g->media, &hit, hit.t == t_end, stack);
  const uint medium = medium_stack_medium(&g->media, &here);
  if (medium == CAPLET_NONE || (g->view.view->strategy & CAPLET_STRATEGY_OCCLUSION) != 0u) return;

  const int is_within = medium_is_within(&g->media, medium);
  const int may_scatter =
      is_within || state.depth - media_uncounted(g, path) < g->view.view->max_depth;
  const PathSample at = path_sample(g->batch.batch, g->view.view, path);
  MediumNumbers numbers = {
      hash_combine(path_hash(at, state.depth) ^ HASHED_SAMPLE(tracking), as_uint(ray.t_min)), 0u};
  const float u = ray.t_min == 0.0f ? sampler_1d(at, MEDIUM_SAMPLE(distance, state.depth))
                                    : medium_number(&numbers);
  const MediumSegment segment =
      medium_segment(&g->media, &g->spectra, medium, state.wavelengths, &ray, ray.t_min, t_end);
  weights.throughput = state.throughput;
  float4 emitted = (float4)(0.0f);
  float t;
  const int end =
      medium_sample_distance(&segment, may_scatter, u, &numbers, &weights, &emitted, &t);
  if (max4(fabs(emitted)) > 0.0f) g->radiance.path_radiance[path] += emitted;
  state.throughput = weights.throughput;
  if (end == medium_passed) {
    g->carried.path_throughput[path] = state.throughput;
    g->medium_stacks.path_ratio[path] = weights.scattering;
    g->medium_stacks.path_light_ratio[path] = weights.light;
    return;
  }
  g->rays.path_hit[path].slot = CAPLET_SCATTERED;
  if (end == medium_ended) return;

  g->medium_stacks.path_ratio[path] = weights.scattering;
  g->medium_stacks.path_light_ratio[path] = weights.scattering;
  if (!begins)
    set_path_medium_stack(g, path, here);  // others may still ask what holds the first path
  // A point at either end may come to lie beyond the surface that is there.
  const float3 o = segment.o, d = segment.d;
  const float ends = 0x1p-20f * (max3(fabs(o)) + t * max3(fabs(d))) / length(d);
  const ScatteringPoint point = {
      o + t * d, d,
      medium_g(g->media.mediums[medium].kind, g->media.media_data + g->media.mediums[medium].data),
      here, t - ray.t_min > ends && t_end - t > ends};
  g->medium_stacks.path_near[path] = point.is_alone ? CAPLET_ALONE : CAPLET_RECOUNT;
  const Scene scene = {g->tree, g->surfaces, g->spectra, g->lights, g->materials};
  if (takes_light_sample(g)) sample_light(g, out, &scene, path, &point, &state, at);
  scatter(g, out, path, &point, t, is_within, &state);
}

#include "stages/sending.cl"
