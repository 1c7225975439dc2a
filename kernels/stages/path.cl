// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The control flow of a path, and which sample dimensions its decisions take.
//
//   generate -> queue
//   repeat: extend (closest hits) -> shade (ends paths or fills queue_next and queue_shadow) -> connect (shadow rays)
//           -> sort_prefix, sort_scatter (queue_next into queue, spatially sorted)
//   resolve (radiance to film)
#ifndef CAPLET_STAGES_PATH_CL
#define CAPLET_STAGES_PATH_CL

#include "math/rng.cl"
#include "shared/records.h"

// path_flags
#define PATH_SPECULAR 1u   // the last scattering was a delta: light sampling could not have found what is hit next
#define PATH_DEPTH_SHIFT 8

// Pairs of sample dimensions: three for the camera, four for each scattering.
#define SAMPLE_FILTER 0
#define SAMPLE_LENS 1
#define SAMPLE_WAVELENGTH 2
#define SAMPLE_BSDF(depth) (3 + 4 * (depth))
#define SAMPLE_LIGHT(depth) (4 + 4 * (depth))
#define SAMPLE_CHOICES(depth) (5 + 4 * (depth))   // x: which light, y: which lobe
#define SAMPLE_ROULETTE(depth) (6 + 4 * (depth))

typedef struct {
  uint x, y;  // pixel of the full image
  uint sample;
  uint seed;  // of the pixel
} PathSample;

// Where pixel number `pixel` of a batch is in the full image. A window's pixels are numbered tile by tile of 8 x 8, so that camera rays
// of near numbers are neighbours: tiles in rows from the top left, within each likewise; those at the right and lower edges are smaller.
static inline uint2 batch_pixel(__global const BatchRecord* batch, uint pixel) {
  const uint width = batch->window_width, in_window = batch->pixel_begin + pixel;
  const uint band = in_window / (8u * width), in_band = in_window - band * 8u * width;
  const uint rows = min(8u, batch->window_height - 8u * band);
  const uint tile = in_band / (8u * rows), in_tile = in_band - tile * 8u * rows;
  const uint columns = min(8u, width - 8u * tile);
  return (uint2)(batch->window_x + 8u * tile + in_tile % columns, batch->window_y + 8u * band + in_tile / columns);
}

// Of path number `path` of a batch.
static inline PathSample path_sample(__global const BatchRecord* batch, uint seed, uint path) {
  const uint2 pixel = batch_pixel(batch, path / batch->sample_count);
  PathSample s;
  s.x = pixel.x;
  s.y = pixel.y;
  s.sample = batch->sample_begin + path % batch->sample_count;
  s.seed = pixel_seed(s.x, s.y, seed);
  return s;
}

#endif
