// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes points of cylinders and cones: the hull of two ends, disks across the axis or balls.
// Surfaces: 0 the side, 1 the end at p0, 2 the end at p1. On all of them u is the turn around the
// axis p0 -> p1, the same on both sides of a rim; v runs along the profile from p0 to p1: on the
// side by length from one end's circle to the other's, on a flat cap at p0 from its centre (0) to
// its rim (1), at p1 from the rim (0) to the centre (1), on a round cap by angle from pole to
// circle or circle to pole. So dpdu x dpdv points outward. Where a ball reaches through the other,
// flat end (it is longer than the axis) there is no cap but a second part of the side, from the rim
// to the ball; v still is 1 at p1's end. That ball's surface, and one that holds the other end, has
// v over the whole sphere.
#ifndef CAPLET_SHAPES_SURFACE_CONE_CL
#define CAPLET_SHAPES_SURFACE_CONE_CL

#include "shapes/surface_local.cl"

// ConeProfile is the hull's axis and side; k and c are the parts of the side's normal along and
// across the axis.
typedef struct {
  float3 axis, unit_axis;
  float length;
  float c, k;        // of the normal of the side
  float y0, y1;      // heights above p0 of the circles where it begins and ends
  float rho0, rho1;  // their radii
  int pierced;       // a ball reaches through the other, flat end
  int one_ball;      // or holds it
} ConeProfile;

static inline ConeProfile cone_profile(float3 p0, float3 p1, float r0, float r1, int round0,
                                       int round1) {
  ConeProfile s;
  s.axis = p1 - p0;
  s.unit_axis = unit_or(s.axis, (float3)(0.0f, 0.0f, 1.0f));
  s.length = dot(s.axis, s.unit_axis);
  const float taper = r0 - r1, product = taper * (r0 + r1), length = s.length;
  const int balls = round0 && round1, mixed = !balls && (round0 || round1);
  const float ball = round0 ? r0 : r1, rim = round0 ? r1 : r0;
  // The formulas are those of cone.cl; w: the length of the side's generator.
  const float ww = balls   ? (length - taper) * (length + taper)
                   : mixed ? length * length + (round0 ? -product : product)
                           : length * length + taper * taper;
  const float w = sqrt(fmax(ww, 0.0f));
  s.one_ball = (balls || mixed) && !(ww > 0.0f);
  s.pierced = mixed && ball > length;
  if (mixed) {
    const float inv = 1.0f / (length * length + rim * rim);
    s.c = (rim * ball + length * w) * inv;
    s.k = product / fmax(length * ball + rim * w, FLT_MIN);  // 0 without radii
  } else {
    const float inv = 1.0f / (balls ? length : w);
    s.c = (balls ? w : length) * inv;
    s.k = taper * inv;
  }
  s.y0 = round0 ? r0 * s.k : 0.0f;
  s.y1 = round1 ? length + r1 * s.k : length;
  s.rho0 = round0 ? r0 * s.c : r0;
  s.rho1 = round1 ? r1 * s.c : r1;
  return s;
}

// Returns the second part of the side, outside a disk through which the other end's ball of radius
// `ball` reaches.
static inline ConeProfile cone_second_profile(ConeProfile s, float ball, float rim, int round0) {
  const float length = s.length,
              w = sqrt(fmax((length - ball) * (length + ball) + rim * rim, 0.0f));
  s.c = (ball - length) * (ball + length) / (rim * ball + length * w);
  s.k = (length * ball + rim * w) / (length * length + rim * rim);
  if (round0) {
    s.y0 = ball * s.k;
    s.rho0 = ball * s.c;
  } else {
    s.k = -s.k;
    s.y1 = length + ball * s.k;
    s.rho1 = ball * s.c;
  }
  return s;
}

// Returns the place on the side, from 0 (p0's circle) to 1 (p1's), nearest to a point at height y,
// `rho` from the axis; and in *away the distance from it.
static inline float cone_side_position(const ConeProfile* s, float y, float rho, float* away) {
  const float dy = s->y1 - s->y0, drho = s->rho1 - s->rho0, squared = dy * dy + drho * drho;
  const float along = squared > 0.0f ? ((y - s->y0) * dy + (rho - s->rho0) * drho) / squared : 0.0f;
  const float position = fmin(fmax(along, 0.0f), 1.0f);
  *away = length((float2)(y - s->y0 - position * dy, rho - s->rho0 - position * drho));
  return position;
}

