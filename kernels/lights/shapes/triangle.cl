// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Samples points on a triangle, uniformly in solid angle (Arvo, "Stratified sampling of spherical
// triangles", 1995) where that is large, otherwise uniformly in area.
#ifndef CAPLET_LIGHTS_SHAPES_TRIANGLE_CL
#define CAPLET_LIGHTS_SHAPES_TRIANGLE_CL

#include "math/vector.cl"

// Below the first limit the inversion loses digits and area sampling is as good; above the second
// one the triangle fills a hemisphere.
#define CAPLET_TRIANGLE_MIN_SOLID_ANGLE 3e-3f
#define CAPLET_TRIANGLE_SMALL 0.25f
#define CAPLET_TRIANGLE_MAX_SOLID_ANGLE 6.22f

// TriangleView holds the corners relative to the point they are seen from.
typedef struct {
  float3 v0, v1, v2;
  float3 cross;       // (v1 - v0) x (v2 - v0)
  float area;         // 0: no triangle
  float solid_angle;  // 0: sampled by area
  float3 d0, d1, d2;  // unit directions to the corners
} TriangleView;

static inline TriangleView triangle_view(float3 v0, float3 v1, float3 v2, float3 p) {
  TriangleView t;
  t.v0 = v0 - p;
  t.v1 = v1 - p;
  t.v2 = v2 - p;
  t.cross = cross(v1 - v0, v2 - v0);
  t.area = 0.5f * sqrt(dot(t.cross, t.cross));
  t.solid_angle = 0.0f;
  const float l0 = dot(t.v0, t.v0), l1 = dot(t.v1, t.v1), l2 = dot(t.v2, t.v2);
  if (!(l0 > 0.0f && l1 > 0.0f && l2 > 0.0f)) return t;
  if (t.area < CAPLET_TRIANGLE_SMALL * fmin(l0, fmin(l1, l2))) return t;
  t.d0 = t.v0 / sqrt(l0);
  t.d1 = t.v1 / sqrt(l1);
  t.d2 = t.v2 / sqrt(l2);
  // The solid angle is that of Van Oosterom and Strackee, "The solid angle of a plane triangle",
  // 1983, with the triple product by differences of the corners.
  const float triple = fabs(dot(t.d0, cross(t.d1 - t.d0, t.d2 - t.d0)));
  const float omega =
      2.0f * atan2(triple, 1.0f + dot(t.d0, t.d1) + dot(t.d1, t.d2) + dot(t.d2, t.d0));
  if (omega > CAPLET_TRIANGLE_MIN_SOLID_ANGLE && omega < CAPLET_TRIANGLE_MAX_SOLID_ANGLE)
    t.solid_angle = omega;
  return t;
}

// Returns the unit vector along the part of a that is square to the unit vector b; 0 when there is
// none.
static inline float3 orthogonal_part(float3 a, float3 b) {
  const float3 o = a - b * dot(a, b);
  const float length = sqrt(dot(o, o));
  return length > 0.0f ? o / length : (float3)(0.0f);
}

static inline float3 triangle_direction(const TriangleView* t, float2 u) {
  // alpha is the angle at corner 0, between the sides towards 1 and 2.
  const float3 side1 = orthogonal_part(t->d1, t->d0), side2 = orthogonal_part(t->d2, t->d0);
  const float cos_alpha = clamp(dot(side1, side2), -1.0f, 1.0f);
  const float sin_alpha = sqrt(dot(cross(side1, side2), cross(side1, side2)));
  const float cos_c = dot(t->d0, t->d1);
  const float part = u.x * t->solid_angle;
  const float sin_part = sin(part), cos_part = cos(part);
  // s and c are sin and cos of (part - alpha). They give the corner C' on the side 0-2 that cuts
  // off `part` of the area.
  const float s = sin_part * cos_alpha - cos_part * sin_alpha;
  const float c = cos_part * cos_alpha + sin_part * sin_alpha;
  const float k1 = c - cos_alpha, k2 = s + sin_alpha * cos_c;
  const float denominator = (k2 * s + k1 * c) * sin_alpha;
  float q = denominator != 0.0f ? ((k2 * c - k1 * s) * cos_alpha - k2) / denominator : 1.0f;
  q = clamp(q, -1.0f, 1.0f);
  const float3 corner = normalize(t->d0 * q + side2 * sqrt(1.0f - q * q));
  // The point is uniform in 1 - cos along the arc from corner 1 to C'; the chord gives 1 -
  // cos(angle) without cancellation.
  const float3 chord = corner - t->d1;
  const float drop = u.y * 0.5f * dot(chord, chord);
  return t->d1 * (1.0f - drop) + orthogonal_part(corner, t->d1) * sqrt(drop * (2.0f - drop));
}

// Returns the barycentric coordinates (of corners 1 and 2) of a sampled point. *pdf: per solid
// angle when view->solid_angle > 0, else per area.
static inline float2 triangle_sample(const TriangleView* t, float2 u, float* pdf) {
  if (t->solid_angle > 0.0f) {
    const float3 direction = triangle_direction(t, u);
    const float3 e1 = t->v1 - t->v0, e2 = t->v2 - t->v0;
    const float3 h = cross(direction, e2);
    const float determinant = dot(e1, h);
    *pdf = 1.0f / t->solid_angle;
    if (determinant == 0.0f) return (float2)(1.0f / 3.0f);
    const float b1 = clamp(-dot(t->v0, h) / determinant, 0.0f, 1.0f);
    const float b2 = clamp(-dot(direction, cross(t->v0, e1)) / determinant, 0.0f, 1.0f);
    return b1 + b2 > 1.0f ? (float2)(b1, b2) / (b1 + b2) : (float2)(b1, b2);
  }
  const float root = sqrt(u.x);
  *pdf = 1.0f / t->area;
  return (float2)(root * (1.0f - u.y), root * u.y);
}

#endif
