// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Tests whether a shadow ray (shadow_ray, lights/light_types.cl) reaches its light.
//
// Where several primitives lie within rounding of each other, a ray finds one of them, by t or by
// the rule of ties. A light sample counts if that one is the sampled one, so that each direction
// has the light of one primitive, as a scattered ray has. Shadow rays have unit directions as
// scattered rays do: with t = 1 at the sampled point, that point's primitive would lose most ties.
#ifndef CAPLET_TRACE_SHADOW_CL
#define CAPLET_TRACE_SHADOW_CL

#include "groups.cl"
#include "slots.cl"

// Returns whether two slots are of one primitive. Trees of what moves have slots of their own for
// each part of the shutter's time.
static inline int same_primitive(const Tree* tree, uint slot, uint other) {
#ifdef CAPLET_MOTION
  return other != CAPLET_NONE && primitive_at(tree, slot) == primitive_at(tree, other);
#else
  (void)tree;
  return slot == other;
#endif
}

// Returns 1 if the ray reaches its light. `hit`: the nearest one, or one that is nearer than
// target.enough. A ray that rounding leads past the light's silhouette meets nothing.
static inline int shadow_is_free(const Tree* tree, const HitRecord* hit, ShadowTarget target) {
  return hit->slot == CAPLET_NONE || (hit->instance == target.instance && hit->t >= target.enough &&
                                      same_primitive(tree, hit->slot, target.slot));
}

#endif
