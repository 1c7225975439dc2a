// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Samples the distance of a ray through a medium, and its transmittance. Distances are sampled for
// the hero wavelength, component 0, and the others are weighed with it by the balance heuristic
// (Wilkie et al., "Hero wavelength spectral sampling", 2014). Where a medium varies, collisions are
// made up to a majorant, and null collisions change nothing (Miller, Georgiev and Jarosz, "A
// null-scattering path integral formulation of light transport", 2019; Pharr, Jakob and Humphreys
// 2023, 14.2). Unlike there, absorption does not end a path where the medium scatters or has null
// collisions as well: it lowers weights.
//
// A path keeps its throughput over the mean of the densities with which each of the four
// wavelengths as the hero would have made it: `scattering` are these, with mean 1. `light` are the
// densities, in the same measure, of the same path with its last ray made as a shadow ray.
#ifndef CAPLET_MEDIA_SAMPLE_DISTANCE_CL
#define CAPLET_MEDIA_SAMPLE_DISTANCE_CL

#include "math/rng.cl"
#include "media/media.cl"

// MediumNumbers makes random numbers from a key and a count.
typedef struct {
  uint key, count;
} MediumNumbers;
static inline float medium_number(MediumNumbers* n) {
  return unit_float(hash_combine(n->key, n->count++));
}

typedef struct {
  float4 throughput, scattering, light;
  float most;  // of shadow rays: what all of them had in the beginning
} MediumWeights;

// Scales the weights so that `scattering` has mean 1. Returns 0 if nothing is left.
static inline int weights_normalised(MediumWeights* w) {
  const float mean = mean4(w->scattering);
  if (!(mean > 0.0f && mean < INFINITY)) return 0;
  const float scale = 1.0f / mean;
  w->throughput *= scale;
  w->scattering *= scale;
  w->light *= scale;
  return max4(fabs(w->throughput)) > 0.0f;
}

enum { medium_passed, medium_scattered, medium_ended };

// MediumSegment is the part of a ray that lies in one medium: o + t d from t0 to t1, which may be
// infinite.
typedef struct {
  uint kind;
  MediumView view;
  float3 o, d;
  float t0, t1;
} MediumSegment;

static inline MediumSegment medium_segment(const Media* media, const Spectra* spectra, uint medium,
                                           float4 lambda, const RayRecord* ray, float t0,
                                           float t1) {
  const MediumSegment segment = {media->mediums[medium].kind,
                                 medium_view(media, spectra, medium, lambda),
                                 (float3)(ray->ox, ray->oy, ray->oz),
                                 (float3)(ray->dx, ray->dy, ray->dz),
                                 t0,
                                 t1};
  return segment;
}

// Optical lengths are limited to this, so that products stay finite.
#define CAPLET_FARTHEST 1e30f

// Returns the radiance from the stretch of length d of a uniform medium.
static inline float4 uniform_emission(MediumPoint at, float d) {
  const float4 sigma_t = at.sigma_a + at.sigma_s, depth = sigma_t * d;
  // This is (1 - exp(-x)) / x, by its series near 0.
  const float4 series = 1.0f - depth * (0.5f - depth * (1.0f / 6.0f));
  const float4 exact = (1.0f - exp(-depth)) / fmax(depth, 1e-30f);
  return at.sigma_a * at.le * d * select(exact, series, depth < 1e-2f);
}

static inline int sample_distance_uniform(MediumPoint at, float d, int scatters, float u,
                                          MediumWeights* w, float4* emitted, float* length_gone) {
  d = fmin(d, CAPLET_FARTHEST);
  const float4 sigma_t = at.sigma_a + at.sigma_s;
  if (scatters && max4(at.le) > 0.0f) *emitted += w->throughput * uniform_emission(at, d);
  if (!(max4(at.sigma_s) > 0.0f)) {
    w->throughput *= exp(-sigma_t * d);
    return max4(fabs(w->throughput)) > 0.0f ? medium_passed : medium_ended;
  }
  const float hero = sigma_t.x;
  const float gone = hero > 0.0f ? -log(1.0f - u) / hero : INFINITY;
  if (!(gone < d)) {
    const float4 ratio = exp(-(sigma_t - hero) * d);
    w->throughput *= ratio;
    w->scattering *= ratio;
    w->light *= exp(hero * d);
    return weights_normalised(w) ? medium_passed : medium_ended;
  }
  if (!scatters) return medium_ended;
  const float4 ratio = exp(-(sigma_t - hero) * gone) / hero;
  w->throughput *= ratio * at.sigma_s;
  w->scattering *= ratio * sigma_t;
  *length_gone = gone;
  return weights_normalised(w) ? medium_scattered : medium_ended;
}

// Returns the probability of a scattering among collisions that do not absorb.
static inline float4 scattering_share(float4 sigma_s, float4 null) {
  const float4 both = sigma_s + null;
  return select((float4)(0.0f), sigma_s / fmax(both, 1e-30f), both > 0.0f);
}

// Samples a step by the random number u where no more than `most` is left of a cell. Returns 0 if
// the ray goes through, and multiplies the weights by the transmittance. Else there is a collision
// at *way, and *ratio is the transmittance over the hero's density there.
static inline int collides(float4 majorant, float most, float u, MediumWeights* w, float* way,
                           float4* ratio) {
  const float hero = majorant.x, gone = hero > 0.0f ? -log(1.0f - u) / hero : INFINITY;
  const int stays = gone < most;
  *way = stays ? gone : most;
  *ratio = exp(-(majorant - hero) * *way);
  if (stays) {
    *ratio /= hero;
    return 1;
  }
  w->throughput *= *ratio;
  w->scattering *= *ratio;
  w->light *= *ratio;
  return 0;
}

