// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// An area light is one emissive primitive, sampled on its own geometry. Strategies and densities:
// docs/lights.md.
#ifndef CAPLET_LIGHTS_AREA_CL
#define CAPLET_LIGHTS_AREA_CL

#include "groups.cl"
#include "lights/light_types.cl"
#include "lights/shapes/ball.cl"
#include "lights/shapes/cylinder.cl"
#include "lights/shapes/round_cone.cl"
#include "lights/shapes/sphere.cl"
#include "lights/shapes/triangle.cl"
#include "math/spectrum.cl"
#include "math/vector.cl"
#include "shapes/surface.cl"

// Densities are limited to this, so that their squares stay finite.
#define CAPLET_MAX_DENSITY 1e18f

// AreaSample is a point of the light in world space.
typedef struct {
  float3 p, n;   // n: unit, on the emitting side of a one-sided light
  float error;   // how far p and what a ray meets may lie apart, along n
  float pdf;     // solid angle
  uint surface;  // HitRecord.surface
} AreaSample;

// Returns the ball by which the light is sampled, or 0.
static inline __global const float* area_ball(const Lights* lights,
                                              __global const LightRecord* light) {
  if (!any_ball_light || light->data == CAPLET_NONE) return 0;
  __global const float* data = lights->light_data + light->data;
  return area_ball_radius(data) > 0.0f ? data : 0;
}

// Returns the primitive's data (shapes/fields.cl).
static inline __global const float* area_data(const Tree* tree, __global const LightRecord* light) {
  return lane_data(floats_at(leaves_of(tree), light->slot), 0);
}

// Returns the factor by which areas with normal n (object space, unit) grow from object space to
// the world.
static inline float area_scale(const Tree* tree, uint instance, float3 n) {
  const Affine to_world = world_from_object(tree, instance),
               to_object = object_from_world(tree, instance);
  const float* m = to_world.m;
  const float3 r0 = (float3)(m[0], m[1], m[2]), r1 = (float3)(m[4], m[5], m[6]),
               r2 = (float3)(m[8], m[9], m[10]);
  return length(affine_transposed(&to_object, n)) * fabs(dot(r0, cross(r1, r2)));
}

static inline RoundCone area_round_cone(uint shape, __global const LightRecord* light,
                                        __global const float* data) {
  if (shape == shape_sphere) return round_cone_of_sphere(sphere_c(data), sphere_r(data));
  RoundCone k =
      shape == shape_capsule
          ? round_cone_make(capsule_p0(data), capsule_p1(data), capsule_r(data), capsule_r(data))
          : round_cone_make(tapered_capsule_p0(data), tapered_capsule_p1(data),
                            tapered_capsule_r0(data), tapered_capsule_r1(data));
  round_cone_cover(&k, light->flags >> CAPLET_LIGHT_COVER_0 & 255u,
                   light->flags >> CAPLET_LIGHT_COVER_1 & 255u);
  return k;
}

// Returns the world-space corners of a triangle light, as seen from p.
static inline TriangleView area_triangle(const Tree* tree, __global const LightRecord* light,
                                         __global const float* data, float3 p) {
  float3 v0 = triangle_v0(data), v1 = triangle_v1(data), v2 = triangle_v2(data);
  if (light->instance != CAPLET_NONE) {
    const Affine to_world = world_from_object(tree, light->instance);
    v0 = affine_point(&to_world, v0);
    v1 = affine_point(&to_world, v1);
    v2 = affine_point(&to_world, v2);
  }
  return triangle_view(v0, v1, v2, p);
}

// A sphere is sampled by solid angle if it is not within an instance and not around (or touching)
// p.
static inline float area_sphere_cone(__global const LightRecord* light, uint shape,
                                     __global const float* data, float3 p) {
  if (shape != shape_sphere || light->instance != CAPLET_NONE) return 0.0f;
  const float3 axis = sphere_c(data) - p;
  return sphere_cone(dot(axis, axis), sphere_r(data));
}

