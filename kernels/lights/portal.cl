// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is an infinite light seen through a rectangle: no light comes from elsewhere, and only
// points in front of it receive light. The image is rectified (Bitterli, Novak and Jarosz,
// "Portal-masked environment map sampling", 2015): u and v are linear in the angles at which a
// direction is seen along either side, so a point sees a rectangle of the image through the portal.
// A point of that rectangle is sampled in proportion to the image, by sums over rectangles of its
// texels' weights. These sums are whole numbers, so that differences of large sums are exact.
#ifndef CAPLET_LIGHTS_PORTAL_CL
#define CAPLET_LIGHTS_PORTAL_CL

#include "lights/light_types.cl"

// PortalWindow is the part of the image that a point sees, in texels, and the texels that hold its
// ends.
typedef struct {
  float2 low, high;
  uint x0, x1, y0, y1;
} PortalWindow;

static inline ulong portal_sum_to(const Picture* picture, uint x, uint y) {
  __global const float* at = floats_at(picture->cdf, 2u * ((size_t)y * (picture->width + 1u) + x));
  return ((ulong)as_uint(at[1]) << 32) | as_uint(at[0]);
}

// Returns the weight of the texels of columns [x0, x1) and rows [y0, y1).
static inline float portal_block(const Picture* picture, uint x0, uint x1, uint y0, uint y1) {
  if (x0 >= x1 || y0 >= y1) return 0.0f;
  return (float)((portal_sum_to(picture, x1, y1) - portal_sum_to(picture, x0, y1)) -
                 (portal_sum_to(picture, x1, y0) - portal_sum_to(picture, x0, y0)));
}

// Returns the weight of columns [x0, x1) between the window's lower and upper end.
static inline float portal_columns(const Picture* picture, const PortalWindow* window, uint x0,
                                   uint x1) {
  const uint top = window->y0, bottom = window->y1;
  if (top == bottom)
    return (window->high.y - window->low.y) * portal_block(picture, x0, x1, top, top + 1u);
  return ((float)(top + 1u) - window->low.y) * portal_block(picture, x0, x1, top, top + 1u) +
         portal_block(picture, x0, x1, top + 1u, bottom) +
         (window->high.y - (float)bottom) * portal_block(picture, x0, x1, bottom, bottom + 1u);
}

// Returns the weight of the window's part before column x, which begins within the window.
static inline float portal_before_column(const Picture* picture, const PortalWindow* window,
                                         uint x) {
  if (x <= window->x0) return 0.0f;
  return ((float)(window->x0 + 1u) - window->low.x) *
             portal_columns(picture, window, window->x0, window->x0 + 1u) +
         portal_columns(picture, window, window->x0 + 1u, x);
}

// Returns the weight of the window's part of column x before row y, which begins within the window;
// for one unit of x.
static inline float portal_before_row(const Picture* picture, const PortalWindow* window, uint x,
                                      uint y) {
  if (y <= window->y0) return 0.0f;
  return ((float)(window->y0 + 1u) - window->low.y) *
             portal_block(picture, x, x + 1u, window->y0, window->y0 + 1u) +
         portal_block(picture, x, x + 1u, window->y0 + 1u, y);
}

static inline float portal_total(const Picture* picture, const PortalWindow* window) {
  if (window->x0 == window->x1)
    return (window->high.x - window->low.x) *
           portal_columns(picture, window, window->x0, window->x0 + 1u);
  return portal_before_column(picture, window, window->x1) +
         (window->high.x - (float)window->x1) *
             portal_columns(picture, window, window->x1, window->x1 + 1u);
}

// Returns the place in the image of a direction in the portal's space that goes out (z > 0).
static inline float2 portal_uv(float3 d) {
  return (float2)(atan2(d.x, d.z), atan2(d.y, d.z)) * CAPLET_INV_PI + 0.5f;
}

// Returns solid angle over area of the unit square.
static inline float portal_stretch(float3 w) {
  return CAPLET_PI * CAPLET_PI * (w.y * w.y + w.z * w.z) * (w.x * w.x + w.z * w.z) / w.z;
}

// Computes the window of a point. Returns 0 if p is not in front of the portal.
static inline int portal_window(__global const float* data, const Picture* picture, float3 p,
                                PortalWindow* window) {
  const float3 low = light_turned(portal_portal_from_world(data), load3(portal_corner(data)) - p);
  if (!(low.z > 0.0f)) return 0;
  const float3 high = (float3)(low.x + portal_width(data), low.y + portal_height(data), low.z);
  const float2 size = (float2)((float)picture->width, (float)picture->height);
  window->low = clamp(portal_uv(low), 0.0f, 1.0f) * size;
  window->high = clamp(portal_uv(high), 0.0f, 1.0f) * size;
  window->x0 = min((uint)window->low.x, picture->width - 1u);
  window->x1 = min((uint)window->high.x, picture->width - 1u);
  window->y0 = min((uint)window->low.y, picture->height - 1u);
  window->y1 = min((uint)window->high.y, picture->height - 1u);
  return 1;
}

