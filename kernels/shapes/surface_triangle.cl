// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes points of a triangle: three vertices, with the mesh's normals and uvs. The point is
// interpolated from the vertices, so that it lies in the triangle's plane however far the ray came
// from.
#ifndef CAPLET_SHAPES_SURFACE_TRIANGLE_CL
#define CAPLET_SHAPES_SURFACE_TRIANGLE_CL

#include "groups.cl"
#include "shapes/surface_local.cl"

// Returns a b - c d to two units in the last place (Kahan; Jeannerod, Louvet and Muller 2013).
static inline float difference_of_products(float a, float b, float c, float d) {
  const float cd = c * d;
  return fma(a, b, -cd) + fma(-c, d, cd);
}
static inline float3 robust_cross(float3 a, float3 b) {
  return (float3)(difference_of_products(a.y, b.z, a.z, b.y),
                  difference_of_products(a.z, b.x, a.x, b.z),
                  difference_of_products(a.x, b.y, a.y, b.x));
}

// Computes dpdu and dpdv from the derivatives of uv and of the point by two other parameters; they
// are zero where uv leaves them undefined or beyond a float.
static inline void derivatives_by_uv(float2 uv_a, float2 uv_b, float3 p_a, float3 p_b,
                                     LocalSurface* s) {
  const float determinant = difference_of_products(uv_a.x, uv_b.y, uv_a.y, uv_b.x);
  s->dpdu = (uv_b.y * p_a - uv_a.y * p_b) / determinant;
  s->dpdv = (uv_a.x * p_b - uv_b.x * p_a) / determinant;
  if (!(norm1(s->dpdu) + norm1(s->dpdv) < INFINITY)) s->dpdu = s->dpdv = (float3)(0.0f);
}

// Barycentric coordinates of a point of a triangle.
typedef struct {
  float b0, b1, b2;
} Barycentric;

// Returns the first of the three places in mesh_indices of the triangle that is asked for.
static inline uint triangle_corner(const SurfaceQuery* q) {
  return q->geometry->index_begin + 3u * (q->primitive - q->geometry->primitive_begin);
}

// Returns the point of the triangle with these vertices, with the normal of its plane as ns, and
// where it is.
static inline LocalSurface triangle_point(const SurfaceQuery* q, float3 v0, float3 v1, float3 v2,
                                          Barycentric* at) {
  const Surfaces* surfaces = q->surfaces;
  const GeometryRecord* geometry = q->geometry;
  const float3 e1 = v1 - v0, e2 = v2 - v0;
  const float3 n = unit_or(robust_cross(e1, e2), q->fallback);

  // b1 and b2 are barycentric coordinates of x projected along the normal, kept inside the
  // triangle.
  const float3 v = q->x - v0;
  const float area = dot(robust_cross(e1, e2), n);
  float b1 = area > 0.0f ? fmin(fmax(dot(robust_cross(v, e2), n) / area, 0.0f), 1.0f) : 0.0f;
  float b2 = area > 0.0f ? fmin(fmax(dot(robust_cross(e1, v), n) / area, 0.0f), 1.0f) : 0.0f;
  const float sum = b1 + b2;
  if (sum > 1.0f) {
    b1 /= sum;
    b2 /= sum;
  }
  const float b0 = fmax(0.0f, 1.0f - b1 - b2);
  at->b0 = b0;
  at->b1 = b1;
  at->b2 = b2;

  LocalSurface s;
  s.p = v0 + (b1 * e1 + b2 * e2);
  s.ng = s.ns = n;
  s.error = CAPLET_EPS * (12.0f * (norm1(e1) + norm1(e2)) + 4.0f * norm1(s.p));

  if (geometry->uv_begin != CAPLET_NONE) {
    const uint corner = triangle_corner(q);
    __global const float* uvs = surfaces->mesh_uvs + geometry->uv_begin;
    const float2 uv0 = vload2(surfaces->mesh_indices[corner], uvs);
    const float2 uv1 = vload2(surfaces->mesh_indices[corner + 1u], uvs),
                 uv2 = vload2(surfaces->mesh_indices[corner + 2u], uvs);
    s.uv = b0 * uv0 + b1 * uv1 + b2 * uv2;
    derivatives_by_uv(uv1 - uv0, uv2 - uv0, e1, e2, &s);
  } else {
    s.uv = (float2)(1.0f - b0, b2);
    s.dpdu = e1;
    s.dpdv = e2 - e1;
  }
  return s;
}

// Returns the shading normal, between the normals at the vertices and on the side of ng.
static inline float3 triangle_shading_normal(Barycentric at, float3 n0, float3 n1, float3 n2,
                                             float3 ng) {
  const float3 ns = unit_or(at.b0 * n0 + at.b1 * n1 + at.b2 * n2, ng);
  return dot(ns, ng) < 0.0f ? -ns : ns;
}

static inline LocalSurface surface_triangle(const SurfaceQuery* q) {
  Barycentric at;
  LocalSurface s =
      triangle_point(q, triangle_v0(q->data), triangle_v1(q->data), triangle_v2(q->data), &at);
  if (q->geometry->normal_begin != CAPLET_NONE) {
    __global const float* normals = q->surfaces->mesh_normals + q->geometry->normal_begin;
    __global const uint* corner = q->surfaces->mesh_indices + triangle_corner(q);
    s.ns = triangle_shading_normal(at, load3(normals + 3u * corner[0]),
                                   load3(normals + 3u * corner[1]), load3(normals + 3u * corner[2]),
                                   s.ng);
  }
  return s;
}

#endif
