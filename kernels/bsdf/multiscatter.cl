// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A lobe of its own returns the energy that single scattering at GGX facets loses (Kulla and Conty,
// "Revisiting physically based shading at Imageworks", SIGGRAPH 2017 course). Its value is the
// product of the losses of wo and of wi: it is reciprocal, and integrates to the loss of wo. Losses
// by bilinear interpolation (tools/energy_tables.py) are right to 0.005.
#ifndef CAPLET_BSDF_MULTISCATTER_CL
#define CAPLET_BSDF_MULTISCATTER_CL

#include "bsdf/bsdf_types.cl"
#include "bsdf/fresnel.cl"

// Returns 1 if the material's "multiscatter" is on. Kernels of scenes without such materials have
// no code of it.
static inline int bsdf_multiscatters(const Bsdf* b) {
#ifdef CAPLET_MULTISCATTER
  return (b->flags & CAPLET_MATERIAL_MULTISCATTER) != 0u;
#else
  (void)b;
  return 0;
#endif
}

#ifdef CAPLET_MULTISCATTER
#include "bsdf/multiscatter_tables.cl"

// Returns the roughness whose losses stand for unequal roughnesses along u and v.
static inline float loss_roughness(const Bsdf* b) {
  return clamp(0.5f * (b->alpha_u + b->alpha_v), CAPLET_ALPHA_MIN, 1.0f);
}

// Below this roughness little is lost except at grazing angles, where the lobe would have few and
// heavy samples. Losses there are those of this roughness, scaled down in proportion to the
// roughness.
#define LOSS_ALPHA_LEAST 0.08f

// Finds x, from 0 to 1, among `count` values: returns the number of its lower neighbour, and in
// *far its distance from there.
static inline int between(float x, int count, float* far) {
  const float at = x * (float)(count - 1);
  const int low = clamp((int)at, 0, count - 2);
  *far = at - (float)low;
  return low;
}
static inline float loss_between(__constant const float* row, int low, float far) {
  return mix(row[low], row[low + 1], far);
}

static inline float loss_of_rows(__constant const float* rows, int roughnesses, float cosine,
                                 float alpha) {
  const float scale = fmin(alpha / LOSS_ALPHA_LEAST, 1.0f);
  float at_alpha, at_cosine;
  alpha = fmax(alpha, LOSS_ALPHA_LEAST);
  const int low_alpha = between(sqrt(alpha), roughnesses, &at_alpha);
  const int low_cosine =
      between(sqrt(cosine * (1.0f + alpha) / (cosine + alpha)), LOSS_COSINES, &at_cosine);
  __constant const float* row = rows + low_alpha * LOSS_COSINES;
  return scale * mix(loss_between(row, low_cosine, at_cosine),
                     loss_between(row + LOSS_COSINES, low_cosine, at_cosine), at_alpha);
}
// Interpolates a row of means, one a roughness.
static inline float mean_loss_of_row(__constant const float* row, int roughnesses, float alpha) {
  float far;
  const int low = between(sqrt(fmax(alpha, LOSS_ALPHA_LEAST)), roughnesses, &far);
  return fmin(alpha / LOSS_ALPHA_LEAST, 1.0f) * loss_between(row, low, far);
}

// --- Metals ---

static inline float metal_loss(float cosine, float alpha) {
  return loss_of_rows(metal_losses, METAL_LOSS_ROUGHNESSES, cosine, alpha);
}

// Returns the mean reflectance of a smooth metal for light from everywhere, by Gauss' quadrature of
// three points for the cosine's weight: to 1e-3.
static inline float4 metal_mean_reflectance(float4 eta, float4 k) {
  return 0.1396540f * fresnel_conductor(0.2123405f, eta, k) +
         0.4584822f * fresnel_conductor(0.5905331f, eta, k) +
         0.4018638f * fresnel_conductor(0.9114120f, eta, k);
}

