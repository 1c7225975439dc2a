// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This medium is the same everywhere.
#ifndef CAPLET_MEDIA_HOMOGENEOUS_CL
#define CAPLET_MEDIA_HOMOGENEOUS_CL

#include "media/media_types.cl"

static inline MediumPoint homogeneous_medium_at(const MediumView* m) {
  const float scale = homogeneous_medium_scale(m->data),
              le_scale = homogeneous_medium_le_scale(m->data);
  MediumPoint p;
  p.sigma_a = scale * spectrum_eval(m->spectra, homogeneous_medium_sigma_a(m->data), m->lambda);
  p.sigma_s = scale * spectrum_eval(m->spectra, homogeneous_medium_sigma_s(m->data), m->lambda);
  p.le = (float4)(0.0f);
  if (le_scale > 0.0f)
    p.le = le_scale * spectrum_eval(m->spectra, homogeneous_medium_le(m->data), m->lambda);
  return p;
}

#endif
