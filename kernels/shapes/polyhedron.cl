// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A convex polyhedron is the points below all of its planes. `leaves` holds the planes
// (shared/shapes.def). The ray is inside from the last plane that it crosses downwards to the first
// one that it crosses upwards.
//
// The ray is moved to its point p nearest to the centre c first: 3 eps |o - c|. There a plane is d
// - n.p away, rounded by 4 eps of the size, and the crossing at (d - n.p) / n.d displaces the point
// from the plane by the errors of d - n.p and n.d and of the quotient alone, however obliquely it
// is met: 16 eps (|o - c| + size) together (docs/numerics.md, "Polyhedra").
#ifndef CAPLET_SHAPES_POLYHEDRON_CL
#define CAPLET_SHAPES_POLYHEDRON_CL

#include "shapes/lanes.cl"

// Returns whether the line meets one polyhedron, where it goes in and out, and through which
// planes.
static inline int polyhedron_planes(const ShapeRay* ray, uint begin, float* t_enter, float* t_exit,
                                    int* surface_enter, int* surface_exit) {
  __global const float* head = floats_at(ray->leaves, begin);
  const uint count = as_uint(head[3]);
  const float wx = ray->ox - head[0], wy = ray->oy - head[1], wz = ray->oz - head[2];
  const float shift = -(wx * ray->dx + wy * ray->dy + wz * ray->dz) * ray->inv_dd;
  const float px = wx + shift * ray->dx, py = wy + shift * ray->dy, pz = wz + shift * ray->dz;
  float enter = -INFINITY, exit = INFINITY;
  int enter_plane = 0, exit_plane = 0, hit = 1;
  for (uint i = 0; i < count; i++) {
    const float4 plane = vload4(i, head + 8);
    const float along = plane.x * ray->dx + plane.y * ray->dy + plane.z * ray->dz;
    const float room = plane.w - (plane.x * px + plane.y * py + plane.z * pz);
    const float s = room / along;
    if (along < 0.0f && s > enter) {
      enter = s;
      enter_plane = (int)i;
    }
    if (along > 0.0f && s < exit) {
      exit = s;
      exit_plane = (int)i;
    }
    // A line along a plane is inside of it everywhere or nowhere.
    hit &= along != 0.0f || room >= 0.0f;
  }
  *t_enter = shift + enter;
  *t_exit = shift + exit;
  *surface_enter = enter_plane;
  *surface_exit = exit_plane;
  return hit && enter <= exit;
}

static inline Span polyhedron_span(const ShapeRay* ray, __global const float* block, uint lane) {
  Span span;
#if CAPLET_REAL_WIDTH == 8
  int begins[8], hits[8], surfaces_enter[8], surfaces_exit[8];
  float enters[8], exits[8];
  mask_store(polyhedron_begin_lanes(block, lane), begins);
  for (int i = 0; i < 8; i++) {
    if (i > 0 && begins[i] == begins[i - 1]) {
      // Empty lanes repeat one that is not.
      hits[i] = hits[i - 1];
      enters[i] = enters[i - 1];
      exits[i] = exits[i - 1];
      surfaces_enter[i] = surfaces_enter[i - 1];
      surfaces_exit[i] = surfaces_exit[i - 1];
      continue;
    }
    hits[i] = -polyhedron_planes(ray, (uint)begins[i], enters + i, exits + i, surfaces_enter + i,
                                 surfaces_exit + i);
  }
  span.t_enter = vload8(0, enters);
  span.t_exit = vload8(0, exits);
  span.surface_enter = vload8(0, surfaces_enter);
  span.surface_exit = vload8(0, surfaces_exit);
  span.enter = span.exit = vload8(0, hits);
#else
  const uint begin = (uint)polyhedron_begin_lanes(block, lane);
  span.enter = span.exit = polyhedron_planes(ray, begin, &span.t_enter, &span.t_exit,
                                             &span.surface_enter, &span.surface_exit);
#endif
  return span;
}

SPAN_HIT(polyhedron)

#endif
