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

// Returns 1 if the ray reaches its light. `hit`: the nearest one, or one that is nearer than
// target.enough. A ray that rounding leads past the light's silhouette meets nothing.
static inline int shadow_is_free(const HitRecord* hit, ShadowTarget target) {
  return hit->slot == CAPLET_NONE ||
         (hit->slot == target.slot && hit->instance == target.instance && hit->t >= target.enough);
}

#endif
