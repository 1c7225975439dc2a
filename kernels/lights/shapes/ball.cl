// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A light of any shape can be sampled by its bounding ball: a direction is uniform in the cone that
// the ball fills (from within the ball: any direction), and the point is the first crossing of that
// one primitive along it. The density does not depend on the shape, so every shape is sampled
// exactly; directions that miss it are black.
#ifndef CAPLET_LIGHTS_SHAPES_BALL_CL
#define CAPLET_LIGHTS_SHAPES_BALL_CL

#include "groups.cl"
#include "lights/shapes/sphere.cl"
#include "math/rng.cl"
#include "math/vector.cl"
#include "shapes/shapes.cl"
#include "shapes/surface.cl"

// ball: centre and radius, world space.
static inline float ball_pdf(__global const float* ball, float3 p) {
  const float3 axis = load3(ball) - p;
  const float cone = sphere_cone(dot(axis, axis), ball[3]);
  return cone > 0.0f ? 1.0f / (2.0f * CAPLET_PI * cone) : 0.25f * CAPLET_INV_PI;
}

static inline float3 ball_sample(__global const float* ball, float3 p, float2 u) {
  const float3 axis = load3(ball) - p;
  const float cone = sphere_cone(dot(axis, axis), ball[3]);
  const float t = u.x * (cone > 0.0f ? cone : 2.0f);
  const float sine = sqrt(fmax(0.0f, t * (2.0f - t))), phi = 2.0f * CAPLET_PI * u.y;
  const Frame frame = frame_from_normal(unit_or(axis, (float3)(0.0f, 0.0f, 1.0f)));
  return normalize(frame.s * (sine * cos(phi)) + frame.t * (sine * sin(phi)) +
                   frame.n * (1.0f - t));
}

// Finds the first crossing beyond t_min of the primitive at `slot` that a ray from p along wi sees.
// Returns 0 when there is none.
static inline int primitive_crossing(const Tree* tree, const Surfaces* surfaces, uint slot,
                                     uint instance, float3 p, float3 wi, float t_min,
                                     HitRecord* hit) {
  const GeometryRecord geometry = surfaces->geometries[geometry_at(tree, surfaces, slot)];
  float3 o = p, d = wi;
  if (instance != CAPLET_NONE) {
    const Affine to_object = object_from_world(tree, instance);
    o = affine_point(&to_object, p);
    d = affine_vector(&to_object, wi);
  }
  ShapeRay ray = shape_ray_of(tree, o, d, t_min);
  if (instance != CAPLET_NONE) {
    // Every shape that is sampled here tests for the first crossing of a side that is seen.
    if (tree->instances[instance].flags & CAPLET_INSTANCE_NO_ENTERING) ray.sees_entering = 0;
    if (tree->instances[instance].flags & CAPLET_INSTANCE_NO_LEAVING) ray.sees_leaving = 0;
  }
  const uint lane = slot & 7u;
  real t;
  real_mask side;
  const real_mask found =
      any_shape_hit(geometry.shape, &ray, floats_at(leaves_of(tree), slot - lane), lane, &t, &side);
  float ts[CAPLET_REAL_WIDTH];
  int sides[CAPLET_REAL_WIDTH];
  real_store(t, ts);
  mask_store(side, sides);
  const uint at = lane % CAPLET_REAL_WIDTH;
  hit->t = ts[at];
  hit->slot = slot;
  hit->instance = instance;
  hit->surface = (uint)sides[at];
  return (mask_bits(found) >> at) & 1u;
}

// Replaces the first crossing `hit` by one of all crossings along the ray, each with the same
// chance. Returns the number of crossings.
static inline uint choose_crossing(const Tree* tree, const Surfaces* surfaces, uint slot,
                                   uint instance, float3 p, float3 wi, HitRecord* hit) {
  const uint seed = hash_combine(hash_combine(as_uint(wi.x), as_uint(wi.y)), as_uint(wi.z));
  uint count = 1u;
  HitRecord next = *hit;
  while (primitive_crossing(tree, surfaces, slot, instance, p, wi, next.t, &next)) {
    count++;
    if (unit_float(hash_combine(seed, count)) * (float)count < 1.0f) *hit = next;
  }
  return count;
}

#endif
