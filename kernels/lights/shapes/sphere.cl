// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Samples directions to a sphere, uniformly in the solid angle it fills (Shirley, Wang and
// Zimmerman, "Monte Carlo techniques for direct lighting calculations", 1996).
#ifndef CAPLET_LIGHTS_SHAPES_SPHERE_CL
#define CAPLET_LIGHTS_SHAPES_SPHERE_CL

#include "math/vector.cl"

// Returns 1 - cos of the half angle of the cone in which the sphere is seen, without cancellation;
// 0 when p is inside or so near (2^-20 of the radius) that the cone is not known.
static inline float sphere_cone(float distance_squared, float radius) {
  const float sine_squared = radius * radius / distance_squared;
  if (!(sine_squared < 1.0f - 1.0f / 1048576.0f)) return 0.0f;
  return sine_squared / (1.0f + sqrt(1.0f - sine_squared));
}

// Returns the normal of the sphere at the nearer crossing of a direction at (1 - cos) = u.x * cone
// from the axis. `axis` unit, from p to the centre; `radius_over_distance` < 1.
static inline float3 sphere_cone_sample(float3 axis, float radius_over_distance, float cone,
                                        float2 u) {
  const float t = u.x * cone;
  const float sine_squared = t * (2.0f - t);
  const float ratio_squared = sqr(radius_over_distance);
  // The law of sines in the triangle p, centre, crossing gives the cosine of the angle at the
  // centre.
  const float cosine = sine_squared / radius_over_distance +
                       (1.0f - t) * sqrt(fmax(0.0f, 1.0f - sine_squared / ratio_squared));
  const float sine = sqrt(fmax(0.0f, 1.0f - cosine * cosine));
  const float phi = 2.0f * CAPLET_PI * u.y;
  const Frame frame = frame_from_normal(axis);
  return normalize(frame.s * (sine * cos(phi)) + frame.t * (sine * sin(phi)) - frame.n * cosine);
}

#endif