static inline int sample_distance_varying(const MediumSegment* s, int scatters, float u,
                                          MediumNumbers* numbers, MediumWeights* w, float4* emitted,
                                          float* t_scattered) {
  const MediumBox box = medium_box(s->kind, &s->view);
  MajorantWalk walk;
  if (!majorants_begin(&box, s->o, s->d, s->t0, s->t1, &walk)) return medium_passed;
  const float unit = length(s->d);
  float t, end, cell;
  while (majorants_next(&walk, &t, &end, &cell)) {
    const float4 majorant = cell * box.extinction;
    const float hero = majorant.x;
    for (;;) {
      float way;
      float4 ratio;
      if (!collides(majorant, (end - t) * unit, u, w, &way, &ratio)) {
        // The rest of the random number serves the next stretch.
        u = hero > 0.0f ? clamp(1.0f - (1.0f - u) * exp(hero * way), 0.0f, 0x1.fffffep-1f) : u;
        break;
      }
      t += way / unit;
      const MediumPoint at = medium_at(s->kind, &s->view, box.place, s->o + t * s->d);
      if (scatters && max4(at.le) > 0.0f) {
        const float density = mean4(w->scattering * ratio * majorant);
        if (density > 0.0f) *emitted += w->throughput * ratio * at.sigma_a * at.le / density;
      }
      const float4 null = fmax(majorant - at.sigma_a - at.sigma_s, 0.0f);
      const float4 share = scattering_share(at.sigma_s, null);
      u = medium_number(numbers);
      if (u < share.x) {
        if (!scatters) return medium_ended;
        ratio /= share.x;
        w->throughput *= ratio * at.sigma_s;
        w->scattering *= ratio * majorant * share;
        *t_scattered = t;
        return weights_normalised(w) ? medium_scattered : medium_ended;
      }
      ratio /= 1.0f - share.x;
      w->throughput *= ratio * null;
      w->scattering *= ratio * majorant * (1.0f - share);
      w->light *= ratio * majorant;
      if (!weights_normalised(w)) return medium_ended;
      u = medium_number(numbers);
    }
    if (!weights_normalised(w)) return medium_ended;
  }
  return medium_passed;
}

// Samples how far a path gets in a medium. scatters: scattered paths go on, and emission counts.
// u: for the first length. Adds the medium's emission to *emitted; *t_scattered: where a ray is
// scattered.
static inline int medium_sample_distance(const MediumSegment* s, int scatters, float u,
                                         MediumNumbers* numbers, MediumWeights* w, float4* emitted,
                                         float* t_scattered) {
  if (any_varying_medium && !medium_is_uniform(s->kind))
    return sample_distance_varying(s, scatters, u, numbers, w, emitted, t_scattered);
  const float unit = length(s->d);
  float gone = 0.0f;
  const int end = sample_distance_uniform(medium_everywhere(s->kind, &s->view),
                                          (s->t1 - s->t0) * unit, scatters, u, w, emitted, &gone);
  *t_scattered = s->t0 + gone / unit;
  return end;
}

// Computes the transmittance of a shadow ray, whose `throughput` is its remaining light; nothing
// scatters it. Where the medium varies, this is ratio tracking (Novak, Selle and Jarosz, "Residual
// ratio tracking for estimating attenuation in participating media", 2014). Returns 0 if nothing is
// left.
static inline int medium_transmittance(const MediumSegment* s, MediumNumbers* numbers,
                                       MediumWeights* w) {
  const float unit = length(s->d);
  if (!any_varying_medium || medium_is_uniform(s->kind)) {
    const MediumPoint at = medium_everywhere(s->kind, &s->view);
    const float way = fmin((s->t1 - s->t0) * unit, CAPLET_FARTHEST);
    const float4 passes = exp(-(at.sigma_a + at.sigma_s) * way);
    w->throughput *= passes;
    if (max4(at.sigma_s) > 0.0f) w->scattering *= passes;
    return max4(fabs(w->throughput)) > 0.0f;
  }
  const MediumBox box = medium_box(s->kind, &s->view);
  MajorantWalk walk;
  if (!majorants_begin(&box, s->o, s->d, s->t0, s->t1, &walk)) return 1;
  float t, end, cell;
  while (majorants_next(&walk, &t, &end, &cell)) {
    const float4 majorant = cell * box.extinction;
    const float hero = majorant.x;
    for (;;) {
      float way;
      float4 ratio;
      if (!collides(majorant, (end - t) * unit, hero > 0.0f ? medium_number(numbers) : 0.0f, w,
                    &way, &ratio))
        break;
      t += way / unit;
      const MediumPoint at = medium_at(s->kind, &s->view, box.place, s->o + t * s->d);
      const float4 null = fmax(majorant - at.sigma_a - at.sigma_s, 0.0f);
      w->throughput *= ratio * null;
      w->scattering *= ratio * majorant * (1.0f - scattering_share(at.sigma_s, null));
      w->light *= ratio * majorant;
      const float left = max4(fabs(w->throughput));
      if (!(left > 0.0f)) return 0;
      // Russian roulette ends a nearly extinct ray three times of four.
      const float share = left / fmax(mean4(w->light) * w->most, 1e-37f);
      if (share < 0.05f) {
        if (medium_number(numbers) < 0.75f) return 0;
        w->throughput *= 4.0f;
      }
    }
  }
  return 1;
}

#endif
