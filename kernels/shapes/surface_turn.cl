// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds where a point belongs on a turn around the z axis that ends at phi_max.
#ifndef CAPLET_SHAPES_SURFACE_TURN_CL
#define CAPLET_SHAPES_SURFACE_TURN_CL

#include "math/vector.cl"

// Returns x / whole in [0, 1], and 0 if whole is 0: parameters of shapes without an extent.
static inline float share_of(float x, float whole) {
  return whole != 0.0f ? clamp(x / whole, 0.0f, 1.0f) : 0.0f;
}

// Returns the unit vector across the z axis towards (x, y), turned back to the nearer edge where
// rounding took it beyond; the angle in `phi`.
static inline float2 spoke_within_turn(float x, float y, float phi_max, float* phi) {
  const float scale = fmax(fabs(x), fabs(y));
  const float2 v = scale > 0.0f ? (float2)(x / scale, y / scale) : (float2)(1.0f, 0.0f);
  const float2 spoke = v / sqrt(dot(v, v));
  const float full = 2.0f * CAPLET_PI;
  float angle = atan2(spoke.y, spoke.x);
  if (angle < 0.0f) angle = fmin(angle + full, 0x1.921fb4p+2f);
  if (!(angle > phi_max)) {
    *phi = angle;
    return spoke;
  }
  const int back_to_end = angle - phi_max < full - angle;
  *phi = back_to_end ? phi_max : 0.0f;
  return back_to_end ? (float2)(cos(phi_max), sin(phi_max)) : (float2)(1.0f, 0.0f);
}

#endif
