// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Adds finished paths to the film: one work-item a pixel, or a layer of it, adds its samples to
// sums that do not depend on the order of adding.
#include "math/exact.cl"
#include "math/vector.cl"
#include "math/spectrum.cl"
#include "stages/layers.cl"
#include "stages/path.cl"
#include "stages/slots.cl"

// Returns CIE XYZ of a sample, scaled down to the view's limit if it is beyond; a sample that is
// not a number is black and counted.
static inline float3 sample_xyz(const Stage* g, uint path, int counted) {
  const float4 radiance = g->radiance.path_radiance[path];
  const float3 xyz =
      xyz_from_spectrum(g->observer.observer, radiance, g->carried.path_wavelengths[path],
                        g->carried.path_wavelength_pdfs[path]);
  if (all(isfinite(radiance)) && all(isfinite(xyz))) {
    const float limit = g->view.view->sample_limit,
                peak = fmax(fabs(xyz.x), fmax(fabs(xyz.y), fabs(xyz.z)));
    return limit > 0.0f && peak > limit ? (limit / peak) * xyz : xyz;
  }
  if (counted) atomic_inc(&g->counters.counters[counter_not_finite]);
  return (float3)(0.0f);
}

// Returns how many samples of a pixel the batch has: those of record `number` and of all that
// follow it, if they are of the same pixel. 0: a record before this one counts them.
static inline uint samples_of_pixel(__global const BatchRecord* batch, uint number,
                                    PixelRecord pixel) {
  if (!batch->listed) return batch->sample_count;
  __global const PixelRecord* records = (__global const PixelRecord*)(batch + 1);
  if (number > 0u && records[number - 1u].x == pixel.x && records[number - 1u].y == pixel.y)
    return 0u;
  uint end = number + 1u;
  while (end < batch->pixel_count && records[end].x == pixel.x && records[end].y == pixel.y) end++;
  return (end - number) * batch->sample_count;
}

// Returns the path of a pixel's sample number `i`, whose first record is `number`.
static inline uint path_of_pixel(__global const BatchRecord* batch, uint number, uint i) {
  if (!batch->listed) return path_number(batch, number, i);
  return path_number(batch, number + i / batch->sample_count, i % batch->sample_count);
}

// Adds the `samples` samples of the batch's pixel `number` to `count` sums of `words` words at
// `film`. sample: a float4 as a function of the number `path` of a path.
#define ADD_SAMPLES(count, words, unit, sample)                            \
  {                                                                        \
    ulong4 sums[words];                                                    \
    for (int w = 0; w < words; ++w)                                        \
      sums[w] = first ? (ulong4)(0)                                        \
                      : (ulong4)(film[w], film[count > 1 ? words + w : 0], \
                                 film[count > 2 ? 2 * words + w : 0], 0);  \
    for (uint i = 0; i < samples; ++i) {                                   \
      const uint path = path_of_pixel(batch, number, i);                   \
      exact_add(sums, words, sample, unit);                                \
    }                                                                      \
    for (int w = 0; w < words; ++w) {                                      \
      film[w] = sums[w].x;                                                 \
      if (count > 1) film[words + w] = sums[w].y;                          \
      if (count > 2) film[2 * words + w] = sums[w].z;                      \
    }                                                                      \
  }

// radiance_layer_<name> returns the value of a sample.
#define RADIANCE_LAYER(name, option, channels, how, count, words, unit, value) \
  static inline float4 radiance_layer_##name(float3 xyz, uint replicate) {     \
    const float3 first = replicate == 0u ? xyz : (float3)(0.0f);               \
    (void)first;                                                               \
    return (float4)(value, 0.0f);                                              \
  }
#define HIT_LAYER(name, option, channels, how, count, words, unit, value)
#define ID_LAYER(name, option, channel, value)
#define SLOT_LAYER(name, option, channels, how, words, unit, value)
#include "shared/layers.def"
#undef RADIANCE_LAYER
#undef HIT_LAYER
#undef ID_LAYER
#undef SLOT_LAYER

