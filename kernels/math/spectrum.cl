// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file evaluates spectra at four wavelengths, samples wavelengths, and computes colour. Forms
// of spectra: shared/spectra.def, docs/numerics.md.
#ifndef CAPLET_MATH_SPECTRUM_CL
#define CAPLET_MATH_SPECTRUM_CL

#include "groups.cl"
#include "math/vector.cl"
#include "shared/limits.h"

// Returns the place of a wavelength (nm) in a 1 nm table: the sample before it and the fraction to
// the next.
static inline int spectrum_cell(float lambda, float* fraction) {
  const float x = clamp(lambda - CAPLET_LAMBDA_MIN, 0.0f, CAPLET_LAMBDA_MAX - CAPLET_LAMBDA_MIN);
  const int cell = min((int)x, CAPLET_LAMBDA_COUNT - 2);
  *fraction = x - (float)cell;
  return cell;
}

// Interpolates linearly between the 1 nm samples of a table; lambda in nm, clamped to the table.
static inline float spectrum_table_at(__global const float* table, float lambda) {
  float fraction;
  const int cell = spectrum_cell(lambda, &fraction);
  return table[cell] + fraction * (table[cell + 1] - table[cell]);
}
static inline float4 spectrum_table_at4(__global const float* table, float4 lambda) {
  return (float4)(spectrum_table_at(table, lambda.x), spectrum_table_at(table, lambda.y),
                  spectrum_table_at(table, lambda.z), spectrum_table_at(table, lambda.w));
}

// Evaluates a spectrum of Jakob and Hanika 2019: s(c0 l^2 + c1 l + c2), s(x) = 1/2 + x / (2 sqrt(1
// + x^2)); l in nm; in [0, 1].
static inline float4 sigmoid_polynomial(float c0, float c1, float c2, float4 lambda) {
  const float4 x =
      clamp((c0 * lambda + c1) * lambda + c2, -1e9f, 1e9f);  // the square must not overflow
  return 0.5f + 0.5f * x / sqrt(1.0f + x * x);
}

// Returns the values of spectrum number `spectrum` at four wavelengths (nm).
static inline float4 spectrum_eval(const Spectra* spectra, uint spectrum, float4 lambda) {
  __global const SpectrumRecord* s = spectra->spectra + spectrum;
  const uint kind = s->kind;
  if (kind == spectrum_constant) return (float4)(s->scale);
  if (kind == spectrum_table)
    return s->scale * spectrum_table_at4(spectra->spectrum_tables + s->table, lambda);
  const float4 sigmoid = s->scale * sigmoid_polynomial(s->c0, s->c1, s->c2, lambda);
  if (kind == spectrum_sigmoid_illuminant)
    return sigmoid * spectrum_table_at4(spectra->spectrum_tables + s->table, lambda);
  return sigmoid;
}

// Returns an environment texel (sigmoid c0 c1 c2 and scale) times the illuminant of table
// `illuminant` at four wavelengths (nm).
static inline float4 sigmoid_illuminant(__global const float* illuminant, float4 texel,
                                        float4 lambda) {
  return texel.w * sigmoid_polynomial(texel.x, texel.y, texel.z, lambda) *
         spectrum_table_at4(illuminant, lambda);
}

// Returns one wavelength (nm) from u in [0, 1) and its density (1/nm), by the table
// Observer.wavelength_table. The density is constant between the table's entries, so it is exactly
// that of the wavelength returned.
static inline float wavelength_sample(__global const float* table, float u, float* pdf) {
  const float x = u * (float)CAPLET_WAVELENGTH_CELLS;
  const int cell = clamp((int)x, 0, CAPLET_WAVELENGTH_CELLS - 1);
  const float low = table[cell], step = table[cell + 1] - low;
  *pdf = 1.0f / ((float)CAPLET_WAVELENGTH_CELLS * step);
  return low + (x - (float)cell) * step;
}

// Returns four stratified wavelengths (u + i/4 mod 1) in nm, and their densities in 1/nm. u in [0,
// 1).
static inline float4 wavelengths_sample(__global const float* table, float u, float4* pdf) {
  float4 v = u + (float4)(0.0f, 0.25f, 0.5f, 0.75f);
  v -= floor(v);
  float p0, p1, p2, p3;
  const float4 lambda =
      (float4)(wavelength_sample(table, v.x, &p0), wavelength_sample(table, v.y, &p1),
               wavelength_sample(table, v.z, &p2), wavelength_sample(table, v.w, &p3));
  *pdf = (float4)(p0, p1, p2, p3);
  return lambda;
}

static inline float3 observer_at(__global const float* observer, float lambda) {
  float fraction;
  const int cell = spectrum_cell(lambda, &fraction);
  const float4 low = vload4(cell, observer), high = vload4(cell + 1, observer);
  return (low + fraction * (high - low)).xyz;
}

// Returns CIE XYZ by the table Observer.observer: the mean over the four wavelengths of radiance x
// observer / pdf. Wavelengths of pdf 0 add nothing.
static inline float3 xyz_from_spectrum(__global const float* observer, float4 radiance,
                                       float4 lambda, float4 pdf) {
  float3 xyz = (float3)(0.0f);
  if (pdf.x > 0.0f) xyz += observer_at(observer, lambda.x) * (radiance.x / pdf.x);
  if (pdf.y > 0.0f) xyz += observer_at(observer, lambda.y) * (radiance.y / pdf.y);
  if (pdf.z > 0.0f) xyz += observer_at(observer, lambda.z) * (radiance.z / pdf.z);
  if (pdf.w > 0.0f) xyz += observer_at(observer, lambda.w) * (radiance.w / pdf.w);
  return 0.25f * xyz;
}

#endif
