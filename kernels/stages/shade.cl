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
#include "stages/cone.cl"
#include "stages/layers.cl"
#include "stages/outbox.cl"
#include "stages/path.cl"
#include "stages/sort_key.cl"
#ifdef SHADE_IN_MEDIA
#include "stages/media.cl"
#endif

// Returns the white of the film's colour space, of luminance 1.
static inline float4 film_white(const Stage* g, float4 wavelengths) {
  return spectrum_table_at4(g->spectra.spectrum_tables + g->tree.world->illuminant_table, wavelengths);
}

// Returns CIE XYZ under white, whatever lights there are: a white surface has albedo 1 1 1.
static inline float3 first_hit_albedo(const Stage* g, const Bsdf* bsdf, float3 wo_local, float4 wavelengths, float4 pdfs) {
  const float4 seen = bsdf_albedo(bsdf, wo_local) * film_white(g, wavelengths);
  return xyz_from_spectrum(g->observer.observer, seen, wavelengths, pdfs);
}

// Returns the number in the object-id layer: the shape's, or that of the instance which holds it.
static inline uint first_hit_object(const Stage* g, const Surface* s, uint instance) {
  if (instance != CAPLET_NONE && g->tree.instances[instance].object != CAPLET_NONE) return g->tree.instances[instance].object;
  return g->surfaces.geometries[s->geometry].object;
}

// Stores the values of layers.def.
static inline void store_layers(const Stage* g, uint path, const HitRecord* hit, const Surface* s, const Bsdf* bsdf, float3 wo_local,
                                float3 wo, float4 wavelengths, float4 pdfs) {
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
#include "shared/layers.def"
#undef RADIANCE_LAYER
#undef HIT_LAYER
#undef ID_LAYER
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
  return (s->flags & CAPLET_GEOMETRY_NORMALS) != 0u && ((s->flags & CAPLET_GEOMETRY_OPEN) != 0u || !bsdf_is_opaque(bsdf));
}

// Takes one light sample; its unoccluded contribution waits in path_shadow_radiance for `connect`.
static inline void sample_light(const Stage* g, Outbox* out, const Scene* scene, uint path, const HitRecord* hit, const Surface* s, const Frame* frame,
                                const Bsdf* bsdf, uint side, int by_shading, float3 wo_local, float3 wo, float4 throughput, float4 wavelengths, uint u_select,
                                float2 u) {
  LightSample light;
  // The origin is on the side of wo, as for the density of a reflected ray that meets the light:
  // this matters within an emitting solid.
  const LightReceiver at = {offset_origin(s->p, s->ng, s->error, wo), side};
  if (!light_sample(scene, at, wavelengths, u_select, u, &light)) return;
  const float3 wi_local = to_local(frame, light.wi);
  const int transmitted = wi_local.z * wo_local.z < 0.0f;
  const int crosses = dot(light.wi, s->ng) * dot(wo, s->ng) < 0.0f;
  if (transmitted != crosses && !by_shading) return;
  // A ray that crosses sees its own primitive from the other side than this sample did, so only
  // that ray finds the light.
  if (crosses && light.index == s->primitive_light) return;
  float bsdf_pdf;
  const float4 f = bsdf_eval(bsdf, wo_local, wi_local, &bsdf_pdf);
  bsdf_pdf = path_pdf(g->view.view, bsdf_pdf);
#ifdef SHADE_IN_MEDIA
  const float weight = 1.0f;  // connect_media knows it
  media_shadow(g, path, hit, s, wo, &light, bsdf_pdf);
#else
  const float weight = light.delta ? 1.0f : power_heuristic(light.pdf, bsdf_pdf);
#endif
  const float4 contribution = throughput * f * light.radiance * (weight / light.pdf);
  if (!(max4(fabs(contribution)) > 0.0f)) return;  // the filter's weight may be negative
  ShadowTarget target;
  g->shadows.path_shadow[path] = shadow_ray(&light, offset_origin(s->p, s->ng, s->error, light.wi), &target);
  g->shadows.path_shadow_target[path] = target;
  g->shadows.path_shadow_radiance[path] = contribution;
  append_shadow(g, out, path);
}