// Returns the largest magnitude of the numbers that a point of the primitive was made from, in its
// own space.
static inline float area_magnitude(uint shape, __global const float* data) {
  if (shape == shape_sphere) return norm1(sphere_c(data)) + sphere_r(data);
  if (shape == shape_disk) return norm1(disk_c(data)) + disk_r(data);
  if (shape == shape_triangle)
    return fmax(fmax(norm1(triangle_v0(data)), norm1(triangle_v1(data))), norm1(triangle_v2(data)));
  if (shape == shape_cylinder)
    return fmax(norm1(cylinder_p0(data)), norm1(cylinder_p1(data))) + cylinder_r(data);
  if (shape == shape_capsule)
    return fmax(norm1(capsule_p0(data)), norm1(capsule_p1(data))) + capsule_r(data);
  return fmax(norm1(tapered_capsule_p0(data)), norm1(tapered_capsule_p1(data))) +
         fmax(tapered_capsule_r0(data), tapered_capsule_r1(data));
}

// Returns a bound on the distance along the normal between a sampled point and the surface as a
// shadow ray from p meets it: some eight roundings each of the sampling and of the traversal, of
// the numbers they use.
static inline float area_error(const Tree* tree, __global const LightRecord* light, float magnitude,
                               float3 x, float3 p) {
  float world = magnitude;
  if (light->instance != CAPLET_NONE) {
    const Affine to_world = world_from_object(tree, light->instance),
                 to_object = object_from_world(tree, light->instance);
    const float3 there = affine_magnitude(&to_world, (float3)(magnitude));
    const float3 back = affine_magnitude(&to_object, fmax(there, fabs(p)));
    world = norm1(affine_magnitude(&to_world, fmax(back, (float3)(magnitude))));
  }
  return 16.0f * CAPLET_EPS * (world + norm1(x - p));
}

// A light, and what sampling it asks of its geometry.
typedef struct {
  __global const LightRecord* light;
  __global const GeometryRecord* geometry;
  __global const float* data;
  uint shape;
  int both, flip,
      placed;  // it emits on both sides; its normal is turned round; it is within an instance
} AreaLight;

// These sample a light as area_sample does. Those that do not set s->pdf return a density by area.

// A light that has a ball around it: directions towards the ball.
static inline int area_sample_ball(const Scene* scene, const AreaLight* of,
                                   __global const float* ball, float3 p, float2 u, AreaSample* s) {
  __global const LightRecord* light = of->light;
  const float3 wi = ball_sample(ball, p, u);
  HitRecord hit;
  if (!primitive_crossing(&scene->tree, &scene->surfaces, light->slot, light->instance, p, wi, 0.0f,
                          &hit))
    return 0;
  // Rays do not stop at an unseen light, so light from its far side passes through its near side.
  const uint crossings = light->flags & CAPLET_LIGHT_UNSEEN
                             ? choose_crossing(&scene->tree, &scene->surfaces, light->slot,
                                               light->instance, p, wi, &hit)
                             : 1u;
  const RayRecord ray = {p.x, p.y, p.z, 0.0f, wi.x, wi.y, wi.z, INFINITY};
  const Surface found = surface_at(&scene->tree, &scene->surfaces, &ray, &hit);
  if (found.light == CAPLET_NONE || (!of->both && !(dot(found.ng, wi) < 0.0f))) return 0;
  s->p = found.p;
  s->n = found.ng;
  s->surface = hit.surface;
  s->error = area_error(&scene->tree, light, norm1(load3(ball)) + ball[3], found.p, p);
  s->pdf = fmin(ball_pdf(ball, p) / (float)crossings, CAPLET_MAX_DENSITY);
  return 1;
}

// A sphere outside: the cone that it fills, of 2 pi `cone` steradians.
static inline int area_sample_sphere(const AreaLight* of, float cone, float3 p, float2 u,
                                     AreaSample* s) {
  if (of->flip && !of->both) return 0;
  const float3 axis = sphere_c(of->data) - p;
  const float distance = sqrt(dot(axis, axis));
  s->n = sphere_cone_sample(axis / distance, sphere_r(of->data) / distance, cone, u);
  s->p = sphere_c(of->data) + s->n * sphere_r(of->data);
  s->pdf = 1.0f / (2.0f * CAPLET_PI * cone);
  return 1;
}

// A triangle: by solid angle, or by area where that is too small or too large.
static inline int area_sample_triangle(const Scene* scene, const AreaLight* of, float3 p, float2 u,
                                       AreaSample* s, float* per_area) {
  const TriangleView view = area_triangle(&scene->tree, of->light, of->data, p);
  if (!(view.area > 0.0f)) return 0;
  const int mirrored = of->placed && (scene->tree.instances[of->light->instance].flags &
                                      CAPLET_INSTANCE_MIRRORED) != 0;
  s->n = view.cross / (2.0f * view.area);
  if (of->flip != mirrored) s->n = -s->n;
  if (!of->both && !(dot(s->n, view.v0) < 0.0f)) return 0;
  float pdf;
  const float2 b = triangle_sample(&view, u, &pdf);
  s->p = p + (view.v0 + (b.x * (view.v1 - view.v0) + b.y * (view.v2 - view.v0)));
  if (view.solid_angle > 0.0f)
    s->pdf = pdf;
  else
    *per_area = pdf;
  return 1;
}

