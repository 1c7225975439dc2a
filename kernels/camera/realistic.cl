// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This camera sees through a lens of several surfaces, as pbrt-v4's realistic camera does (Kolb,
// Mitchell and Hanrahan 1995). Its table (host/scene/cameras/realistic.cpp) has 8 numbers, then 4
// of each surface from the film to the scene, 4 of each exit pupil, and the mask of the stop.
#ifndef CAPLET_CAMERA_REALISTIC_CL
#define CAPLET_CAMERA_REALISTIC_CL

#include "camera/camera_types.cl"

// A lens in `camera_table`, in front of the film at z = 0. Lengths are camera units.
typedef struct {
  __global const float* surfaces;  // radius, z, index on the film's side over the other, half width
  __global const float* pupils;    // x0, x1, y0, y1 on the plane z = rear_z, of film points (r, 0)
  __global const float* mask;
  uint surface_count, pupil_count, mask_width, mask_height;
  float rear_z, pupils_per_length, over_image_distance;
} RealisticLens;

static inline RealisticLens realistic_lens(__global const CameraRecord* camera,
                                           __global const float* camera_table) {
  __global const float* table = camera_table + camera->lens_begin;
  RealisticLens lens;
  lens.surface_count = (uint)table[0];
  lens.rear_z = table[1];
  lens.pupil_count = (uint)table[2];
  lens.pupils_per_length = table[3];
  lens.over_image_distance = table[4];
  lens.mask_width = (uint)table[5];
  lens.mask_height = (uint)table[6];
  lens.surfaces = table + 8;
  lens.pupils = lens.surfaces + 4u * lens.surface_count;
  lens.mask = lens.pupils + 4u * lens.pupil_count;
  return lens;
}

// Returns how much passes the stop at `at`, in units of its half width: the mask between its
// texels' middles, as pbrt-v4 looks it up.
static inline float realistic_mask(const RealisticLens* lens, float2 at) {
  if (lens->mask_width == 0u) return 1.0f;
  const int2 size = (int2)((int)lens->mask_width, (int)lens->mask_height);
  const float2 texel = 0.5f * (float2)(1.0f + at.x, 1.0f - at.y) * convert_float2(size) - 0.5f;
  const float2 low = floor(texel), share = texel - low;
  const int2 first = clamp(convert_int2(low), (int2)(0), size - 1),
             second = clamp(convert_int2(low) + 1, (int2)(0), size - 1);
  __global const float *upper = lens->mask + (size_t)first.y * lens->mask_width,
                       *lower = lens->mask + (size_t)second.y * lens->mask_width;
  return mix(mix(upper[first.x], upper[second.x], share.x),
             mix(lower[first.x], lower[second.x], share.x), share.y);
}

// Moves a ray to a surface {radius, z, ...}. Returns whether it meets it, and the normal that faces
// the ray. The root of the equation is the one near the surface's vertex, in the form without
// cancellation.
static inline int realistic_move(float4 surface, float3* o, float3 d, float3* normal) {
  const float3 from = (float3)((*o).x, (*o).y, (*o).z - surface.y);
  *normal = (float3)(0.0f, 0.0f, -1.0f);
  if (surface.x == 0.0f) {
    *o -= (from.z / d.z) * d;
    return 1;
  }
  const float b = dot(from, d) + surface.x * d.z, c = dot(from, from) + 2.0f * surface.x * from.z;
  const float square = b * b - c;
  if (!(square >= 0.0f)) return 0;
  const float root = copysign(sqrt(square), surface.x);
  const float t = b * surface.x > 0.0f ? -c / (b + root) : root - b;
  if (!(t >= 0.0f)) return 0;
  *o += t * d;
  const float3 out = (from + t * d + (float3)(0.0f, 0.0f, surface.x)) / surface.x;
  *normal = dot(out, d) < 0.0f ? out : -out;
  return 1;
}

// Bends a unit direction by Snell's law. eta: the index before over that behind. Returns whether
// it passes.
static inline int realistic_bend(float3 normal, float eta, float3* d) {
  const float cosine = -dot(normal, *d), sine2 = eta * eta * (1.0f - cosine * cosine);
  if (!(sine2 < 1.0f)) return 0;
  *d = normalize(eta * *d + (eta * cosine - sqrt(1.0f - sine2)) * normal);
  return 1;
}

// Follows a ray through the lens. Returns how much of it passes the stop; 0 if it does not leave.
static inline float realistic_trace(const RealisticLens* lens, float3* o, float3* d) {
  float passes = 1.0f;
  for (uint i = 0; i < lens->surface_count; i++) {
    const float4 surface = vload4(i, lens->surfaces);
    float3 normal;
    if (!realistic_move(surface, o, *d, &normal)) return 0.0f;
    const float2 at = (*o).xy;
    if (dot(at, at) > surface.w * surface.w) return 0.0f;
    if (surface.x == 0.0f)
      passes *= realistic_mask(lens, at / surface.w);
    else if (!realistic_bend(normal, surface.z, d))
      return 0.0f;
  }
  return passes;
}

// The weight is that of a film's irradiance, the fourth power of the cosine over the distance's
// square, in one sample of the exit pupil. A ray that is stopped has the weight 0; it then goes
// nearer by the pupil's middle, so that layers show what is there.
static inline float realistic_ray(__global const CameraRecord* camera,
                                  __global const float* camera_table, float2 raster, float2 u_lens,
                                  float3* origin, float3* direction) {
  const RealisticLens lens = realistic_lens(camera, camera_table);
  const float2 film = -plane_place(camera, raster);
  const float r = length(film);
  const float2 across = r > 0.0f ? film / r : (float2)(1.0f, 0.0f);
  const uint pupil = min((uint)(r * lens.pupils_per_length), lens.pupil_count - 1u);
  const float4 bounds = vload4(pupil, lens.pupils);
  for (int attempt = 0; attempt < 4; attempt++) {
    const float2 on = mix(bounds.xz, bounds.yw, u_lens);
    const float2 rear =
        (float2)(across.x * on.x - across.y * on.y, across.y * on.x + across.x * on.y);
    *origin = (float3)(film, 0.0f);
    *direction = normalize((float3)(rear - film, lens.rear_z));
    const float cosine = (*direction).z, cosine2 = cosine * cosine;
    const float passes = realistic_trace(&lens, origin, direction);
    if (passes > 0.0f) {
      const float area = (bounds.y - bounds.x) * (bounds.w - bounds.z);
      return attempt > 0 ? 0.0f : passes * area * cosine2 * cosine2 / (lens.rear_z * lens.rear_z);
    }
    u_lens = 0.5f * u_lens + 0.25f;
  }
  return -1.0f;
}

// That of a pinhole which makes pictures of the same size.
static inline float2 realistic_spread(__global const CameraRecord* camera,
                                      __global const float* camera_table, float2 raster) {
  const RealisticLens lens = realistic_lens(camera, camera_table);
  const float2 place = plane_place(camera, raster) * lens.over_image_distance;
  return (float2)(0.0f,
                  plane_spread(camera) * lens.over_image_distance / length((float3)(place, 1.0f)));
}

#endif