// Samples a direction uniformly over the hemisphere of wo, or over the sphere where the BSDF or the
// integrator asks for it, in place of bsdf_sample: the integrators "simplepath" and "randomwalk".
// Returns 0 where nothing is scattered there.
static inline int uniform_sample(const Bsdf* bsdf, uint strategy, float3 wo_local, float2 u, BsdfSample* s) {
  const int is_sphere = (strategy & CAPLET_STRATEGY_SPHERE) != 0u || !bsdf_is_opaque(bsdf);
  const float z = is_sphere ? 1.0f - 2.0f * u.x : copysign(u.x, wo_local.z), across = sqrt(fmax(0.0f, 1.0f - z * z));
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
static inline void send_occlusion_ray(const Stage* g, Outbox* out, uint path, const HitRecord* hit, const Surface* s,
                                      float3 wo) {
  __global const ViewRecord* view = g->view.view;
  const float2 u = sampler_2d(path_sample(g->batch.batch, view, path), SCATTERING_SAMPLE(bsdf, 0));
  float3 wi_local = sample_cosine_hemisphere(u);
  if ((view->strategy & CAPLET_STRATEGY_UNIFORM) != 0u) {
    const float across = sqrt(1.0f - u.x * u.x), phi = 2.0f * CAPLET_PI * u.y;
    wi_local = (float3)(across * cos(phi), across * sin(phi), u.x);
    g->carried.path_throughput[path] *= 2.0f * u.x;  // the cosine over pi and the density
  }
  const Frame frame = frame_from_normal(dot(wo, s->ng) < 0.0f ? -s->ng : s->ng);
  const float3 wi = to_world(&frame, wi_local), origin = offset_origin(s->p, s->ng, s->error, wi);
  RayRecord ray = path_onward(origin, wi);
  ray.t_max = view->max_distance;
  g->rays.path_ray[path] = ray;
  g->carried.path_flags[path] = (1u << PATH_DEPTH_SHIFT) | PATH_SPECULAR;
#ifdef SHADE_IN_MEDIA
  media_scattered(g, path, hit, 0);
#else
  (void)hit;
#endif
  const uint bits = g->batch.batch->sort_bits;
  append_next(g, out, path, bits != CAPLET_NONE ? sort_key(g->tree.world, bits, origin, wi) : 0u);
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
    if (slot != CAPLET_NONE) fetch_ahead(g->tree.leaves + (slot & ~7u));
  }
  if (item + 8u < count) {
    const uint slot = g->rays.path_hit[g->queues.queue[item + 8u]].slot;
    if (slot != CAPLET_NONE) AHEAD(g->surfaces.primitive_geometry + as_uint(g->tree.leaves[slot]));
  }
}
#endif