// Returns f |cos wi| of light that is scattered more than once, each time with the mean
// reflectance. *pdf becomes the density of facets and this lobe together; the lobe is chosen with
// the probability metal_loss of wo.
static inline float4 metal_multiscattered(const Bsdf* b, float3 wo, float3 wi, float* pdf) {
  const float alpha = loss_roughness(b), lost = metal_loss(wo.z, alpha),
              cosine = wi.z * CAPLET_INV_PI;
  const float mean_loss = mean_loss_of_row(metal_mean_losses, METAL_LOSS_ROUGHNESSES, alpha);
  const float4 mean = metal_mean_reflectance(b->eta, b->k);
  *pdf = mix(*pdf, cosine, lost);
  return mean * mean * ((1.0f - mean_loss) / (1.0f - mean * mean_loss)) *
         (lost * metal_loss(wi.z, alpha) / mean_loss * cosine);
}

// --- Dielectric interfaces ---

// Maps the relative index to the place of its losses, from 0 to 1.
static inline float interface_loss_at(float eta) {
  const float s = clamp((eta - 1.0f) / (eta + 1.0f), -0.5f, 0.5f), t = sqrt(2.0f * fabs(s));
  return 0.5f + 0.5f * (s < 0.0f ? -t : t);
}
static inline float interface_loss(float cosine, float alpha, float eta) {
  float far;
  const int low = between(interface_loss_at(eta), INTERFACE_LOSS_INDICES, &far),
            rows = INTERFACE_LOSS_ROUGHNESSES * LOSS_COSINES;
  __constant const float* plane = interface_losses + low * rows;
  return mix(loss_of_rows(plane, INTERFACE_LOSS_ROUGHNESSES, cosine, alpha),
             loss_of_rows(plane + rows, INTERFACE_LOSS_ROUGHNESSES, cosine, alpha), far);
}
static inline float interface_mean_loss(float alpha, float eta) {
  float far;
  const int low = between(interface_loss_at(eta), INTERFACE_LOSS_INDICES, &far);
  __constant const float* row = interface_mean_losses + low * INTERFACE_LOSS_ROUGHNESSES;
  return mix(mean_loss_of_row(row, INTERFACE_LOSS_ROUGHNESSES, alpha),
             mean_loss_of_row(row + INTERFACE_LOSS_ROUGHNESSES, INTERFACE_LOSS_ROUGHNESSES, alpha),
             far);
}

// Returns the share of a direction's lost light that is transmitted. T is the mean transmittance
// for light from everywhere (Kulla and Conty's fit), which is eta^2 times as much from here as from
// there; m is the smaller mean loss of both sides. The share is T m over the mean loss here. It is
// reciprocal except for the squared index of radiance.
static inline float interface_lost_beyond(float alpha, float eta) {
  const float here = interface_mean_loss(alpha, eta),
              there = interface_mean_loss(alpha, 1.0f / eta), index = fmax(eta, 1.0f / eta);
  const float from_outside = 1.0f - (index - 1.0f) / (4.08567f + 1.00071f * index);
  return (eta < 1.0f ? from_outside * eta * eta : from_outside) * fmin(here, there) / here;
}

// Does what metal_multiscattered does, for both sides of an interface.
static inline float interface_multiscattered(const Bsdf* b, float eta, float3 wo, float3 wi,
                                             float* pdf) {
  const float alpha = loss_roughness(b), lost = interface_loss(wo.z, alpha, eta),
              beyond = interface_lost_beyond(alpha, eta);
  const float cosine = fabs(wi.z) * CAPLET_INV_PI;
  const int reflected = wi.z > 0.0f;
  const float share = reflected ? 1.0f - beyond : beyond, index = reflected ? eta : 1.0f / eta;
  *pdf = mix(*pdf, share * cosine, lost);
  return share * cosine * lost * interface_loss(fabs(wi.z), alpha, index) /
         interface_mean_loss(alpha, index) * (reflected ? 1.0f : 1.0f / (eta * eta));
}
#endif

#endif
