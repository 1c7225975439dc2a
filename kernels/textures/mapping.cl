// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes coordinates of textures, as pbrt-v4 has them (Pharr, Jakob and Humphreys 2023, 10.2).
#ifndef CAPLET_TEXTURES_MAPPING_CL
#define CAPLET_TEXTURES_MAPPING_CL

#include "textures/texture_types.cl"

// TextureST holds coordinates, and their changes along the sides of the place.
typedef struct {
  float2 st, dx, dy;
} TextureST;

// TextureXYZ is a point of space with the sides of the place, under a matrix.
typedef struct {
  float3 p, dx, dy;
} TextureXYZ;

static inline TextureXYZ texture_xyz(const TexturePoint* at, __global const float* m) {
  const TextureXYZ out = {transform_point(m, at->place.p), transform_vector(m, at->place.dpdx),
                          transform_vector(m, at->place.dpdy)};
  return out;
}

// s is the angle from +z over pi, t the angle around it from +x, in turns.
static inline TextureST spherical_st(TextureXYZ at) {
  const float across2 = at.p.x * at.p.x + at.p.y * at.p.y, across = sqrt(across2);
  const float around = atan2(at.p.y, at.p.x) * (0.5f * CAPLET_INV_PI);
  TextureST out = {
      (float2)(atan2(across, at.p.z) * CAPLET_INV_PI, around < 0.0f ? around + 1.0f : around),
      (float2)(0.0f), (float2)(0.0f)};
  if (!(across2 > 0.0f)) return out;
  const float3 ds = (float3)(at.p.x * at.p.z, at.p.y * at.p.z, -across2) *
                    (CAPLET_INV_PI / ((across2 + at.p.z * at.p.z) * across));
  const float3 dt = (float3)(-at.p.y, at.p.x, 0.0f) * (0.5f * CAPLET_INV_PI / across2);
  out.dx = (float2)(dot(ds, at.dx), dot(dt, at.dx));
  out.dy = (float2)(dot(ds, at.dy), dot(dt, at.dy));
  return out;
}

// s is the angle around z from -x, in turns, t is z.
static inline TextureST cylindrical_st(TextureXYZ at) {
  const float across2 = at.p.x * at.p.x + at.p.y * at.p.y;
  TextureST out = {(float2)(0.5f + atan2(at.p.y, at.p.x) * (0.5f * CAPLET_INV_PI), at.p.z),
                   (float2)(0.0f, at.dx.z), (float2)(0.0f, at.dy.z)};
  if (!(across2 > 0.0f)) return out;
  const float3 ds = (float3)(-at.p.y, at.p.x, 0.0f) * (0.5f * CAPLET_INV_PI / across2);
  out.dx.x = dot(ds, at.dx);
  out.dy.x = dot(ds, at.dy);
  return out;
}

// Returns the coordinates by `mapping`, a field of that type.
static inline TextureST texture_st(const TexturePoint* at, __global const float* mapping) {
  const uint kind = as_uint(mapping[0]);
  __global const float* m = mapping + 1;
  if (kind == CAPLET_MAPPING_UV) {
    const float2 scale = (float2)(m[0], m[1]);
    const TextureST out = {(float2)(m[0] * at->place.uv.x + m[2], m[1] * at->place.uv.y + m[3]),
                           scale * at->place.duvdx, scale * at->place.duvdy};
    return out;
  }
  const TextureXYZ xyz = texture_xyz(at, m);
  if (kind == CAPLET_MAPPING_SPHERICAL) return spherical_st(xyz);
  if (kind == CAPLET_MAPPING_CYLINDRICAL) return cylindrical_st(xyz);
  const TextureST planar = {xyz.p.xy, xyz.dx.xy, xyz.dy.xy};
  return planar;
}

#endif
