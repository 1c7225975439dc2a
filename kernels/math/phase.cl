// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Particles scatter light by the phase function of Henyey and Greenstein, "Diffuse radiation in the
// galaxy", 1941. g: mean cosine of the scattering angle, -1 < g < 1.
#ifndef CAPLET_MATH_PHASE_CL
#define CAPLET_MATH_PHASE_CL

#include "math/vector.cl"

// Returns the density of the phase function at the cosine of a scattering angle.
static inline float phase_density(float cosine, float g) {
  const float d = fmax(1.0f + g * g - 2.0f * g * cosine, 1e-12f);
  return 0.25f * CAPLET_INV_PI * (1.0f - g * g) / (d * sqrt(d));
}

// Samples the new direction of a ray of direction w (unit).
static inline float3 phase_sample(float3 w, float g, float2 u, float* pdf) {
  const float t = (1.0f - g * g) / (1.0f - g + 2.0f * g * u.x);
  const float cosine =
      clamp(fabs(g) < 1e-3f ? 1.0f - 2.0f * u.x : (1.0f + g * g - t * t) / (2.0f * g), -1.0f, 1.0f);
  const float sine = sqrt(fmax(0.0f, 1.0f - cosine * cosine)), phi = 2.0f * CAPLET_PI * u.y;
  const Frame frame = frame_from_normal(w);
  *pdf = phase_density(cosine, g);
  return normalize(to_world(&frame, (float3)(sine * cos(phi), sine * sin(phi), cosine)));
}

#endif