static inline LocalSurface cone_point(const SurfaceQuery* query, float3 p0, float3 p1, float r0,
                                      float r1, float cap0, float cap1) {
  const uint surface = query->surface;
  const float3 x = query->x;
  const int round0 = cap0 == CAPLET_CAP_ROUND, round1 = cap1 == CAPLET_CAP_ROUND;
  ConeProfile s = cone_profile(p0, p1, r0, r1, round0, round1);
  const float3 m = s.unit_axis;
  const int first = surface != 2u;  // of the ends
  const float3 center = first ? p0 : p1;
  const float radius = first ? r0 : r1;

  // These are cylinder coordinates of x; the second subtraction makes `radial` perpendicular to the
  // axis to rounding of its own length.
  const float3 from = x - (surface == 0u ? p0 : center);
  const float y = dot(from, m);
  float3 radial = from - y * m;
  radial -= dot(radial, m) * m;
  float3 unit_radial = unit_or(radial, perpendicular(m));
  // Where x is on the axis to rounding, the remainder may point along it.
  const float tilt = dot(unit_radial, m);
  unit_radial = fabs(tilt) < 0.5f ? unit_or(unit_radial - tilt * m, unit_radial) : perpendicular(m);

  LocalSurface out;
  float3 base = center;  // of the sum that makes the point
  const Frame turn = turn_frame(query->space, m);
  out.uv.x = turn_around(&turn, unit_radial);
  if (surface == 0u) {
    const float rho = dot(radial, unit_radial);
    float away;
    float position = cone_side_position(&s, y, rho, &away);
    if (s.pierced) {
      const ConeProfile second = cone_second_profile(s, round0 ? r0 : r1, round0 ? r1 : r0, round0);
      float away_second;
      const float position_second = cone_side_position(&second, y, rho, &away_second);
      if (away_second < away) {
        s = second;
        position = position_second;
      }
    }
    // The point lies between a point of each end, so that an error of the normal moves it only by
    // that error's square.
    out.ng = s.k * m + s.c * unit_radial;
    const float3 spoke0 = r0 * (round0 ? out.ng : unit_radial),
                 spoke1 = r1 * (round1 ? out.ng : unit_radial);
    const float3 q = p0 + position * s.axis;
    const float3 spoke = (1.0f - position) * spoke0 + position * spoke1;
    out.p = q + spoke;
    out.uv.y = position;
    out.dpdu = along_turn(&turn, ((1.0f - position) * s.rho0 + position * s.rho1) * unit_radial);
    out.dpdv = (s.y1 - s.y0) * m + (s.rho1 - s.rho0) * unit_radial;
    base = q;
  } else if (first ? round0 : round1) {
    const int whole = s.pierced || s.one_ball;
    const float3 rim = s.k * m + s.c * unit_radial;
    const float3 outward = first ? -m : m;
    out.ng = unit_or(from, whole ? query->fallback : outward);
    // Points that rounding takes past the circle belong to it.
    if (!whole && (first ? dot(out.ng, m) > s.k : dot(out.ng, m) < s.k)) out.ng = rim;
    out.p = center + radius * out.ng;
    // Angles count from the pole that comes first along the axis.
    const float begin = first || whole ? 0.0f : acos(-s.k),
                end = first && !whole ? acos(-s.k) : CAPLET_PI;
    const float angle = angle_between(-m, out.ng);
    out.uv.y = fmin(fmax((angle - begin) / (end - begin), 0.0f), 1.0f);
    out.dpdu = along_turn(&turn, radius * out.ng);
    out.dpdv = (end - begin) * radius * unit_or(m - dot(m, out.ng) * out.ng, (float3)(0.0f));
  } else {
    out.ng = first ? -m : m;
    // The hit's rounding may lie beyond the rim; the point does not.
    const float distance = fmin(length(radial), radius);
    const float3 spoke = distance < radius ? radial : radius * unit_radial;
    out.p = center + spoke;
    const float part = radius > 0.0f ? distance / radius : 0.0f;
    out.uv.y = first ? part : 1.0f - part;
    out.dpdu = along_turn(&turn, spoke);
    out.dpdv = distance > 0.0f ? (first ? radius : -radius) * unit_radial : (float3)(0.0f);
  }
  // Roundings of the span functions at either end grow with L when a ray starts here.
  out.error =
      CAPLET_EPS * (32.0f * fmax(r0, r1) + 12.0f * s.length + 6.0f * (norm1(base) + fmax(r0, r1)));
  out.ns = out.ng;
  return out;
}

static inline LocalSurface surface_cone(const SurfaceQuery* q) {
  return cone_point(q, cone_p0(q->data), cone_p1(q->data), cone_r0(q->data), cone_r1(q->data),
                    cone_cap0(q->data), cone_cap1(q->data));
}

#endif
