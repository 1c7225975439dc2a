// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds what the BSDFs share. Local frame: n = (0, 0, 1) outward, wo and wi unit and away
// from the surface, z < 0: inside.
#ifndef CAPLET_BSDF_TYPES_CL
#define CAPLET_BSDF_TYPES_CL

#include "groups.cl"
#include "math/spectrum.cl"
#include "math/vector.cl"
#include "shared/families.h"
#include "textures/textures.cl"

enum {
  // These constants say whether some material of the program may be dispersive, may return
  // estimates, may stand for others, or may be a coat over a metal.
  any_dispersive_material = 0
#define MATERIAL(name, traits) || ((traits)&trait_dispersive) != 0
#include "rows/materials.def"
#undef MATERIAL
};
enum {
  any_stochastic_material = 0
#define MATERIAL(name, traits) || ((traits)&trait_stochastic) != 0
#include "rows/materials.def"
#undef MATERIAL
};
enum {
  any_choice_material = 0
#define MATERIAL(name, traits)
#define CHOICE(name, traits) || 1
#include "rows/materials.def"
#undef MATERIAL
};
enum {
  any_metal_base = 0
#define MATERIAL(name, traits) || ((traits)&trait_metal_base) != 0
#include "rows/materials.def"
#undef MATERIAL
};

// An interface whose relative index differs from 1 by less than this does not bend light. It counts
// as smooth whatever its roughness, because the half vector of refraction wo + eta wi vanishes.
#define CAPLET_ETA_MATCHED 1e-4f

// BsdfCoat is the coat over the base of a coated material (layered.cl): an interface of relative
// index eta, and a layer of that thickness below it.
typedef struct {
  float4 albedo;
  float eta, alpha_u, alpha_v;
  float thickness, g;
  int max_depth, samples;
} BsdfCoat;

// Bsdf is a BSDF at four wavelengths, which <name>_make reads from a material's data. One or
// several materials use each field; eta is relative to the outside (whose index is 1). random: the
// key of the random numbers for estimates (trait_stochastic), which the caller sets after _make.
// materials.def lists the members that one material alone uses.
typedef struct {
  uint kind, flags, random;
  float4 reflectance, transmittance, eta, k;
  float alpha_u, alpha_v;
  BsdfCoat coat;
#define MATERIAL(name, traits)
#define KEPT(material, name, type) type material##_##name;
#include "rows/materials.def"
#undef MATERIAL
} Bsdf;

// weight = f |cos wi| / pdf at each wavelength. pdf: solid angle; the probability itself where
// `specular`. eta_scale: 1, and the squared relative index n_i / n_o of a refraction (the factor
// that takes its 1/eta^2 out of the throughput that Russian roulette looks at).
typedef struct {
  float3 wi;
  float4 weight;
  float pdf;
  int specular, transmitted;
  float eta_scale;
} BsdfSample;

// MaterialPoint is a material's data (materials.def) at a point of a surface. textured: of its
// record.
typedef struct {
  __global const float* data;
  uint textured;
  TexturePoint point;
} MaterialPoint;

// Returns 1 if float `at` of the data is a texture.
static inline int material_is_textured(const MaterialPoint* m, int at) {
  return any_texture && (m->textured >> at & 1u) != 0;
}
static inline float4 material_texture(const MaterialPoint* m, int at) {
  return texture_eval(as_uint(m->data[at]), &m->point);
}

// These return a spectrum from 0 up, a reflectance, and a number from 0 up. `at`: their place in
// the data (diffuse_at_reflectance).
static inline float4 material_spectrum(const MaterialPoint* m, int at) {
  if (material_is_textured(m, at)) return fmax(material_texture(m, at), 0.0f);
  return spectrum_eval(m->point.spectra, as_uint(m->data[at]), m->point.lambda);
}
static inline float4 material_albedo(const MaterialPoint* m, int at) {
  if (material_is_textured(m, at)) return clamp(material_texture(m, at), 0.0f, 1.0f);
  return spectrum_eval(m->point.spectra, as_uint(m->data[at]), m->point.lambda);
}
static inline float material_number(const MaterialPoint* m, int at) {
  if (material_is_textured(m, at)) return fmax(material_texture(m, at).x, 0.0f);
  return m->data[at];
}
// Returns a number of either sign.
static inline float material_signed(const MaterialPoint* m, int at) {
  return material_is_textured(m, at) ? material_texture(m, at).x : m->data[at];
}

// Sets the roughness as GGX takes it (kinds.h).
static inline void bsdf_roughness(Bsdf* b, float alpha_u, float alpha_v) {
  b->alpha_u = alpha_u;
  b->alpha_v = alpha_v;
  if (!(alpha_u < CAPLET_ALPHA_SMOOTH && alpha_v < CAPLET_ALPHA_SMOOTH)) {
    b->alpha_u = fmax(alpha_u, CAPLET_ALPHA_MIN);
    b->alpha_v = fmax(alpha_v, CAPLET_ALPHA_MIN);
  }
}
static inline int bsdf_is_smooth(const Bsdf* b) {
  return b->alpha_u < CAPLET_ALPHA_SMOOTH && b->alpha_v < CAPLET_ALPHA_SMOOTH;
}

// Returns 1 if refraction depends on the wavelength: see the head of bsdf.cl.
static inline int bsdf_is_dispersive(const Bsdf* b) {
  return any_dispersive_material && (b->flags & CAPLET_MATERIAL_DISPERSIVE) != 0;
}

// Returns the scalar value of a dispersive material at the four wavelengths.
static inline float4 bsdf_all_wavelengths(const Bsdf* b, float4 value) {
  return bsdf_is_dispersive(b) ? (float4)(value.x, 0.0f, 0.0f, 0.0f) : value;
}

#endif
