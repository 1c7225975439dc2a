// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes points of a bilinear patch: p00 p10 p01 p11, with the mesh's normals and uvs. The point
// is interpolated from the corners; its normal is dp/du x dp/dv of the patch's own parameters,
// which are the uv of meshes without any.
#ifndef CAPLET_SHAPES_SURFACE_BILINEAR_CL
#define CAPLET_SHAPES_SURFACE_BILINEAR_CL

#include "groups.cl"
#include "shapes/surface_triangle.cl"

// Sees the corners from x along `toward` (a unit vector on the normal's side) and returns the (u,
// v) of the point at x that shows its front. The derivation is in bilinear.cl; the front is the
// root with a positive Jacobian.
static inline float2 bilinear_parameters(float3 p00, float3 p10, float3 p01, float3 p11, float3 x,
                                         float3 toward) {
  const Frame frame = frame_from_normal(toward);
  float2 q00 = (float2)(dot(p00 - x, frame.s), dot(p00 - x, frame.t)),
         q10 = (float2)(dot(p10 - x, frame.s), dot(p10 - x, frame.t));
  float2 q01 = (float2)(dot(p01 - x, frame.s), dot(p01 - x, frame.t)),
         q11 = (float2)(dot(p11 - x, frame.s), dot(p11 - x, frame.t));
  const float extent = fmax(
      fmax(max3(fabs((float3)(q00.x, q00.y, q10.x))), max3(fabs((float3)(q10.y, q01.x, q01.y)))),
      fmax(fabs(q11.x), fabs(q11.y)));
  if (!(extent > 0.0f && extent < INFINITY)) return (float2)(0.0f);
  q00 /= extent, q10 /= extent, q01 /= extent, q11 /= extent;
  const float2 along_u = fabs(q10 - q00) + fabs(q11 - q01),
               along_v = fabs(q01 - q00) + fabs(q11 - q10);
  const int swap = along_u.x + along_u.y > along_v.x + along_v.y;
  const float2 a = swap ? q01 : q10, b = swap ? q10 : q01;
  const float f0 = difference_of_products(q00.x, b.y, q00.y, b.x),
              f1 = difference_of_products(a.x, q11.y, a.y, q11.x);
  const float f = difference_of_products(q00.x, q11.y, q00.y, q11.x) +
                  difference_of_products(a.x, b.y, a.y, b.x);
  const float d = sqrt(fmax(difference_of_products(f, f, 4.0f * f0, f1), 0.0f));
  const float k = 0.5f * (f < 0.0f ? d - f : -d - f);
  // At k : f1 the Jacobian has the sign of k.
  const int first = (k > 0.0f) != swap;
  const float num = first ? k : f0, rest = first ? f1 : k;
  float u = fmin(fmax(num / (num + rest), 0.0f), 1.0f);
  const float2 edge_u = a - q00, edge_v = b - q00, twist = (q11 - b) - edge_u;
  float2 line = edge_v + u * twist;
  float v = fmin(fmax(-dot(q00 + u * edge_u, line) / dot(line, line), 0.0f), 1.0f);
  float2 p = q00 + u * edge_u + v * line;
  for (int i = 0; i < 2; i++) {
    const float2 other = edge_u + v * twist;
    const float xx = other.x * other.x + line.x * line.x, yy = other.y * other.y + line.y * line.y;
    const float xy = other.x * other.y + line.x * line.y, damping = (xx + yy) * 0x1p-20f + 0x1p-60f;
    const float2 s = (float2)((yy + damping) * p.x - xy * p.y, (xx + damping) * p.y - xy * p.x) /
                     ((xx + damping) * (yy + damping) - xy * xy);
    const float u1 = fmin(fmax(u - dot(other, s), 0.0f), 1.0f),
                v1 = fmin(fmax(v - dot(line, s), 0.0f), 1.0f);
    const float2 line1 = edge_v + u1 * twist, p1 = q00 + u1 * edge_u + v1 * line1;
    if (!(dot(p1, p1) < dot(p, p))) break;
    u = u1;
    v = v1;
    line = line1;
    p = p1;
  }
  return swap ? (float2)(v, u) : (float2)(u, v);
}

static inline LocalSurface surface_bilinear(const SurfaceQuery* q) {
  const Surfaces* surfaces = q->surfaces;
  const GeometryRecord* geometry = q->geometry;
  const float3 p00 = bilinear_p00(q->data), p10 = bilinear_p10(q->data),
               p01 = bilinear_p01(q->data), p11 = bilinear_p11(q->data);
  const float2 at = bilinear_parameters(p00, p10, p01, p11, q->x, q->fallback);
  const float u = at.x, v = at.y;
  // Each derivative comes from the edges along it: the long edges of a narrow patch must not
  // determine its short ones.
  const float3 edge_u = p10 - p00, edge_v = p01 - p00;
  const float3 dpdu = edge_u + v * ((p11 - p01) - edge_u),
               dpdv = edge_v + u * ((p11 - p10) - edge_v);
  LocalSurface s;
  s.p = p00 + (u * edge_u + v * dpdv);
  s.ng = s.ns = unit_or(robust_cross(dpdu, dpdv), q->fallback);
  s.uv = at;
  s.dpdu = dpdu;
  s.dpdv = dpdv;
  s.error =
      CAPLET_EPS * (16.0f * (norm1(edge_u) + norm1(edge_v) + norm1(p11 - p00)) + 4.0f * norm1(s.p));

  const uint corner = geometry->index_begin + 4u * (q->primitive - geometry->primitive_begin);
  const float4 weight = (float4)((1.0f - u) * (1.0f - v), u * (1.0f - v), (1.0f - u) * v, u * v);
  if (geometry->normal_begin != CAPLET_NONE) {
    __global const float* normals = surfaces->mesh_normals + geometry->normal_begin;
    const float3 ns = weight.x * load3(normals + 3u * surfaces->mesh_indices[corner]) +
                      weight.y * load3(normals + 3u * surfaces->mesh_indices[corner + 1u]) +
                      weight.z * load3(normals + 3u * surfaces->mesh_indices[corner + 2u]) +
                      weight.w * load3(normals + 3u * surfaces->mesh_indices[corner + 3u]);
    s.ns = unit_or(ns, s.ng);
    if (dot(s.ns, s.ng) < 0.0f) s.ns = -s.ns;
  }
  if (geometry->uv_begin != CAPLET_NONE) {
    __global const float* uvs = surfaces->mesh_uvs + geometry->uv_begin;
    const float2 uv00 = vload2(surfaces->mesh_indices[corner], uvs),
                 uv10 = vload2(surfaces->mesh_indices[corner + 1u], uvs);
    const float2 uv01 = vload2(surfaces->mesh_indices[corner + 2u], uvs),
                 uv11 = vload2(surfaces->mesh_indices[corner + 3u], uvs);
    s.uv = weight.x * uv00 + weight.y * uv10 + weight.z * uv01 + weight.w * uv11;
    const float2 along_u = (1.0f - v) * (uv10 - uv00) + v * (uv11 - uv01),
                 along_v = (1.0f - u) * (uv01 - uv00) + u * (uv11 - uv10);
    derivatives_by_uv(along_u, along_v, dpdu, dpdv, &s);
  }
  return s;
}

#endif
