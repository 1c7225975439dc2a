// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What the BSDFs share. Local frame: n = (0, 0, 1) outward, wo and wi unit and away from the surface, z < 0: inside.
#ifndef CAPLET_BSDF_TYPES_CL
#define CAPLET_BSDF_TYPES_CL

#include "groups.cl"
#include "math/spectrum.cl"
#include "math/vector.cl"
#include "shared/families.h"
#include "textures/textures.cl"

enum {
  // Whether some material of the program's may be dispersive; has values that are estimates; stands for others; is a coat over a metal.
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

// Relative index so near 1 that an interface bends nothing: it is then smooth whatever its roughness, as the half vector of
// refraction wo + eta wi vanishes.
#define CAPLET_ETA_MATCHED 1e-4f

// What is over the base of a coated material (layered.cl): an interface of relative index eta, and a layer of that thickness below it.
typedef struct {
  float4 albedo;
  float eta, alpha_u, alpha_v;
  float thickness, g;
  int max_depth, samples;
} BsdfCoat;

// What principled.cl keeps besides the fields below. transmission: of the whole, so that the rest lies over a diffuse base.
typedef struct {
  float4 normal_tinted;  // what a tinted interface reflects at normal incidence
  float metallic, transmission, roughness, tint, coat;
} BsdfPrincipled;

// A BSDF at four wavelengths: what <name>_make takes from a material's data. A field is one material's or several's; eta is relative to
// the outside (whose index is 1). random: the key of the numbers that estimates take (trait_stochastic); the caller's, after _make.
typedef struct {
  uint kind, flags, random;
  float4 reflectance, transmittance, eta, k;
  float alpha_u, alpha_v;
  float tilt;  // of hair's scales, radians
  BsdfCoat coat;
  BsdfPrincipled principled;
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

// A material's data (materials.def) where it is looked at. textured: of its record.
typedef struct {
  __global const float* data;
  uint textured;
  TexturePoint point;
} MaterialPoint;

// Whether float `at` of the data is a texture.
static inline int material_is_textured(const MaterialPoint* m, int at) { return any_texture && (m->textured >> at & 1u) != 0; }
static inline float4 material_texture(const MaterialPoint* m, int at) {
  return texture_eval(as_uint(m->data[at]), &m->point);
}

// A spectrum from 0 up; one of a reflectance; a number from 0 up. `at`: their place in the data (diffuse_at_reflectance).
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
// A number of either sign.
static inline float material_signed(const MaterialPoint* m, int at) {
  return material_is_textured(m, at) ? material_texture(m, at).x : m->data[at];
}

// Roughness as GGX takes it (kinds.h).
static inline void bsdf_roughness(Bsdf* b, float alpha_u, float alpha_v) {
  b->alpha_u = alpha_u;
  b->alpha_v = alpha_v;
  if (!(alpha_u < CAPLET_ALPHA_SMOOTH && alpha_v < CAPLET_ALPHA_SMOOTH)) {
    b->alpha_u = fmax(alpha_u, CAPLET_ALPHA_MIN);
    b->alpha_v = fmax(alpha_v, CAPLET_ALPHA_MIN);
  }
}
static inline int bsdf_is_smooth(const Bsdf* b) { return b->alpha_u < CAPLET_ALPHA_SMOOTH && b->alpha_v < CAPLET_ALPHA_SMOOTH; }

// Refraction depends on the wavelength: see the head of bsdf.cl.
static inline int bsdf_is_dispersive(const Bsdf* b) { return any_dispersive_material && (b->flags & CAPLET_MATERIAL_DISPERSIVE) != 0; }

// What a scalar value of a dispersive material is at the four wavelengths.
static inline float4 bsdf_all_wavelengths(const Bsdf* b, float4 value) {
  return bsdf_is_dispersive(b) ? (float4)(value.x, 0.0f, 0.0f, 0.0f) : value;
}

#endif
