// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is the control flow of a path, and the sample dimensions that its decisions take.
//
//   generate -> queue
//   repeat: extend (closest hits) -> shade (ends paths or fills queue_next and queue_shadow)
//           -> connect (shadow rays)
//           -> sort_sums, sort_prefix, sort_scatter (queue_next into queue, spatially sorted)
//   resolve (radiance to film)
#ifndef CAPLET_STAGES_PATH_CL
#define CAPLET_STAGES_PATH_CL

#include "samplers/samplers.cl"
#include "shared/records.h"

// path_flags
#define PATH_SPECULAR \
  1u  // the last scattering was a delta: light sampling could not have found what is hit next
#define PATH_FROM_PLANE 2u  // a camera ray that begins at the clipping plane
#define PATH_INSIDE 4u      // with a clipping plane: the ray began within a closed solid
#define PATH_CROSSED 8u     // with a clipping plane: the path has crossed a surface
#define PATH_DEPTH_SHIFT 8

// These are addresses of random numbers (dimensions.def).
enum {
#define CAMERA_DIMENSION(name) camera_dimension_##name,
#define SCATTERING_DIMENSION(name)
#include "shared/dimensions.def"
#undef CAMERA_DIMENSION
#undef SCATTERING_DIMENSION
  camera_dimension_count
};
enum {
#define CAMERA_DIMENSION(name)
#define SCATTERING_DIMENSION(name) scattering_dimension_##name,
#include "shared/dimensions.def"
#undef CAMERA_DIMENSION
#undef SCATTERING_DIMENSION
  scattering_dimension_count
};
enum {
#define CAMERA_DIMENSION(name)
#define SCATTERING_DIMENSION(name)
#define APART_DIMENSION(name, address) apart_dimension_##name = address,
#define MEDIUM_DIMENSION(name, address) medium_dimension_##name = address,
#define HASHED_DIMENSION(name, salt)
#include "shared/dimensions.def"
#undef CAMERA_DIMENSION
#undef SCATTERING_DIMENSION
  no_medium_dimension
};
#define CAMERA_DIMENSION(name)
#define SCATTERING_DIMENSION(name)
#define HASHED_DIMENSION(name, salt) \
  static inline uint hashed_dimension_##name(void) { return salt; }
#include "shared/dimensions.def"
#undef CAMERA_DIMENSION
#undef SCATTERING_DIMENSION
#define CAMERA_SAMPLE(name) camera_dimension_##name
#define SCATTERING_SAMPLE(name, depth) \
  (camera_dimension_count + scattering_dimension_count * (depth) + scattering_dimension_##name)
#define APART_SAMPLE(name) apart_dimension_##name
#define MEDIUM_SAMPLE(name, depth) (medium_dimension_##name + (depth))
#define HASHED_SAMPLE(name) hashed_dimension_##name()

// Returns the density of a scattered direction for weighting against light samples. Without MIS it
// is so small that scattered rays find only lights that samples cannot find.
static inline float path_pdf(__global const ViewRecord* view, float pdf) {
  return (view->strategy & CAPLET_STRATEGY_NO_MIS) != 0u ? 0x1p-60f : pdf;
}

// Returns PATH_SPECULAR where the next hit counts in full.
static inline uint path_flag(__global const ViewRecord* view, int specular) {
  return specular || (view->strategy & CAPLET_STRATEGY_NO_LIGHTS) != 0u ? PATH_SPECULAR : 0u;
}

// Returns whether a path's ray still begins at the camera, with these flags: surfaces that let
// light pass set t_min.
static inline int path_begins(uint flags, const RayRecord* ray) {
  return (flags >> PATH_DEPTH_SHIFT) == 0u &&
         (ray->t_min == 0.0f || (flags & PATH_FROM_PLANE) != 0u);
}

// Returns a key for the HASHED_DIMENSIONs of a scattering.
static inline uint path_hash(PathSample at, uint depth) {
  return hash_combine(hash_combine(at.seed ^ HASHED_SAMPLE(scattering), at.sample), depth);
}

// Returns the place of pixel number `pixel` of a window in the full image. A window's pixels are
// numbered tile by tile of 8 x 8, so that camera rays of near numbers are neighbours: tiles in rows
// from the top left, and pixels within each likewise; those at the right and lower edges are
// smaller.
static inline uint2 window_pixel(__global const BatchRecord* batch, uint pixel) {
  const uint width = batch->window_width, in_window = batch->pixel_begin + pixel;
  const uint band = in_window / (8u * width), in_band = in_window - band * 8u * width;
  const uint rows = min(8u, batch->window_height - 8u * band);
  const uint tile = in_band / (8u * rows), in_tile = in_band - tile * 8u * rows;
  const uint columns = min(8u, width - 8u * tile);
  return (uint2)(batch->window_x + 8u * tile + in_tile % columns,
                 batch->window_y + 8u * band + in_tile / columns);
}

// Returns pixel number `pixel` of a batch: its place in the full image, and its first sample.
static inline PixelRecord batch_pixel(__global const BatchRecord* batch, uint pixel) {
  if (batch->listed) return ((__global const PixelRecord*)(batch + 1))[pixel];
  const uint2 place = window_pixel(batch, pixel);
  PixelRecord out;
  out.x = place.x;
  out.y = place.y;
  out.sample_begin = batch->sample_begin;
  return out;
}

// Returns the number of a path of a batch: that of sample number `sample` of pixel number `pixel`.
static inline uint path_number(__global const BatchRecord* batch, uint pixel, uint sample) {
  return batch->by_sample ? sample * batch->pixel_count + pixel
                          : pixel * batch->sample_count + sample;
}

// Returns the sample of path number `path` of a batch.
static inline PathSample path_sample(__global const BatchRecord* batch,
                                     __global const ViewRecord* view, uint path) {
  const PixelRecord pixel =
      batch_pixel(batch, batch->by_sample ? path % batch->pixel_count : path / batch->sample_count);
  return sample_of_pixel(view, pixel.x, pixel.y,
                         pixel.sample_begin + (batch->by_sample ? path / batch->pixel_count
                                                                : path % batch->sample_count));
}

// Returns the ray of a path that goes on from a point.
static inline RayRecord path_onward(float3 origin, float3 direction) {
  RayRecord ray;
  ray.ox = origin.x;
  ray.oy = origin.y;
  ray.oz = origin.z;
  ray.t_min = 0.0f;
  ray.dx = direction.x;
  ray.dy = direction.y;
  ray.dz = direction.z;
  ray.t_max = INFINITY;
  return ray;
}

// Applies Russian roulette: returns whether a path goes on, and scales its throughput. The square
// root keeps paths longer than their throughput alone would, and the first three scatterings always
// go on: with pbrt's rule, by the throughput itself from the second scattering on, the product of
// variance and time doubles on a scene of capsules under a sky. eta_scale takes the squared indices
// of refractions out of the throughput.
static inline int path_survives(PathSample at, uint depth, float eta_scale, float4* throughput) {
  const float survival = fmin(1.0f, sqrt(max4(fabs(*throughput)) * eta_scale));
  if (depth < 3 || survival >= 1.0f) return 1;
  if (sampler_1d(at, SCATTERING_SAMPLE(roulette, depth)) >= survival) return 0;
  *throughput /= survival;
  return 1;
}

#endif
