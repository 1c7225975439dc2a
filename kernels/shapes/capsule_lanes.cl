// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes spans of lanes that hold spheres, capsules and tapered capsules side by side: to the bit
// the span that each has as a shape of its own kind.
#ifndef CAPLET_SHAPES_CAPSULE_LANES_CL
#define CAPLET_SHAPES_CAPSULE_LANES_CL

#include "shapes/capsule.cl"
#include "shapes/sphere.cl"
#include "shapes/tapered_capsule.cl"

// The masks say which lanes are of which kind (flat_capsule, host/lower/shapes/capsule.cpp): each
// of one.
typedef struct {
  RealVector p0, p1;
  real r0, r1;
  real_mask is_sphere, is_capsule, is_tapered;
} CapsuleLanes;

static inline Span capsule_lanes_span(const ShapeRay* ray, const CapsuleLanes* c) {
  Span out = span_of(int_of(0), real_of(0.0f), real_of(0.0f));
  if (mask_bits(c->is_capsule) != 0) out = capsule_span_of(ray, c->p0, c->p1, c->r0);
  if (mask_bits(c->is_tapered) != 0) {
    const Span own = tapered_capsule_span_of(ray, c->p0, c->p1, c->r0, c->r1);
    out.t_enter = c->is_tapered ? own.t_enter : out.t_enter;
    out.t_exit = c->is_tapered ? own.t_exit : out.t_exit;
    out.enter = c->is_tapered ? own.enter : out.enter;
    out.exit = c->is_tapered ? own.exit : out.exit;
  }
  if (mask_bits(c->is_sphere) != 0) {
    const Span own = sphere_span_of(ray, c->p0, real_max(c->r0, c->r1));
    out.t_enter = c->is_sphere ? own.t_enter : out.t_enter;
    out.t_exit = c->is_sphere ? own.t_exit : out.t_exit;
    out.enter = c->is_sphere ? own.enter : out.enter;
    out.exit = c->is_sphere ? own.exit : out.exit;
  }
  return out;
}

static inline real_mask capsule_lanes_hit(const ShapeRay* ray, const CapsuleLanes* c, real* t,
                                          real_mask* side) {
  real_mask hit = int_of(0), own_side;
  real own_t;
  *t = real_of(0.0f);
  *side = int_of(0);
  if (mask_bits(c->is_capsule) != 0)
    hit = capsule_hit_of(ray, c->p0, c->p1, c->r0, t, side) & c->is_capsule;
  if (mask_bits(c->is_tapered) != 0) {
    const Span span = tapered_capsule_span_of(ray, c->p0, c->p1, c->r0, c->r1);
    hit |= span_nearest(ray, &span, &own_t, &own_side) & c->is_tapered;
    *t = c->is_tapered ? own_t : *t;
    *side = c->is_tapered ? own_side : *side;
  }
  if (mask_bits(c->is_sphere) != 0) {
    const Span span = sphere_span_of(ray, c->p0, real_max(c->r0, c->r1));
    hit |= span_nearest(ray, &span, &own_t, &own_side) & c->is_sphere;
    *t = c->is_sphere ? own_t : *t;
    *side = c->is_sphere ? own_side : *side;
  }
  return hit;
}

#endif
