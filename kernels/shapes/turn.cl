// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file tests part of a turn around the z axis, which pbrt's partial sphere, cylinder and disk
// share.
#ifndef CAPLET_SHAPES_TURN_CL
#define CAPLET_SHAPES_TURN_CL

#include "shapes/lanes.cl"

#define CAPLET_FULL_TURN 0x1.921fb6p+2f

// Returns the lanes in which (x, y) is at an angle of 0 to phi_max from +x towards +y; the axis
// itself always is. It tests half-planes: sine and cosine are within 4 ulp, which displaces the
// edge by 8 eps of the distance from the axis.
static inline real_mask within_turn(real x, real y, real phi_max) {
  const real_mask whole = phi_max >= CAPLET_FULL_TURN;
  const real s = sin(phi_max), c = cos(phi_max);
  const real_mask left = y >= 0.0f,
                  right = x * s - y * c >= 0.0f;  // of the edges at 0 and at phi_max
  return whole | (s >= 0.0f ? left & right : left | right);
}

#endif