static inline float4 portal_texel(const Spectra* spectra, const Picture* picture,
                                  __global const LightRecord* light, uint x, uint y,
                                  float4 lambda) {
  if (picture->square) return light_spectrum(spectra, light, lambda, 1.0f);
  return sigmoid_illuminant(picture_illuminant(spectra, light),
                            picture_texel(picture, (size_t)y * picture->width + x), lambda) *
         light->scale;
}

// Returns the density (solid angle) of direction w of the portal's space, in texel (x, y) of a
// window whose weight is `total`.
static inline float portal_density(const Picture* picture, uint x, uint y, float total, float3 w) {
  const float density = portal_block(picture, x, x + 1u, y, y + 1u) / total *
                        ((float)picture->width * (float)picture->height) / portal_stretch(w);
  return density < INFINITY ? density : 0.0f;
}

static inline int portal_light_sample(const Scene* scene, __global const LightRecord* light,
                                      float3 p, float4 lambda, float2 u, LightSample* s) {
  __global const float* data = light_data_of(&scene->lights, light);
  const Picture picture = picture_of(&scene->lights, portal_picture(data));
  PortalWindow window;
  if (!portal_window(data, &picture, p, &window)) return 0;
  const float total = portal_total(&picture, &window);
  if (!(total > 0.0f)) return 0;

  const float to_x = u.x * total;
  uint low = window.x0, high = window.x1;
  while (low < high) {
    const uint middle = (low + high) / 2u;
    if (portal_before_column(&picture, &window, middle + 1u) > to_x)
      high = middle;
    else
      low = middle + 1u;
  }
  const uint x = low;
  const float column = portal_columns(&picture, &window, x, x + 1u), to_y = u.y * column;
  low = window.y0, high = window.y1;
  while (low < high) {
    const uint middle = (low + high) / 2u;
    if (portal_before_row(&picture, &window, x, middle + 1u) > to_y)
      high = middle;
    else
      low = middle + 1u;
  }
  const uint y = low;
  const float cell = portal_block(&picture, x, x + 1u, y, y + 1u);
  if (!(column > 0.0f && cell > 0.0f)) return 0;
  const float left = fmax((float)x, window.low.x), right = fmin((float)(x + 1u), window.high.x);
  const float top = fmax((float)y, window.low.y), bottom = fmin((float)(y + 1u), window.high.y);
  const float at_x =
      clamp(left + (to_x - portal_before_column(&picture, &window, x)) / column, left, right);
  const float at_y =
      clamp(top + (to_y - portal_before_row(&picture, &window, x, y)) / cell, top, bottom);

  const float2 angle =
      ((float2)(at_x / (float)picture.width, at_y / (float)picture.height) - 0.5f) * CAPLET_PI;
  // The direction is (tan, tan, 1), scaled so that nothing overflows near the horizon.
  const float2 cosine = cos(angle), sine = sin(angle);
  const float3 w =
      unit_or((float3)(sine.x * cosine.y, sine.y * cosine.x, cosine.x * cosine.y), (float3)(0.0f));
  if (!(w.z > 0.0f)) return 0;
  s->pdf = portal_density(&picture, x, y, total, w);
  if (!(s->pdf > 0.0f)) return 0;
  __global const float* m = portal_portal_from_world(data);
  s->wi = normalize(load3(m) * w.x + load3(m + 3) * w.y + load3(m + 6) * w.z);
  s->target = p + s->wi;
  s->radiance = portal_texel(&scene->spectra, &picture, light, x, y, lambda);
  return 1;
}

static inline float4 portal_light_radiance(const Spectra* spectra, const Lights* lights,
                                           __global const LightRecord* light, float3 p, float3 wi,
                                           float4 lambda, float* pdf) {
  __global const float* data = light_data_of(lights, light);
  const Picture picture = picture_of(lights, portal_picture(data));
  const float3 w = light_turned(portal_portal_from_world(data), wi);
  PortalWindow window;
  if (!(w.z > 0.0f) || !portal_window(data, &picture, p, &window)) return (float4)(0.0f);
  const float2 at =
      clamp(portal_uv(w), 0.0f, 1.0f) * (float2)((float)picture.width, (float)picture.height);
  if (at.x < window.low.x || at.x > window.high.x || at.y < window.low.y || at.y > window.high.y)
    return (float4)(0.0f);
  const uint x = min((uint)at.x, picture.width - 1u), y = min((uint)at.y, picture.height - 1u);
  const float total = portal_total(&picture, &window);
  *pdf = total > 0.0f ? portal_density(&picture, x, y, total, w) : 0.0f;
  return portal_texel(spectra, &picture, light, x, y, lambda);
}

#endif