// Disks, cylinders, spheres and capsules: by area, in the light's own space.
static inline int area_sample_by_area(const Scene* scene, const AreaLight* of, float3 p, float2 u,
                                      AreaSample* s, float* per_area) {
  __global const float* data = of->data;
  float3 x, n;
  float3 q = p;
  if (of->placed) {
    const Affine to_object = object_from_world(&scene->tree, of->light->instance);
    q = affine_point(&to_object, p);
  }
  if (of->shape == shape_disk) {
    const float3 center = disk_c(data);
    n = disk_n(data);
    const Frame frame = frame_from_normal(n);
    const float2 d = disk_r(data) * sample_disk(u);
    x = center + (frame.s * d.x + frame.t * d.y);
    if (of->flip) n = -n;
    if (!of->both && !(dot(q - center, n) > 0.0f)) return 0;
    *per_area = CAPLET_INV_PI / sqr(disk_r(data));
  } else if (CAPLET_HAS_SHAPE(shape_cylinder) && of->shape == shape_cylinder) {
    *per_area = cylinder_sample(data, cylinder_areas(&scene->surfaces, of->geometry, data), u, &x,
                                &n, &s->surface);
    if (!(*per_area > 0.0f)) return 0;
    if (of->flip) n = -n;
  } else {
    const RoundCone k = area_round_cone(of->shape, of->light, data);
    const RoundConeView view = round_cone_view(&k, q);
    if (view.inside != of->flip && !of->both) return 0;  // turned inside out, a solid emits inward
    *per_area = round_cone_sample(&k, &view, u, &x, &n);
    if (!(*per_area > 0.0f)) return 0;
    if (of->flip) n = -n;
  }
  if (of->placed) {
    const uint instance = of->light->instance;
    const Affine to_world = world_from_object(&scene->tree, instance),
                 to_object = object_from_world(&scene->tree, instance);
    *per_area /= area_scale(&scene->tree, instance, n);
    x = affine_point(&to_world, x);
    n = unit_or(affine_transposed(&to_object, n), n);
  }
  s->p = x;
  s->n = n;
  return 1;
}

// Samples primitive light `light` as seen from p. Returns 0 when no part of it that emits and that
// rays see ("onesided") faces p.
static inline int area_sample(const Scene* scene, __global const LightRecord* light, float3 p,
                              float2 u, AreaSample* s) {
  __global const GeometryRecord* geometry = scene->surfaces.geometries + light->geometry;
  const AreaLight of = {light,
                        geometry,
                        area_data(&scene->tree, light),
                        geometry->shape,
                        (light->flags & CAPLET_LIGHT_BOTH_SIDES) != 0,
                        (geometry->flags & CAPLET_GEOMETRY_FLIP_NORMAL) != 0,
                        light->instance != CAPLET_NONE};
  float per_area = 0.0f;
  s->pdf = 0.0f;
  s->surface = 0u;
  __global const float* ball = area_ball(&scene->lights, light);
  if (ball) return area_sample_ball(scene, &of, ball, p, u, s);
  const float cone = area_sphere_cone(light, of.shape, of.data, p);
  const int sampled = cone > 0.0f ? area_sample_sphere(&of, cone, p, u, s)
                      : of.shape == shape_triangle
                          ? area_sample_triangle(scene, &of, p, u, s, &per_area)
                          : area_sample_by_area(scene, &of, p, u, s, &per_area);
  if (!sampled) return 0;

  const float3 away = s->p - p;
  const float distance_squared = dot(away, away);
  if (!(distance_squared > 0.0f)) return 0;
  const float facing = -dot(s->n, away) / sqrt(distance_squared);
  if (of.both ? facing == 0.0f : !(facing > 0.0f)) return 0;
  // This is before ReverseOrientation, when a ray enters against the normal.
  if ((facing > 0.0f) == of.flip) s->surface |= CAPLET_LEAVING;
  if (of.placed) {
    const uint unseen =
        (facing > 0.0f) != of.flip ? CAPLET_INSTANCE_NO_ENTERING : CAPLET_INSTANCE_NO_LEAVING;
    if (scene->tree.instances[light->instance].flags & unseen) return 0;
  }
  if (per_area > 0.0f) s->pdf = per_area * distance_squared / fabs(facing);
  s->error = area_error(&scene->tree, light, area_magnitude(of.shape, of.data), s->p, p);
  s->pdf = fmin(s->pdf, CAPLET_MAX_DENSITY);
  return s->pdf > 0.0f;
}

