// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What the BSDFs share. Local frame: n = (0, 0, 1) outward, wo and wi unit and away from the surface, z < 0: inside.
#ifndef CAPLET_BSDF_TYPES_CL
#define CAPLET_BSDF_TYPES_CL

#include "math/vector.cl"
#include "shared/kinds.h"

// Relative index so near 1 that an interface bends nothing: it is then smooth whatever its roughness, as the half vector of
// refraction wo + eta wi vanishes.
#define CAPLET_ETA_MATCHED 1e-4f

// A BSDF at four wavelengths. eta is relative to the outside (whose index is 1); k belongs to conductors alone.
typedef struct {
  uint kind, flags;
  float4 reflectance, eta, k;
  float alpha_u, alpha_v;
} Bsdf;

// weight = f |cos wi| / pdf at each wavelength. pdf: solid angle; the probability itself where `specular`. eta_scale: 1, and the
// squared relative index n_i / n_o of a refraction (the factor that takes its 1/eta^2 out of the throughput that Russian roulette
// looks at).
typedef struct {
  float3 wi;
  float4 weight;
  float pdf;
  int specular, transmitted;
  float eta_scale;
} BsdfSample;

#endif
