// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds what the media share.
#ifndef CAPLET_MEDIA_TYPES_CL
#define CAPLET_MEDIA_TYPES_CL

#include "groups.cl"
#include "math/spectrum.cl"
#include "math/vector.cl"
#include "shared/families.h"

// MediumView is a medium as it is evaluated: its data (media.def), and the arrays that they refer
// to. lambda: nm.
typedef struct {
  const Spectra* spectra;
  __global const float* data;
  Floats grids;
  float4 lambda;
} MediumView;

// MediumPoint is a medium at a point: absorption, scattering (1 over length), and radiance per
// absorption, at the four wavelengths.
typedef struct {
  float4 sigma_a, sigma_s, le;
} MediumPoint;

// MediumBox is where a medium that varies is, and its majorants for size^3 cells of the box, x
// fastest; extinction is at most the cell's times `extinction`. place: 3x4 row-major, the unit cube
// from the world.
typedef struct {
  __global const float* place;
  Floats majorants;
  int size;
  float4 extinction;
} MediumBox;

#endif
