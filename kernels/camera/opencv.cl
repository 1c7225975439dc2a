// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is a pinhole with OpenCV's distortion (host/scene/cameras/opencv.h). y goes down in its
// formulas, and up on the image plane.
#ifndef CAPLET_CAMERA_OPENCV_CL
#define CAPLET_CAMERA_OPENCV_CL

#include "camera/camera_types.cl"

// Where a point of the image plane comes to lie, and the slopes of that by x and by y.
typedef struct {
  float2 place, by_x, by_y;
} OpencvDistorted;

static inline OpencvDistorted opencv_distorted(__global const CameraRecord* camera, float2 at) {
  __global const float* k = camera->distortion;  // k1 to k6, p1, p2
  const float x = at.x, y = at.y, r2 = x * x + y * y, p1 = k[6], p2 = k[7];
  const float over = 1.0f + r2 * (k[0] + r2 * (k[1] + r2 * k[2])),
              under = 1.0f + r2 * (k[3] + r2 * (k[4] + r2 * k[5])), radial = over / under;
  const float slope = (k[0] + r2 * (2.0f * k[1] + 3.0f * r2 * k[2]) -
                       radial * (k[3] + r2 * (2.0f * k[4] + 3.0f * r2 * k[5]))) /
                      under;
  const float across = 2.0f * x * y * slope + 2.0f * (p1 * x + p2 * y);
  OpencvDistorted out;
  out.place = (float2)(x * radial + 2.0f * p1 * x * y + p2 * (r2 + 2.0f * x * x),
                       y * radial + p1 * (r2 + 2.0f * y * y) + 2.0f * p2 * x * y);
  out.by_x = (float2)(radial + 2.0f * x * x * slope + 2.0f * p1 * y + 6.0f * p2 * x, across);
  out.by_y = (float2)(across, radial + 2.0f * y * y * slope + 6.0f * p1 * y + 2.0f * p2 * x);
  return out;
}

static inline float opencv_area(const OpencvDistorted* of) {
  return of->by_x.x * of->by_y.y - of->by_x.y * of->by_y.x;
}

// Returns whether the picture is turned over there, along one way or along both.
static inline int opencv_is_folded(const OpencvDistorted* of) {
  return !(opencv_area(of) > 0.0f && of->by_x.x + of->by_y.y > 0.0f);
}

// Inverts opencv_distorted by Newton's method, in steps that stay on this side of a fold.
static inline float2 opencv_undistorted(__global const CameraRecord* camera, float2 place) {
  if (all(vload8(0, camera->distortion) == (float8)(0.0f))) return place;
  float2 at = (float2)(0.0f);
  OpencvDistorted now = opencv_distorted(camera, at);
  for (int i = 0; i < 24; ++i) {
    const float2 left = place - now.place;
    float2 step = (float2)(left.x * now.by_y.y - left.y * now.by_y.x,
                           left.y * now.by_x.x - left.x * now.by_x.y) /
                  opencv_area(&now);
    OpencvDistorted next = opencv_distorted(camera, at + step);
    for (int halvings = 0; opencv_is_folded(&next) && halvings < 24; ++halvings) {
      step *= 0.5f;
      next = opencv_distorted(camera, at + step);
    }
    if (opencv_is_folded(&next)) break;
    at += step;
    now = next;
    if (length(step) <= 1e-7f * (1.0f + length(at))) break;
  }
  return at;
}

static inline float2 opencv_seen(__global const CameraRecord* camera, float2 raster) {
  const float2 place = plane_place(camera, raster);
  return opencv_undistorted(camera, (float2)(place.x, -place.y));
}

static inline float opencv_ray(__global const CameraRecord* camera,
                               __global const float* camera_table, float2 raster, float2 u_lens,
                               float3* origin, float3* direction) {
  (void)camera_table, (void)u_lens, (void)origin;
  const float2 seen = opencv_seen(camera, raster);
  *direction = (float3)(seen.x, -seen.y, 1.0f);
  return 1.0f;
}

static inline float2 opencv_spread(__global const CameraRecord* camera,
                                   __global const float* camera_table, float2 raster) {
  (void)camera_table;
  const float2 seen = opencv_seen(camera, raster);
  const OpencvDistorted of = opencv_distorted(camera, seen);
  return (float2)(0.0f, plane_spread(camera) /
                            (sqrt(fmax(opencv_area(&of), 1e-6f)) * length((float3)(seen, 1.0f))));
}

#endif
