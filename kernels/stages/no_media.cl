// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The functions of stages/media.cl that shading calls, for scenes without media.
#ifndef CAPLET_STAGES_NO_MEDIA_CL
#define CAPLET_STAGES_NO_MEDIA_CL

#include "stages/path_state.cl"

enum { in_media = 0 };

static inline float media_last_pdf(const Stage* g, uint path, float pdf) {
  (void)g, (void)path;
  return pdf;
}
static inline int media_passes(const Stage* g, Outbox* out, uint path, uint material,
                               const RayRecord* ray, const HitRecord* hit) {
  (void)g, (void)out, (void)path, (void)material, (void)ray, (void)hit;
  return 0;
}
static inline float media_light_weight(const Stage* g, uint path, const HitRecord* hit,
                                       const LightSample* light, int crosses, float bsdf_pdf) {
  (void)g, (void)path, (void)hit, (void)crosses;
  return light->delta ? 1.0f : power_heuristic(light->pdf, bsdf_pdf);
}
static inline void media_hero_alone(const Stage* g, uint path, PathState* state) {
  (void)g, (void)path, (void)state;
}
static inline void media_scattered(const Stage* g, uint path, const HitRecord* hit, int crosses) {
  (void)g, (void)path, (void)hit, (void)crosses;
}
static inline uint media_uncounted(const Stage* g, uint path) {
  (void)g, (void)path;
  return 0u;
}
static inline int boundary_is_met_within(const Stage* g, uint path, const HitRecord* hit) {
  (void)g, (void)path, (void)hit;
  return 0;
}
static inline int path_survives_within(const Stage* g, uint path, uint within, uint hash,
                                       float4* throughput) {
  (void)g, (void)path, (void)within, (void)hash, (void)throughput;
  return 1;
}

#endif