// Returns the number of samples [begin, begin + count), and in the upper half that of those of the
// first replicate.
static inline ulong sample_counts(uint begin, uint count) {
  const uint end = begin + count;
  return (ulong)(end / 2u + end % 2u - (begin / 2u + begin % 2u)) << 32 | count;
}

static inline float4 layer_at(__global const float* values, const int count) {
  return count == 3 ? (float4)(vload3(0, values), 0.0f) : (float4)(values[0], 0.0f, 0.0f, 0.0f);
}

static void stage_item(const Stage* g, uint item) {
  __global const BatchRecord* batch = g->batch.batch;
  __global const ViewRecord* view = g->view.view;
  const uint apart = batch->layers_apart, number = apart ? item % batch->pixel_count : item;
  uint left = apart ? item / batch->pixel_count : 0u;  // layers before the one that is this item's
#define TAKES_LAYER (!apart || left-- == 0u)
  const PixelRecord pixel = batch_pixel(batch, number);
  const uint samples = samples_of_pixel(batch, number, pixel);
  if (samples == 0u) return;
  const uint place =
      (pixel.y - view->crop_y) * view->crop_width + (pixel.x - view->crop_x) - batch->film_begin;
  __global ulong* film = g->film.film + (size_t)place * batch->film_words;
  const int first = batch->first != 0u;
  if (left == 0u) *film = (first ? 0ul : *film) + sample_counts(pixel.sample_begin, samples);
  ++film;
  const uint layers = batch->layers;
  const int color = batch->color_exponent, length = batch->length_exponent;
  uint offset = 0;  // of the layer in path_layers
#define RADIANCE_LAYER(name, option, channels, how, count, words, unit, value)            \
  if (layers & (1u << layer_##name)) {                                                    \
    if (TAKES_LAYER)                                                                      \
      ADD_SAMPLES(count, words, unit,                                                     \
                  radiance_layer_##name(sample_xyz(g, path, layer_##name == layer_color), \
                                        replicate_of(pixel.sample_begin + i)))            \
    film += (count) * (words);                                                            \
  }
#define HIT_LAYER(name, option, channels, how, count, words, unit, value)                       \
  if (layers & (1u << layer_##name)) {                                                          \
    if (TAKES_LAYER)                                                                            \
      ADD_SAMPLES(count, words, unit,                                                           \
                  layer_at(layers_of_path(batch, path, g->layers.path_layers) + offset, count)) \
    film += (count) * (words);                                                                  \
    offset += count;                                                                            \
  }
#define ID_LAYER(name, option, channel, value)                                             \
  if (layers & (1u << layer_##name)) {                                                     \
    const int takes = TAKES_LAYER;                                                         \
    if (takes && first) *film = 0;                                                         \
    for (uint i = 0; takes && i < samples; ++i) {                                          \
      const uint path = path_of_pixel(batch, number, i);                                   \
      const uint id = as_uint(layers_of_path(batch, path, g->layers.path_layers)[offset]); \
      *film = max(*film, ~(((ulong)(pixel.sample_begin + i) << 32) | id));                 \
    }                                                                                      \
    ++film;                                                                                \
    ++offset;                                                                              \
  }
#define SLOT_LAYER(name, option, channels, how, words, unit, value)                              \
  if (layers & (1u << layer_##name)) {                                                           \
    const int takes = TAKES_LAYER;                                                               \
    if (takes && first) slots_clear(film, words);                                                \
    for (uint i = 0; takes && i < samples; ++i) {                                                \
      const uint path = path_of_pixel(batch, number, i);                                         \
      const float v = layers_of_path(batch, path, g->layers.path_layers)[offset];                \
      if (as_uint(v) != CAPLET_NONE)                                                             \
        slots_add(film, words, slot_key_##how(v), words == 2 ? slot_whole_units(v, unit) : 0ul); \
    }                                                                                            \
    film += CAPLET_SLOTS * (words);                                                              \
    ++offset;                                                                                    \
  }
#include "shared/layers.def"
#undef RADIANCE_LAYER
#undef HIT_LAYER
#undef ID_LAYER
#undef SLOT_LAYER
}
