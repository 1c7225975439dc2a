// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// host_kernels.def for one CAPLET_REAL_WIDTH, from the text of kernels/. Scenes are lowered with
// CAPLET_ROWS=all, which gives kinds of shapes as many bits as all of them need.
#include "bsdf/bsdf.cl"
#include "camera/camera.cl"
#include "groups.cl"
#include "lights/lights.cl"
#include "math/filter.cl"
#include "shapes/surface.cl"
#include "stages/pick_record.cl"
#include "trace/list.cl"

// As host_kernels.h has it for C++.
typedef struct {
#define GROUP_BEGIN(Type, group) Type group;
#define BUFFER(name, type, access)
#define GROUP_END(Type)
  SCENE_GROUPS VIEW_GROUPS
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
      __global const float* packed_nodes;  // of the tree, for width 1
} HostGroups;

#include "host_kernels.h"

#define HOST_JOIN(name, width) host_##name##_##width
#define HOST_NAME(name, width) HOST_JOIN(name, width)
#define HOST(name) HOST_NAME(name, CAPLET_REAL_WIDTH)

static Tree traced_tree(const HostGroups* g) {
  Tree tree = g->tree;
  if (CAPLET_REAL_WIDTH == 1) tree.nodes = g->packed_nodes;
  return tree;
}
static float3 three(const float* p) { return (float3)(p[0], p[1], p[2]); }
static float4 four(const float* p) { return (float4)(p[0], p[1], p[2], p[3]); }

HitRecord HOST(trace_closest)(const HostGroups* g, const RayRecord* ray) {
  const Tree tree = traced_tree(g);
  return trace_closest(&tree, *ray);
}

int HOST(trace_any)(const HostGroups* g, const RayRecord* ray) {
  const Tree tree = traced_tree(g);
  return trace_any(&tree, *ray);
}

uint HOST(trace_all)(const HostGroups* g, const RayRecord* ray, uint capacity,
                     __global HitRecord* sorted) {
  const Tree tree = traced_tree(g);
  return trace_all(&tree, *ray, capacity, sorted);
}

void HOST(surface_at)(const HostGroups* g, const RayRecord* ray, const HitRecord* hit,
                      HostSurface* out) {
  const Surface s = surface_at(&g->tree, &g->surfaces, ray, hit);
  vstore3(s.p, 0, out->p);
  vstore3(s.ng, 0, out->ng);
  vstore3(s.ns, 0, out->ns);
  vstore3(s.dpdu, 0, out->dpdu);
  vstore3(s.dpdv, 0, out->dpdv);
  vstore2(s.uv, 0, out->uv);
  out->error = s.error;
  out->geometry = s.geometry;
  out->primitive = s.primitive;
  out->surface = s.surface;
  out->material = s.material;
  out->light = s.light;
  out->leaving = s.leaving;
}

PickRecord HOST(pick_record)(const HostGroups* g, const RayRecord* ray, const HitRecord* hit) {
  return pick_record(&g->tree, &g->surfaces, ray, hit);
}

void HOST(offset_origin)(const HostSurface* surface, const float* direction, float* origin) {
  vstore3(offset_origin(three(surface->p), three(surface->ng), surface->error, three(direction)), 0,
          origin);
}

int HOST(light_sample)(const HostGroups* g, const float* p, const float* lambda, const float* u,
                       HostLightSample* out) {
  LightSample s;
  const Scene scene = {g->tree, g->surfaces, g->spectra, g->lights, g->materials};
  const LightReceiver at = {three(p), CAPLET_NONE};
  if (!light_sample(&scene, at, four(lambda), (uint)(fmin(u[0], 0x1.fffffep-1f) * 4294967296.0f),
                    (float2)(u[1], u[2]), &s))
    return 0;
  vstore3(s.wi, 0, out->wi);
  vstore3(s.target, 0, out->target);
  vstore4(s.radiance, 0, out->radiance);
  out->pdf = s.pdf;
  out->infinite = s.infinite;
  out->delta = s.delta;
  return 1;
}

float HOST(light_area)(const HostGroups* g, const RayRecord* ray, const HitRecord* hit,
                       const float* lambda, float* emitted) {
  const Surface s = surface_at(&g->tree, &g->surfaces, ray, hit);
  const float3 d = (float3)(ray->dx, ray->dy, ray->dz);
  vstore4(light_emitted(&g->spectra, &g->lights, s.light, s.ng, s.uv, -d, four(lambda)), 0,
          emitted);
  const Scene scene = {g->tree, g->surfaces, g->spectra, g->lights, g->materials};
  const LightReceiver at = {(float3)(ray->ox, ray->oy, ray->oz), CAPLET_NONE};
  return light_area_pdf(&scene, s.light, at, &s, d);
}

