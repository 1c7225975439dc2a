// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Shades the hits of rays: emission and environment are weighted against light sampling (Veach
// 1997, chapter 9), then there is one light sample, one BSDF sample and Russian roulette. Fills
// queue_shadow and queue_next.
#include "math/ahead.cl"
#include "math/vector.cl"
#include "math/spectrum.cl"
#include "shapes/surface.cl"
#include "bsdf/bsdf.cl"
#include "bsdf/bump.cl"
#include "lights/lights.cl"
#include "stages/clip_face.cl"
#include "stages/cone.cl"
#include "stages/layers.cl"
#include "stages/times.cl"
#ifdef SHADE_IN_MEDIA
#include "stages/media.cl"
#else
#include "stages/no_media.cl"
#endif

// Returns the white of the film's colour space, of luminance 1.
static inline float4 film_white(const Stage* g, float4 wavelengths) {
  return spectrum_table_at4(g->spectra.spectrum_tables + g->tree.world->illuminant_table,
                            wavelengths);
}

// Returns CIE XYZ under white, whatever lights there are: a white surface has albedo 1 1 1.
static inline float3 first_hit_albedo(const Stage* g, const Bsdf* bsdf, float3 wo_local,
                                      float4 wavelengths, float4 pdfs) {
  const float4 seen = bsdf_albedo(bsdf, wo_local) * film_white(g, wavelengths);
  return xyz_from_spectrum(g->observer.observer, seen, wavelengths, pdfs);
}

// Returns the number in the object-id layer: the shape's, or that of the instance which holds it.
static inline uint first_hit_object(const Stage* g, const Surface* s, uint instance) {
  if (instance != CAPLET_NONE && g->tree.instances[instance].object != CAPLET_NONE)
    return g->tree.instances[instance].object;
  return g->surfaces.geometries[s->geometry].object;
}

// Returns the side of a point with this frame and BSDF that light samples see: an opaque surface
// takes light only on the side that wo is on.
static inline uint receiving_side(const Frame* frame, const Bsdf* bsdf, float3 wo_local) {
#ifdef CAPLET_LIGHT_TREE
  if (bsdf_is_opaque(bsdf)) return normal_bits(wo_local.z < 0.0f ? -frame->n : frame->n);
#else
  (void)frame, (void)bsdf, (void)wo_local;
#endif
  return CAPLET_NONE;
}

// Returns 1 where directions go by the shading normal alone, as pbrt-v4's do: with bumps and, on
// surfaces that are open or let light through, with normals of meshes. A closed opaque mesh takes
// what crosses it as no reflection, and so lets no light through (decision 0023).
static inline int goes_by_shading_normal(const Surface* s, const Bsdf* bsdf, int bumped) {
  if (bumped) return 1;
  return (s->flags & CAPLET_GEOMETRY_NORMALS) != 0u &&
         ((s->flags & CAPLET_GEOMETRY_OPEN) != 0u || !bsdf_is_opaque(bsdf));
}

// A hit that is shaded: the surface, and the path's direction there.
typedef struct {
  uint path;
  RayRecord ray;
  HitRecord hit;
  Surface surface;
  TexturePlace place;
  uint material;
  int bumped;
  Frame frame;  // of the shading normal
  Bsdf bsdf;
  float3 wo, wo_local;
  float2 cone;     // of the ray at the hit
  uint side;       // that light samples see
  int by_shading;  // directions go by the shading normal alone
} ShadingPoint;

