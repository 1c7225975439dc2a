// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A mix has two materials, and a path meets one or the other.
#ifndef CAPLET_BSDF_MIX_CL
#define CAPLET_BSDF_MIX_CL

#include "bsdf/bsdf_types.cl"

static inline uint mix_part(const MaterialPoint* m, float* u) {
  const float amount = clamp(material_number(m, mix_at_amount), 0.0f, 1.0f);
  const int second = *u < amount;
  *u = clamp(second ? *u / amount : (*u - amount) / (1.0f - amount), 0.0f, 0.99999994f);
  return second ? mix_second(m->data) : mix_first(m->data);
}

#endif