// Returns the solid-angle density of area_sample from p for the direction wi, which meets the light
// at x with world normal n.
static inline float area_pdf(const Scene* scene, __global const LightRecord* light, float3 p,
                             float3 x, float3 n, float3 wi) {
  const uint shape = scene->surfaces.geometries[light->geometry].shape;
  __global const float* data = area_data(&scene->tree, light);
  __global const float* ball = area_ball(&scene->lights, light);
  if (ball) return fmin(ball_pdf(ball, p), CAPLET_MAX_DENSITY);
  const float cone = area_sphere_cone(light, shape, data, p);
  if (cone > 0.0f) return fmin(1.0f / (2.0f * CAPLET_PI * cone), CAPLET_MAX_DENSITY);
  const float3 away = x - p;
  const float facing = fabs(dot(n, wi));
  float per_area;
  if (shape == shape_triangle) {
    const TriangleView view = area_triangle(&scene->tree, light, data, p);
    if (view.solid_angle > 0.0f) return 1.0f / view.solid_angle;
    per_area = 1.0f / view.area;
  } else {
    const int placed = light->instance != CAPLET_NONE;
    float3 object_n = n;
    float3 q = p, y = x;
    if (placed) {
      const Affine to_world = world_from_object(&scene->tree, light->instance),
                   to_object = object_from_world(&scene->tree, light->instance);
      q = affine_point(&to_object, p);
      y = affine_point(&to_object, x);
      object_n = unit_or(affine_transposed(&to_world, n), n);
    }
    if (shape == shape_disk) {
      per_area = CAPLET_INV_PI / sqr(disk_r(data));
    } else if (CAPLET_HAS_SHAPE(shape_cylinder) && shape == shape_cylinder) {
      per_area = cylinder_density(
          cylinder_areas(&scene->surfaces, scene->surfaces.geometries + light->geometry, data));
    } else {
      const RoundCone k = area_round_cone(shape, light, data);
      const RoundConeView view = round_cone_view(&k, q);
      per_area = round_cone_density(&k, &view, y);
    }
    if (placed) per_area /= area_scale(&scene->tree, light->instance, object_n);
  }
  return per_area > 0.0f ? fmin(per_area * dot(away, away) / facing, CAPLET_MAX_DENSITY) : 0.0f;
}

// Fills all of a light sample but its radiance, and the point.
static inline int area_sample_towards(const Scene* scene, __global const LightRecord* light,
                                      float3 p, float2 u, AreaSample* point, LightSample* s) {
  if (!area_sample(scene, light, p, u, point)) return 0;
  const float3 away = point->p - p;
  s->wi = unit_or(away, (float3)(0.0f));
  if (!(dot(s->wi, s->wi) > 0.0f)) return 0;  // p is the point
  s->target = point->p;
  s->slack = point->error / fabs(dot(point->n, s->wi));
  if (!(norm1(s->target) < INFINITY)) return 0;
  s->slot = light->slot;
  s->instance = light->instance;
  s->pdf = point->pdf;
  return 1;
}

static inline int area_light_sample(const Scene* scene, __global const LightRecord* light, float3 p,
                                    float4 lambda, float2 u, LightSample* s) {
  AreaSample point;
  if (!area_sample_towards(scene, light, p, u, &point, s)) return 0;
  s->radiance = light_spectrum(&scene->spectra, light, lambda, 1.0f);
  return 1;
}

static inline float area_light_pdf(const Scene* scene, __global const LightRecord* light, float3 p,
                                   const Surface* hit, float3 wi) {
  return area_pdf(scene, light, p, hit->p, hit->ng, wi);
}

static inline float4 area_light_emitted(const Spectra* spectra, const Lights* lights,
                                        __global const LightRecord* light, float2 uv,
                                        float4 lambda) {
  (void)lights, (void)uv;
  return spectrum_eval(spectra, light->spectrum, lambda) * light->scale;
}

#endif