// Stores the values of layers.def.
static inline void store_layers(const Stage* g, uint path, const ShadingPoint* point,
                                float4 wavelengths, float4 pdfs) {
  const HitRecord* hit = &point->hit;
  const Surface* s = &point->surface;
  const Bsdf* bsdf = &point->bsdf;
  const float3 wo = point->wo, wo_local = point->wo_local;
  __global float* at = layers_of_path(g->batch.batch, path, g->layers.path_layers);
  const uint layers = g->batch.batch->layers;
#define RADIANCE_LAYER(name, option, channels, how, count, words, unit, value)
#define HIT_LAYER(name, option, channels, how, count, words, unit, value) \
  if (layers & (1u << layer_##name)) {                                    \
    const float3 v = value;                                               \
    at[0] = v.x;                                                          \
    if (count == 3) {                                                     \
      at[1] = v.y;                                                        \
      at[2] = v.z;                                                        \
    }                                                                     \
    at += count;                                                          \
  }
#define ID_LAYER(name, option, channel, value) \
  if (layers & (1u << layer_##name)) *at++ = as_float((uint)(value));
#define SLOT_LAYER(name, option, channels, how, words, unit, value) \
  if (layers & (1u << layer_##name)) *at++ = value;
#include "shared/layers.def"
#undef RADIANCE_LAYER
#undef HIT_LAYER
#undef ID_LAYER
#undef SLOT_LAYER
}

// Takes one light sample; its unoccluded contribution waits in path_shadow_radiance for `connect`.
static inline void sample_light(const Stage* g, Outbox* out, const Scene* scene,
                                const ShadingPoint* point, const PathState* state, PathSample at) {
  const Surface* s = &point->surface;
  LightSample light;
  // The origin is on the side of wo, as for the density of a reflected ray that meets the light:
  // this matters within an emitting solid.
  const LightReceiver receiver = {offset_origin(s->p, s->ng, s->error, point->wo), point->side};
  if (!light_sample(scene, receiver, state->wavelengths,
                    sampler_bits(at, SCATTERING_SAMPLE(choices, state->depth)),
                    sampler_2d(at, SCATTERING_SAMPLE(light, state->depth)), &light))
    return;
  const float3 wi_local = to_local(&point->frame, light.wi);
  const int transmitted = wi_local.z * point->wo_local.z < 0.0f;
  const int crosses = dot(light.wi, s->ng) * dot(point->wo, s->ng) < 0.0f;
  if (transmitted != crosses && !point->by_shading) return;
  // A ray that crosses sees its own primitive from the other side than this sample did, so only
  // that ray finds the light.
  if (crosses && light.index == s->primitive_light) return;
  float bsdf_pdf;
  const float4 f = bsdf_eval(&point->bsdf, point->wo_local, wi_local, &bsdf_pdf);
  bsdf_pdf = path_pdf(g->view.view, bsdf_pdf);
  const float weight = media_light_weight(g, point->path, &point->hit, &light, crosses, bsdf_pdf);
  const float4 contribution = state->throughput * f * light.radiance * (weight / light.pdf);
  if (!(max4(fabs(contribution)) > 0.0f)) return;  // the filter's weight may be negative
  send_shadow_ray(
      g, out, point->path, &light, offset_origin(s->p, s->ng, s->error, light.wi), contribution,
      has_clip && clip_leads_inside(&g->surfaces, s, &point->hit, state->inside, crosses));
}

// Samples a direction uniformly over the hemisphere of wo, or over the sphere where the BSDF or the
// integrator asks for it, in place of bsdf_sample: the integrators "simplepath" and "randomwalk".
// Returns 0 where nothing is scattered there.
static inline int uniform_sample(const Bsdf* bsdf, uint strategy, float3 wo_local, float2 u,
                                 BsdfSample* s) {
  const int is_sphere = (strategy & CAPLET_STRATEGY_SPHERE) != 0u || !bsdf_is_opaque(bsdf);
  const float z = is_sphere ? 1.0f - 2.0f * u.x : copysign(u.x, wo_local.z),
              across = sqrt(fmax(0.0f, 1.0f - z * z));
  const float phi = 2.0f * CAPLET_PI * u.y;
  s->wi = (float3)(across * cos(phi), across * sin(phi), z);
  s->pdf = CAPLET_INV_PI * (is_sphere ? 0.25f : 0.5f);
  s->specular = 0;
  s->transmitted = z * wo_local.z < 0.0f;
  s->eta_scale = 1.0f;
  float bsdf_pdf;
  s->weight = bsdf_eval(bsdf, wo_local, s->wi, &bsdf_pdf) / s->pdf;
  return max4(s->weight) > 0.0f;
}

// Sends the one ray of ambient occlusion (the integrator "ambientocclusion" of pbrt-v4): what it
// does not meet within the greatest distance is white.
static inline void send_occlusion_ray(const Stage* g, Outbox* out, const ShadingPoint* point,
                                      PathState* state) {
  __global const ViewRecord* view = g->view.view;
  const Surface* s = &point->surface;
  const float2 u =
      sampler_2d(path_sample(g->batch.batch, view, point->path), SCATTERING_SAMPLE(bsdf, 0));
  float3 wi_local = sample_cosine_hemisphere(u);
  if ((view->strategy & CAPLET_STRATEGY_UNIFORM) != 0u) {
    const float across = sqrt(1.0f - u.x * u.x), phi = 2.0f * CAPLET_PI * u.y;
    wi_local = (float3)(across * cos(phi), across * sin(phi), u.x);
    state->throughput *= 2.0f * u.x;  // the cosine over pi and the density
  }
  const Frame frame = frame_from_normal(dot(point->wo, s->ng) < 0.0f ? -s->ng : s->ng);
  const float3 wi = to_world(&frame, wi_local);
  state->depth = 1u;
  state->specular = 1;
  state->inside = state->crossed = 0;
  media_scattered(g, point->path, &point->hit, 0);
  continue_path(g, out, point->path, state, CAPLET_NONE, offset_origin(s->p, s->ng, s->error, wi),
                wi);
  g->rays.path_ray[point->path].t_max =
      fmin(g->rays.path_ray[point->path].t_max, view->max_distance);
}

#if defined(CAPLET_PREFETCH) && !defined(SHADE_IN_MEDIA)
#define STAGE_LOOKS_AHEAD
// Paths come in the order of their rays, so that the data of a path, of its hit and of the object
// hit lie anywhere. Each is prefetched when the index that leads to it has arrived.
static inline void stage_ahead(const Stage* g, uint item, uint count) {
  if (item + 24u < count) {
    const uint path = g->queues.queue[item + 24u];
    AHEAD(g->rays.path_hit + path);
    AHEAD(g->rays.path_ray + path);
    AHEAD(g->carried.path_throughput + path);
    AHEAD(g->carried.path_wavelengths + path);
    AHEAD(g->carried.path_wavelength_pdfs + path);
    AHEAD(g->carried.path_scatter + path);
    AHEAD(g->carried.path_flags + path);
    AHEAD(g->radiance.path_radiance + path);
  }
  if (item + 16u < count) {
    const uint slot = g->rays.path_hit[g->queues.queue[item + 16u]].slot;
    if (slot != CAPLET_NONE) fetch_ahead(floats_at(leaves_of(&g->tree), slot_place(slot) & ~7u));
  }
  if (item + 8u < count) {
    const uint slot = g->rays.path_hit[g->queues.queue[item + 8u]].slot;
    if (slot != CAPLET_NONE)
      AHEAD(g->surfaces.primitive_geometry + primitive_at(&g->tree, slot) / CAPLET_PAGE_PRIMITIVES);
  }
}
#endif

// Adds the light of the sky to a path that met nothing.
static inline void add_sky(const Stage* g, uint path, const PathState* state,
                           const RayRecord* ray) {
  const int is_occlusion = (g->view.view->strategy & CAPLET_STRATEGY_OCCLUSION) != 0u;
#ifdef CAPLET_UNSEEN_SKY
  if (state->depth == 0u) return;  // a backdrop takes its place
#endif
  float4 sky = (float4)(0.0f);
  if (!is_occlusion)
    sky = light_infinite(&g->spectra, &g->lights, (float3)(ray->ox, ray->oy, ray->oz),
                         (float3)(ray->dx, ray->dy, ray->dz), state->wavelengths, state->last_pdf,
                         state->specular);
  else if (state->depth > 0u)
    sky = film_white(g, state->wavelengths);
  g->radiance.path_radiance[path] += state->throughput * sky;
}

// Adds the light that a surface emits towards the path, weighted against light samples.
static inline void add_emission(const Stage* g, const Scene* scene, const ShadingPoint* point,
                                const PathState* state) {
  const Surface* s = &point->surface;
  const float4 emitted =
      light_emitted(&g->spectra, &g->lights, s->light, s->ng, s->uv, point->wo, state->wavelengths);
  if (!(max4(emitted) > 0.0f)) return;
  float weight = 1.0f;
  // Only this strategy finds light of the primitive that the ray crossed.
  if (!state->specular && state->crossed_light != s->light) {
    const LightReceiver from = {(float3)(point->ray.ox, point->ray.oy, point->ray.oz),
                                path_side(g, point->path)};
    weight = power_heuristic(state->last_pdf, light_area_pdf(scene, s->light, from, s, -point->wo));
  }
  g->radiance.path_radiance[point->path] += state->throughput * emitted * weight;
}

// Finds where textures are looked up, the ray's cone there, and the material.
static inline void find_material(const Stage* g, ShadingPoint* point, const PathState* state) {
  const Surface* s = &point->surface;
  const float3 direction = -point->wo;
  point->place = texture_place(s->uv);
  point->place.p = s->p;
  point->place.n = s->ng;
  point->cone = (float2)(0.0f);
  if (has_cones) {
    point->cone = g->cones.path_cone[point->path];
    point->cone.x = fabs(point->cone.x + point->cone.y * (point->hit.t * length(direction)));
    cone_footprint(&point->place, direction, point->cone.x, s->dpdu, s->dpdv);
  }
  point->material = s->material;
  if (any_choice_material) {
    const PathSample at = path_sample(g->batch.batch, g->view.view, point->path);
    const float u = sampler_2d(at, SCATTERING_SAMPLE(roulette, state->depth)).y;
    point->material = bsdf_chosen(&g->materials, &g->spectra, point->material, &point->place,
                                  state->wavelengths, u);
  }
}

// Makes the shading frame, after bumps, and the BSDF.
static inline void make_bsdf(const Stage* g, ShadingPoint* point, const PathState* state) {
  Surface* s = &point->surface;
  const uint material = point->material;
  point->bumped = any_bump != 0 && g->materials.materials[material].bump != CAPLET_NONE &&
                  !on_clip_face(&point->hit);
  if (point->bumped) {
    BumpDerivatives of = {s->dpdu, s->dpdv, (float3)(0.0f), (float3)(0.0f)};
    if (any_displacement && g->materials.materials[material].bump_kind == texture_displacement)
      normal_derivatives(&g->tree, &g->surfaces, &point->ray, &point->hit, s, &of.dndu, &of.dndv);
    s->ns = bump_normal(&g->materials, &g->spectra, material, &point->place, s->ns, &of);
  }
  point->frame =
      frame_from_tangent(s->ns, bsdf_tangent(&g->materials, material, s->dpdu, s->ns, s->along_u));
  point->wo_local = to_local(&point->frame, point->wo);
  point->bsdf = bsdf_make(&g->materials, &g->spectra, material, &point->place, state->wavelengths);
}

// Drops all wavelengths but the hero where a direction depends on the wavelength: the others end
// here, whatever the samples contribute.
static inline void keep_hero_wavelength(const Stage* g, uint path, PathState* state, float4 pdfs) {
  g->carried.path_wavelength_pdfs[path] = (float4)(pdfs.x * 0.25f, 0.0f, 0.0f, 0.0f);
  state->throughput = (float4)(state->throughput.x, 0.0f, 0.0f, 0.0f);
  media_hero_alone(g, path, state);
}

// Samples the BSDF and sends the path on. is_within: it met the boundary of a subsurface from
// within, after `uncounted` scatterings there.
static inline void scatter(const Stage* g, Outbox* out, const ShadingPoint* point, PathState* state,
                           PathSample at, int is_within) {
  const Surface* s = &point->surface;
  const uint path = point->path, depth = state->depth, strategy = g->view.view->strategy;
  BsdfSample sample;
  const float u_lobe = sampler_2d(at, SCATTERING_SAMPLE(choices, depth)).y;
  const float2 u = sampler_2d(at, SCATTERING_SAMPLE(bsdf, depth));
  if ((strategy & CAPLET_STRATEGY_UNIFORM) == 0u
          ? !bsdf_sample(&point->bsdf, point->wo_local, u_lobe, u, &sample)
          : !uniform_sample(&point->bsdf, strategy, point->wo_local, u, &sample))
    return;
  float3 wi = to_world(&point->frame, sample.wi);
  int crosses = dot(wi, s->ng) * dot(point->wo, s->ng) < 0.0f;
  if (sample.transmitted != crosses && !point->by_shading) {
    // Rims of mirrors would be black: a reflection that goes beneath the surface is mirrored to
    // above it.
    if (!sample.specular || (s->flags & CAPLET_GEOMETRY_NORMALS) == 0u) return;
    wi -= 2.0f * dot(wi, s->ng) * s->ng;
    crosses = 0;
  }
  state->throughput *= sample.weight;
  state->last_pdf = path_pdf(g->view.view, sample.pdf);
  state->eta_scale *= sample.eta_scale;
  state->crossed_light = crosses ? s->primitive_light : CAPLET_NONE;
  if (!path_survives(at, depth, state->eta_scale, &state->throughput)) return;
  if (!(max4(fabs(state->throughput)) > 0.0f)) return;
  if (is_within && !path_survives_within(g, path, media_uncounted(g, path), path_hash(at, depth),
                                         &state->throughput))
    return;
  state->depth = depth + 1u;
  state->specular = sample.specular;
  if (has_clip) {
    state->inside = clip_leads_inside(&g->surfaces, s, &point->hit, state->inside, crosses);
    if (crosses) state->crossed = !on_clip_face(&point->hit) || state->inside;
  }
  if (has_cones) {
    float2 cone = point->cone;
    if (sample.specular) {
      const float side = dot(point->wo, s->ng) < 0.0f ? -1.0f : 1.0f;
      float bend = 0.0f;
      if (!on_clip_face(&point->hit))
        bend = surface_bend(&g->tree, &g->surfaces, &point->ray, &point->hit, s,
                            fmax(cone.x, 1e3f * s->error));
      // eta_scale is the squared index of the side of wi over that of wo.
      cone = cone_turned(cone.x, cone.y, side * bend, fabs(dot(point->wo, s->ng)),
                         sample.transmitted ? rsqrt(sample.eta_scale) : 0.0f);
    }
    g->cones.path_cone[path] = cone;
  }
  media_scattered(g, path, &point->hit, crosses);
  continue_path(g, out, path, state, point->side, offset_origin(s->p, s->ng, s->error, wi), wi);
}

static void sending_item(const Stage* g, Outbox* out, uint item) {
  const uint path = g->queues.queue[item];
  SEE_AT(PATH_TIME(g, path));
  const Scene scene = {g->tree, g->surfaces, g->spectra, g->lights, g->materials};
  const int is_occlusion = (g->view.view->strategy & CAPLET_STRATEGY_OCCLUSION) != 0u;
  ShadingPoint point;
  point.path = path;
  point.ray = g->rays.path_ray[path];
  point.hit = g->rays.path_hit[path];
  if (in_media && point.hit.slot == CAPLET_SCATTERED) return;
  PathState state = load_path_state(g, path);
  state.last_pdf = media_last_pdf(g, path, state.last_pdf);
  if (point.hit.slot == CAPLET_NONE) {
    add_sky(g, path, &state, &point.ray);
    return;
  }
  if (is_occlusion && state.depth > 0u) return;
  point.surface = surface_at(&g->tree, &g->surfaces, &point.ray, &point.hit);
  if (on_clip_face(&point.hit)) clip_surface(g->view.view, &point.ray, &point.hit, &point.surface);
  point.wo = -(float3)(point.ray.dx, point.ray.dy, point.ray.dz);
  if (any_surface_light && point.surface.light != CAPLET_NONE && !is_occlusion)
    add_emission(g, &scene, &point, &state);
  find_material(g, &point, &state);
  if (media_passes(g, out, path, point.material, &point.ray, &point.hit)) return;
  make_bsdf(g, &point, &state);
  const float4 pdfs = g->carried.path_wavelength_pdfs[path];
  if (state.depth == 0u) store_layers(g, path, &point, state.wavelengths, pdfs);
  if (is_occlusion) {
    send_occlusion_ray(g, out, &point, &state);
    return;
  }
  const int is_within = boundary_is_met_within(g, path, &point.hit);
  if (!is_within && state.depth - media_uncounted(g, path) >= g->view.view->max_depth) return;
  if (bsdf_is_dispersive(&point.bsdf) && pdfs.y > 0.0f) keep_hero_wavelength(g, path, &state, pdfs);

  const PathSample at = path_sample(g->batch.batch, g->view.view, path);
  if (any_stochastic_material) point.bsdf.random = path_hash(at, state.depth);
  point.side = receiving_side(&point.frame, &point.bsdf, point.wo_local);
  point.by_shading = goes_by_shading_normal(&point.surface, &point.bsdf, point.bumped);
  if (takes_light_sample(g) && !bsdf_is_specular(&point.bsdf))
    sample_light(g, out, &scene, &point, &state, at);
  scatter(g, out, &point, &state, at, is_within);
}

#include "stages/sending.cl"