static void sending_item(const Stage* g, Outbox* out, uint item) {
  const Scene scene = {g->tree, g->surfaces, g->spectra, g->lights, g->materials};
  const uint path = g->queues.queue[item];
  const RayRecord ray = g->rays.path_ray[path];
  const HitRecord hit = g->rays.path_hit[path];
  float4 throughput = g->carried.path_throughput[path];
  const float4 wavelengths = g->carried.path_wavelengths[path];
  float4 pdfs = g->carried.path_wavelength_pdfs[path];
  float4 scatter = g->carried.path_scatter[path];  // last pdf, eta scale, bits of the light that was crossed
  const uint flags = g->carried.path_flags[path];
  const uint depth = flags >> PATH_DEPTH_SHIFT;
  const int specular = (flags & PATH_SPECULAR) != 0;
  const uint strategy = g->view.view->strategy;
  const int is_occlusion = (strategy & CAPLET_STRATEGY_OCCLUSION) != 0u;
  const float3 direction = (float3)(ray.dx, ray.dy, ray.dz);
#ifdef SHADE_IN_MEDIA
  if (hit.slot == CAPLET_SCATTERED) return;
  scatter.x /= mean4(g->medium_stacks.path_light_ratio[path]);
#endif

  if (hit.slot == CAPLET_NONE) {
#ifdef CAPLET_UNSEEN_SKY
    if (depth == 0u) return;  // a backdrop takes its place
#endif
    float4 sky = (float4)(0.0f);
    if (!is_occlusion)
      sky = light_infinite(&g->spectra, &g->lights, (float3)(ray.ox, ray.oy, ray.oz), direction, wavelengths, scatter.x,
                           specular);
    else if (depth > 0u)
      sky = film_white(g, wavelengths);
    g->radiance.path_radiance[path] += throughput * sky;
    return;
  }

  if (is_occlusion && depth > 0u) return;
  Surface s = surface_at(&g->tree, &g->surfaces, &ray, &hit);
  const float3 wo = -direction;
  if (any_surface_light && s.light != CAPLET_NONE && !is_occlusion) {
    const float4 emitted = light_emitted(&g->spectra, &g->lights, s.light, s.ng, s.uv, wo, wavelengths);
    if (max4(emitted) > 0.0f) {
      float weight = 1.0f;
      // Only this strategy finds light of the primitive that the ray crossed.
      if (!specular && as_uint(scatter.z) != s.light) {
#ifdef CAPLET_LIGHT_TREE
        const uint before = g->carried.path_normal[path];
#else
        const uint before = CAPLET_NONE;
#endif
        const LightReceiver from = {(float3)(ray.ox, ray.oy, ray.oz), before};
        weight = power_heuristic(scatter.x, light_area_pdf(&scene, s.light, from, &s, direction));
      }
      g->radiance.path_radiance[path] += throughput * emitted * weight;
    }
  }

  TexturePlace place = texture_place(s.uv);
  place.p = s.p;
  place.n = s.ng;
  float2 cone = (float2)(0.0f);
  if (has_cones) {
    cone = g->cones.path_cone[path];
    cone.x = fabs(cone.x + cone.y * (hit.t * length(direction)));
    cone_footprint(&place, direction, cone.x, s.dpdu, s.dpdv);
  }
  uint material = s.material;
  if (any_choice_material) {
    const PathSample here = path_sample(g->batch.batch, g->view.view, path);
    const float u = sampler_2d(here, SCATTERING_SAMPLE(roulette, depth)).y;
    material = bsdf_chosen(&g->materials, &g->spectra, material, &place, wavelengths, u);
  }
#ifdef SHADE_IN_MEDIA
  if (media_passes(g, out, path, material, &ray, &hit)) return;
#endif
  const int bumped = any_bump != 0 && g->materials.materials[material].bump != CAPLET_NONE;
  if (bumped) {
    float3 dndu = (float3)(0.0f), dndv = dndu;
    if (any_displacement && g->materials.materials[material].bump_kind == texture_displacement)
      normal_derivatives(&g->tree, &g->surfaces, &ray, &hit, &s, &dndu, &dndv);
    s.ns = bump_normal(&g->materials, &g->spectra, material, &place, s.ns, s.dpdu, s.dpdv, dndu, dndv);
  }
  const Frame frame = frame_from_tangent(s.ns, bsdf_tangent(&g->materials, material, s.dpdu, s.ns, s.along_u));
  const float3 wo_local = to_local(&frame, wo);
  Bsdf bsdf = bsdf_make(&g->materials, &g->spectra, material, &place, wavelengths);
  if (depth == 0) store_layers(g, path, &hit, &s, &bsdf, wo_local, wo, wavelengths, pdfs);
  if (is_occlusion) return send_occlusion_ray(g, out, path, &hit, &s, wo);
#ifdef SHADE_IN_MEDIA
  const uint within = g->medium_stacks.path_within[path];
  const int is_within = boundary_is_met_within(g, path, &hit);
  if (!is_within && depth - within >= g->view.view->max_depth) return;
#else
  if (depth >= g->view.view->max_depth) return;
#endif
  if (bsdf_is_dispersive(&bsdf) && pdfs.y > 0.0f) {
    // A direction that depends on wavelength belongs to the hero wavelength alone: the others end
    // here, whatever the samples contribute.
    pdfs = (float4)(pdfs.x * 0.25f, 0.0f, 0.0f, 0.0f);
    throughput = (float4)(throughput.x, 0.0f, 0.0f, 0.0f);
#ifdef SHADE_IN_MEDIA
    media_hero_alone(g, path, &throughput, wavelengths);
#endif
    g->carried.path_wavelength_pdfs[path] = pdfs;
  }

  const PathSample at = path_sample(g->batch.batch, g->view.view, path);
  if (any_stochastic_material) bsdf.random = path_hash(at, depth);
  const float2 choices = sampler_2d(at, SCATTERING_SAMPLE(choices, depth));
  const uint side = receiving_side(&frame, &bsdf, wo_local);
  const int by_shading = goes_by_shading_normal(&s, &bsdf, bumped);
  if (g->lights.lighting->sampled_light_count > 0 && (strategy & CAPLET_STRATEGY_NO_LIGHTS) == 0u &&
      !bsdf_is_specular(&bsdf))
    sample_light(g, out, &scene, path, &hit, &s, &frame, &bsdf, side, by_shading, wo_local, wo, throughput, wavelengths,
                 sampler_bits(at, SCATTERING_SAMPLE(choices, depth)), sampler_2d(at, SCATTERING_SAMPLE(light, depth)));

  BsdfSample sample;
  const float2 u_bsdf = sampler_2d(at, SCATTERING_SAMPLE(bsdf, depth));
  if ((strategy & CAPLET_STRATEGY_UNIFORM) == 0u ? !bsdf_sample(&bsdf, wo_local, choices.y, u_bsdf, &sample)
                                                 : !uniform_sample(&bsdf, strategy, wo_local, u_bsdf, &sample))
    return;
  float3 wi = to_world(&frame, sample.wi);
  int crosses = dot(wi, s.ng) * dot(wo, s.ng) < 0.0f;
  if (sample.transmitted != crosses && !by_shading) {
    // Rims of mirrors would be black: a reflection that goes beneath the surface is mirrored to
    // above it.
    if (!sample.specular || (s.flags & CAPLET_GEOMETRY_NORMALS) == 0u) return;
    wi -= 2.0f * dot(wi, s.ng) * s.ng;
    crosses = 0;
  }
  throughput *= sample.weight;
  scatter.x = path_pdf(g->view.view, sample.pdf);
  scatter.y *= sample.eta_scale;
  scatter.z = as_float(crosses ? s.primitive_light : CAPLET_NONE);

  if (!path_survives(at, depth, scatter.y, &throughput)) return;
  if (!(max4(fabs(throughput)) > 0.0f)) return;
#ifdef SHADE_IN_MEDIA
  if (is_within) {
    if (!within_survives(within, within_number(path_hash(at, depth), within), &throughput)) return;
    g->medium_stacks.path_within[path] = within + 1u;
  }
#endif

  if (has_cones) {
    if (sample.specular) {
      const float side = dot(wo, s.ng) < 0.0f ? -1.0f : 1.0f;
      const float reach = fmax(cone.x, 1e3f * s.error);
      // eta_scale is the squared index of the side of wi over that of wo.
      cone = cone_turned(cone.x, cone.y, side * surface_bend(&g->tree, &g->surfaces, &ray, &hit, &s, reach), fabs(dot(wo, s.ng)),
                         sample.transmitted ? rsqrt(sample.eta_scale) : 0.0f);
    }
    g->cones.path_cone[path] = cone;
  }
  const float3 origin = offset_origin(s.p, s.ng, s.error, wi);
  g->rays.path_ray[path] = path_onward(origin, wi);
  g->carried.path_throughput[path] = throughput;
  g->carried.path_scatter[path] = scatter;
#ifdef CAPLET_LIGHT_TREE
  g->carried.path_normal[path] = side;
#endif
  g->carried.path_flags[path] = ((depth + 1) << PATH_DEPTH_SHIFT) | path_flag(g->view.view, sample.specular);
#ifdef SHADE_IN_MEDIA
  media_scattered(g, path, &hit, crosses);
#endif
  const uint bits = g->batch.batch->sort_bits;
  append_next(g, out, path, bits != CAPLET_NONE ? sort_key(g->tree.world, bits, origin, wi) : 0u);
}

#include "stages/sending.cl"
