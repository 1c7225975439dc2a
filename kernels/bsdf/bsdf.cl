// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The one door to all BSDFs. Local frame: n = (0, 0, 1) outward, wo and wi unit and away from the surface, z < 0: inside.
// Dispersive materials (bsdf_is_dispersive) act at the hero wavelength, component 0, alone: components 1..3 of what they evaluate
// and of their weights are 0. The caller makes up for them once a path, by 4 on component 0 (or by a quarter of its pdf).
#ifndef CAPLET_BSDF_BSDF_CL
#define CAPLET_BSDF_BSDF_CL

#include "bsdf/conductor.cl"
#include "bsdf/dielectric.cl"
#include "bsdf/diffuse.cl"
#include "groups.cl"
#include "math/spectrum.cl"

// Material number `material` at four wavelengths (nm).
static inline Bsdf bsdf_make(const Materials* materials, const Spectra* spectra, uint material, float4 lambda) {
  __global const MaterialRecord* record = materials->materials + material;
  Bsdf b;
  b.kind = record->kind;
  b.flags = record->flags;
  b.reflectance = b.eta = b.k = (float4)(0.0f);
  b.alpha_u = record->alpha_u;
  b.alpha_v = record->alpha_v;
  if (!(b.alpha_u < CAPLET_ALPHA_SMOOTH && b.alpha_v < CAPLET_ALPHA_SMOOTH)) {
    b.alpha_u = fmax(b.alpha_u, CAPLET_ALPHA_MIN);
    b.alpha_v = fmax(b.alpha_v, CAPLET_ALPHA_MIN);
  }
  switch (b.kind) {
    case material_diffuse:
      b.reflectance = spectrum_eval(spectra, record->reflectance, lambda);
      break;
    case material_conductor:
      // Beyond 1e4 the reflectance is 1 to 4e-4, and fourth powers stay finite.
      b.eta = clamp(spectrum_eval(spectra, record->eta, lambda), 0.0f, 1e4f);
      b.k = clamp(spectrum_eval(spectra, record->k, lambda), 0.0f, 1e4f);
      break;
    case material_dielectric:
      b.eta = clamp(spectrum_eval(spectra, record->eta, lambda), 1e-2f, 1e2f);
      break;
  }
  return b;
}

// Refraction depends on the wavelength: see the head of this file.
static inline int bsdf_is_dispersive(const Bsdf* b) { return (b->flags & CAPLET_MATERIAL_DISPERSIVE) != 0; }

// Nothing but delta scattering.
static inline int bsdf_is_specular(const Bsdf* b) {
  if (b->kind == material_diffuse) return 0;
  if (b->kind == material_dielectric && fabs(b->eta.x - 1.0f) < CAPLET_ETA_MATCHED) return 1;
  return b->alpha_u < CAPLET_ALPHA_SMOOTH && b->alpha_v < CAPLET_ALPHA_SMOOTH;
}

// What a scalar value of the dielectric is at the four wavelengths.
static inline float4 bsdf_all_wavelengths(const Bsdf* b, float4 value) {
  return bsdf_is_dispersive(b) ? (float4)(value.x, 0.0f, 0.0f, 0.0f) : value;
}

// f |cos wi| and the solid-angle density with which bsdf_sample takes wi; 0 for delta scattering.
static inline float4 bsdf_eval(const Bsdf* b, float3 wo, float3 wi, float* pdf) {
  *pdf = 0.0f;
  if (wo.z == 0.0f || bsdf_is_specular(b)) return (float4)(0.0f);
  const int inside = wo.z < 0.0f;
  if (inside) {
    wo.z = -wo.z;
    wi.z = -wi.z;
  }
  switch (b->kind) {
    case material_diffuse:
      return diffuse_eval(b, wi, pdf);
    case material_conductor:
      return conductor_eval(b, wo, wi, pdf);
    case material_dielectric:
      return bsdf_all_wavelengths(b, (float4)(dielectric_eval(b, inside ? 1.0f / b->eta.x : b->eta.x, wo, wi, pdf)));
  }
  return (float4)(0.0f);
}

// A direction wi for wo. u_component chooses between reflection and refraction; all u in [0, 1). 0: absorbed, and *s is not to be
// used.
static inline int bsdf_sample(const Bsdf* b, float3 wo, float u_component, float2 u, BsdfSample* s) {
  if (wo.z == 0.0f) return 0;
  const int inside = wo.z < 0.0f, smooth = bsdf_is_specular(b);
  int scattered = 0;
  if (inside) wo.z = -wo.z;
  switch (b->kind) {
    case material_diffuse:
      scattered = diffuse_sample(b, u, s);
      break;
    case material_conductor:
      scattered = conductor_sample(b, smooth, wo, u, s);
      break;
    case material_dielectric:
      scattered = dielectric_sample(b, smooth, inside ? 1.0f / b->eta.x : b->eta.x, wo, u_component, u, s);
      break;
  }
  if (!scattered) return 0;
  if (inside) s->wi.z = -s->wi.z;
  s->weight = bsdf_all_wavelengths(b, s->weight);
  return 1;
}

// Directional reflectance for the albedo layer, all wavelengths: exact for diffuse, smooth metals and clear glass; the rough ones
// by their smooth counterparts.
static inline float4 bsdf_albedo(const Bsdf* b, float3 wo) {
  if (b->kind == material_diffuse) return b->reflectance;
  if (b->kind == material_conductor) return fresnel_conductor(fabs(wo.z), b->eta, b->k);
  return (float4)(1.0f);
}

#endif