void HOST(light_infinite)(const HostGroups* g, const float* origin, const float* direction,
                          const float* lambda, float last_pdf, int specular, float* out) {
  vstore4(light_infinite(&g->spectra, &g->lights, three(origin), three(direction), four(lambda),
                         last_pdf, specular),
          0, out);
}

static Bsdf host_bsdf(const HostGroups* g, uint material, const float* lambda) {
  const TexturePlace place = texture_place((float2)(0.0f));
  const uint chosen = bsdf_chosen(&g->materials, &g->spectra, material, &place, four(lambda), 0.3f);
  return bsdf_make(&g->materials, &g->spectra, chosen, &place, four(lambda));
}

int HOST(bsdf_sample)(const HostGroups* g, uint material, const float* lambda, const float* wo,
                      const float* u, HostBsdfSample* out) {
  const Bsdf b = host_bsdf(g, material, lambda);
  BsdfSample s;
  if (!bsdf_sample(&b, three(wo), u[0], (float2)(u[1], u[2]), &s)) return 0;
  vstore3(s.wi, 0, out->wi);
  vstore4(s.weight, 0, out->weight);
  out->pdf = s.pdf;
  out->eta_scale = s.eta_scale;
  out->specular = s.specular;
  out->transmitted = s.transmitted;
  return 1;
}

float HOST(bsdf_eval)(const HostGroups* g, uint material, const float* lambda, const float* wo,
                      const float* wi, float* f) {
  const Bsdf b = host_bsdf(g, material, lambda);
  float pdf;
  vstore4(bsdf_eval(&b, three(wo), three(wi), &pdf), 0, f);
  return pdf;
}

void HOST(bsdf_albedo)(const HostGroups* g, uint material, const float* lambda, const float* wo,
                       float* albedo) {
  const Bsdf b = host_bsdf(g, material, lambda);
  vstore4(bsdf_albedo(&b, three(wo)), 0, albedo);
}

void HOST(camera)(const HostGroups* g, uint x, uint y, const float* u, RayRecord* ray,
                  HostCameraSample* out) {
  const float2 offset =
      filter_sample(g->camera.filter_table, g->view.view->filter_width, g->view.view->filter_height,
                    (float2)(u[0], u[1]), &out->filter_weight);
  float weight;
  *ray = camera_ray(g->camera.camera, g->camera.camera_table,
                    (float2)((float)x + 0.5f, (float)y + 0.5f) + offset, (float2)(u[2], u[3]),
                    &weight);
  float4 pdf;
  vstore4(wavelengths_sample(g->observer.wavelength_table, u[4], &pdf), 0, out->lambda);
  vstore4(pdf, 0, out->lambda_pdf);
}

void HOST(answer)(const HostGroups* g, const HostQuestion* question, __global HostAnswer* out) {
  const HostQuestion q = *question;
  HostAnswer a;
  for (uint i = 0; i < sizeof a / 4; ++i) ((__private uint*)&a)[i] = 0;
  a.closest = HOST(trace_closest)(g, &q.ray);
  a.any = HOST(trace_any)(g, &q.ray);
  HOST(camera)(g, q.x, q.y, q.u, &a.camera_ray, &a.camera);
  const float from[3] = {q.ray.ox, q.ray.oy, q.ray.oz},
              direction[3] = {q.ray.dx, q.ray.dy, q.ray.dz};
  if (a.closest.slot == CAPLET_NONE) {
    HOST(light_infinite)(g, from, direction, q.lambda, q.u[7], q.x & 1u, a.sky);
  } else {
    a.found_surface = 1;
    HOST(surface_at)(g, &q.ray, &a.closest, &a.surface);
    a.pick = HOST(pick_record)(g, &q.ray, &a.closest);
    if (a.surface.light != CAPLET_NONE) {
      a.found_area = 1;
      a.area_pdf = HOST(light_area)(g, &q.ray, &a.closest, q.lambda, a.emitted);
    }
    float origin[3];
    const float back[3] = {-direction[0], -direction[1], -direction[2]};
    HOST(offset_origin)(&a.surface, back, origin);
    a.found_light = HOST(light_sample)(g, origin, q.lambda, q.u, &a.light);
    const Frame frame = frame_from_tangent(three(a.surface.ns), three(a.surface.dpdu));
    const float3 backward = unit_or(three(back), frame.n);
    float wo[3];
    vstore3(to_local(&frame, backward), 0, wo);
    HOST(bsdf_albedo)(g, a.surface.material, q.lambda, wo, a.albedo);
    a.found_scattered =
        HOST(bsdf_sample)(g, a.surface.material, q.lambda, wo, q.u + 3, &a.scattered);
    if (a.found_scattered)
      a.scattered_pdf =
          HOST(bsdf_eval)(g, a.surface.material, q.lambda, wo, a.scattered.wi, a.scattered_value);
  }
  *out = a;
  out->count = HOST(trace_all)(g, &q.ray, HOST_LIST_CAPACITY, out->list);
}
