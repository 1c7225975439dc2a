// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes the tapered capsule's span. A tapered capsule is the convex hull of two spheres, that is
// both spheres and the part of their common tangent cone between the circles where it touches them.
//
// A convex body's span is the hull of the spans of its parts, so entering is the least and leaving
// the greatest of the two spheres' and the cone's crossings; a sphere inside the other, or equal
// ends, need no special case. With k = (r0 - r1) / L the cone is sqrt(1 - k^2) |e| = r0 - k y at
// height y above p0 and offset e from the axis; its quadratic's errors reach eps r0^2 / r where a
// ray crosses near a thin end of radius r, which one or two Newton steps on the distance from the
// hull itself remove. The reported point is within 16 eps (|o - p0| + L + r0 + r1) of the surface
// (docs/numerics.md, "Cones").
#ifndef CAPLET_SHAPES_TAPERED_CAPSULE_CL
#define CAPLET_SHAPES_TAPERED_CAPSULE_CL

#include "shapes/lanes.cl"
#include "shapes/sphere.cl"

static inline Span tapered_capsule_span_of(const ShapeRay* ray, RealVector p0, RealVector p1,
                                           real r0, real r1) {
  const real bx = p1.x - p0.x, by = p1.y - p0.y, bz = p1.z - p0.z;
  const real wx = ray->ox - p0.x, wy = ray->oy - p0.y, wz = ray->oz - p0.z;
  const real zero = real_of(0.0f);

  // The ray's point nearest to p0 is in cylinder coordinates of the axis: offset e + t f from it
  // and height u + v t above p0.
  const real shift = -real_dot(wx, wy, wz, ray->dx, ray->dy, ray->dz) * ray->inv_dd;
  const real px = wx + shift * ray->dx, py = wy + shift * ray->dy, pz = wz + shift * ray->dz;
  const real length = sqrt(real_dot(bx, by, bz, bx, by, bz));
  const real inv_length = 1.0f / (length > 0.0f ? length : real_of(1.0f));
  const real mx = bx * inv_length, my = by * inv_length, mz = bz * inv_length;
  const real u = real_dot(px, py, pz, mx, my, mz),
             v = real_dot(mx, my, mz, ray->dx, ray->dy, ray->dz);
  const real ex = px - u * mx, ey = py - u * my, ez = pz - u * mz;
  const real fx = ray->dx - v * mx, fy = ray->dy - v * my, fz = ray->dz - v * mz;
  const real ff = real_max(real_dot(fx, fy, fz, fx, fy, fz), real_of(ray->ff_min));
  real base = -real_dot(ex, ey, ez, fx, fy, fz) / ff;  // nearest to the axis
  real qx = ex + base * fx, qy = ey + base * fy, qz = ez + base * fz;
  // Nothing lies outside the tube of the larger radius.
  const real wide = real_max(r0, r1);
  const real_mask near_axis = real_dot(qx, qy, qz, qx, qy, qz) <= wide * wide;
  if (mask_bits(near_axis) == 0) return span_of(near_axis, shift, shift);

  // Room for rounding is 4 eps of everything. A crossing that rounding takes off both the cone and
  // a sphere would be lost.
  const real room = 0x1p-22f * (length + wide);
  real enter0, exit0, enter1, exit1;
  const real_mask hit0 = sphere_span_within(ray, px, py, pz, r0, room, &enter0, &exit0);
  const real_mask hit1 =
      sphere_span_within(ray, px - bx, py - by, pz - bz, r1, room, &enter1, &exit1);
  const real far = real_of(INFINITY);
  real t_enter = real_min(hit0 ? enter0 : far, hit1 ? enter1 : far);
  real t_exit = real_max(hit0 ? exit0 : -far, hit1 ? exit1 : -far);

  const real taper = r0 - r1;
  const real k = taper * inv_length;
  const real cos2 = (length - taper) * (length + taper) * inv_length * inv_length;
  const real slope = v * k;
  const real a = cos2 * ff - slope * slope;
  const real low = r0 * k, high = length + r1 * k;
  base = a > 0.0f ? base : ((taper > 0.0f ? high : low) - u) / v;
  qx = ex + base * fx;
  qy = ey + base * fy;
  qz = ez + base * fz;
  const real y = u + base * v;
  const real rest = r0 - y * k;
  const real b = cos2 * real_dot(qx, qy, qz, fx, fy, fz) + rest * slope;
  const real c = cos2 * real_dot(qx, qy, qz, qx, qy, qz) - rest * rest;
  const real disc = b * b - a * c;
  const real root = sqrt(real_max(disc, zero));
  const real s = -(b + (b < 0.0f ? -root : root));  // no cancellation
  const real t1 = s / a,
             t2 = c / s;  // 0 denominators give infinities or NaN, which lie in no interval
  const real y1 = y + t1 * v, y2 = y + t2 * v;
  // Past a touching circle by 2^-12 of its sphere's radius the cone is 2^-25 of that radius off the
  // sphere.
  const real cosine = 0x1p-12f * sqrt(real_max(cos2, zero));
  const real lowest = low - real_max(r0 * cosine, room),
             highest = high + real_max(r1 * cosine, room);
  const real_mask cone = (cos2 > 0.0f) & ((disc >= 0.0f) | (a <= 0.0f));
  const real_mask ok1 = cone & (y1 >= lowest) & (y1 <= highest) & (fabs(t1) < far);
  const real_mask ok2 = cone & (y2 >= lowest) & (y2 <= highest) & (fabs(t2) < far);
  t_enter = real_min(ok1 ? base + t1 : far, t_enter);
  t_enter = real_min(ok2 ? base + t2 : far, t_enter);
  t_exit = real_max(ok1 ? base + t1 : -far, t_exit);
  t_exit = real_max(ok2 ? base + t2 : -far, t_exit);
  return span_of(near_axis & (hit0 | hit1 | ok1 | ok2), shift + t_enter, shift + t_exit);
}

static inline Span tapered_capsule_span(const ShapeRay* ray, __global const float* block,
                                        uint lane) {
  return tapered_capsule_span_of(
      ray, tapered_capsule_p0_lanes(block, lane), tapered_capsule_p1_lanes(block, lane),
      tapered_capsule_r0_lanes(block, lane), tapered_capsule_r1_lanes(block, lane));
}

SPAN_HIT(tapered_capsule)

#endif
