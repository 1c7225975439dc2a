// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes the cylinder's span. A cylinder is the convex hull of its two ends, each a disk across
// the axis (flat, open) or a ball (round).
//
// The tube is that of capsule.cl: it is crossed at t0 -+ h, and a crossing beyond a round end is
// replaced by one of the ball. A flat end is a half-space, which is entered and left where the
// position on the axis u + v t is 0 or 1. The span is the latest entrance and the earliest exit:
// side and cap share their crossing on the rim, so no ray slips between them. A ball that reaches
// through the other, flat end (r > L) makes it a cone outside the disk: cone.cl has that case. The
// reported point is within 16 eps (|o - p0| + L + r) of the surface (docs/numerics.md, "Flat
// ends").
#ifndef CAPLET_SHAPES_CYLINDER_CL
#define CAPLET_SHAPES_CYLINDER_CL

#include "shapes/capsule.cl"
#include "shapes/cone.cl"

// Returns the crossing of the tube, or of the ball at the round end beyond which it lies, on the
// entering (sign -1) or leaving (+1) side. `position` is the place on the axis of the tube's
// crossing; lanes that miss the ball leave `hit`; `surface`: 0 tube, 1 or 2 ball.
static inline real cylinder_end(const ShapeRay* ray, const CapsuleLine* c, float sign,
                                real_mask round0, real_mask round1, real_mask* hit,
                                real_mask* surface) {
  const real tube = c->t0 + sign * c->h;
  const real position = c->u + c->v * tube;
  const real_mask beyond0 = round0 & (position < 0.0f), beyond1 = round1 & (position > 1.0f);
  const real_mask body = (beyond0 | beyond1) == 0;
  *surface = int_of(0);
  if (mask_bits(beyond0 | beyond1) == 0) return tube;
  const real zero = real_of(0.0f);
  const real cx = c->px - (beyond1 ? c->bx : zero), cy = c->py - (beyond1 ? c->by : zero),
             cz = c->pz - (beyond1 ? c->bz : zero);
  const real room =
      0x1p-23f * (fabs(c->bx) + fabs(c->by) + fabs(c->bz) + c->r);  // as in capsule.cl
  real enter, exit;
  const real_mask met = sphere_span_within(ray, cx, cy, cz, c->r, room, &enter, &exit);
  *hit &= body | met;
  const real t = body ? tube : (sign < 0.0f ? enter : exit);
  // A shallow ray may meet the ball on the other side of the circle than the tube: the side where
  // it meets it counts.
  const real place = c->u + c->v * t;
  *surface =
      (beyond0 & (place < 0.0f)) ? int_of(1) : ((beyond1 & (place > 1.0f)) ? int_of(2) : int_of(0));
  return t;
}

static inline Span cylinder_hull(const ShapeRay* ray, __global const float* block, uint lane) {
  const RealVector p0 = cylinder_p0_lanes(block, lane), p1 = cylinder_p1_lanes(block, lane);
  const real r = cylinder_r_lanes(block, lane);
  const RealVector from = {ray->ox - p0.x, ray->oy - p0.y, ray->oz - p0.z},
                   b = {p1.x - p0.x, p1.y - p0.y, p1.z - p0.z};
  return cone_span_of(ray, from, b, r, r, cylinder_cap0_lanes(block, lane),
                      cylinder_cap1_lanes(block, lane));
}

static inline Span cylinder_span(const ShapeRay* ray, __global const float* block, uint lane) {
  CapsuleLine c;
  real shift;
  const RealVector p0 = cylinder_p0_lanes(block, lane), p1 = cylinder_p1_lanes(block, lane);
  const real cap0 = cylinder_cap0_lanes(block, lane), cap1 = cylinder_cap1_lanes(block, lane);
  const real_mask round0 = cap0 == CAPLET_CAP_ROUND, round1 = cap1 == CAPLET_CAP_ROUND;
  const real r = cylinder_r_lanes(block, lane), bx = p1.x - p0.x, by = p1.y - p0.y,
             bz = p1.z - p0.z;
  const real bb = real_dot(bx, by, bz, bx, by, bz);
  // `pierced`: a ball reaches through the other end, which is flat.
  const real_mask pierced = (round0 | round1) & ((round0 & round1) == 0) & (bb < r * r);
#if CAPLET_REAL_WIDTH == 1
  if (pierced) return cylinder_hull(ray, block, lane);
#endif
  real_mask hit = capsule_line(ray, p0, p1, r, &c, &shift);
  const real_mask shallow = c.ff < ray->ff_min;
  if (mask_bits(hit | shallow | pierced) == 0) return span_of(hit, shift, shift);
  if (mask_bits(shallow) != 0) {
    // f is rounding noise (or d is tiny). With the lower limit alone t0 is too small and q too
    // short. A capsule's ends correct that, but flat ends do not: the distance from the axis must
    // be right in between, too.
    const real ex = c.px - c.u * c.bx, ey = c.py - c.u * c.by, ez = c.pz - c.u * c.bz;
    const real fx = ray->dx - c.v * c.bx, fy = ray->dy - c.v * c.by, fz = ray->dz - c.v * c.bz;
    const real_mask crosses = c.ff * ray->inv_dd > 0x1p-50f;
    const real t0 = crosses ? -real_dot(ex, ey, ez, fx, fy, fz) / c.ff : real_of(0.0f);
    const real qx = ex + t0 * fx, qy = ey + t0 * fy, qz = ez + t0 * fz;
    const real disc = c.r * c.r - real_dot(qx, qy, qz, qx, qy, qz);
    hit = shallow ? (disc >= 0.0f) : hit;
    c.t0 = shallow ? t0 : c.t0;
    c.h = shallow ? (crosses ? disc / c.ff : real_of(INFINITY)) : c.h;
  }
  c.h = sqrt(real_max(c.h, real_of(0.0f)));
  Span span;
  span.t_enter = cylinder_end(ray, &c, -1.0f, round0, round1, &hit, &span.surface_enter);
  span.t_exit = cylinder_end(ray, &c, 1.0f, round0, round1, &hit, &span.surface_exit);

  // A line along the flat ends stays on its side for ever.
  const real far = real_of(INFINITY);
  const real_mask up = c.v >= 0.0f;
  const real v = c.v == 0.0f ? real_of(FLT_MIN) : c.v;
  const real at0 = -c.u / v, at1 = (1.0f - c.u) / v;
  const real flat_enter = (up ? round0 : round1) ? -far : (up ? at0 : at1),
             flat_exit = (up ? round1 : round0) ? far : (up ? at1 : at0);
  const real_mask enter_flat = flat_enter > span.t_enter, exit_flat = flat_exit < span.t_exit;
  span.t_enter = enter_flat ? flat_enter : span.t_enter;
  span.t_exit = exit_flat ? flat_exit : span.t_exit;
  span.surface_enter = enter_flat ? (up ? int_of(1) : int_of(2)) : span.surface_enter;
  span.surface_exit = exit_flat ? (up ? int_of(2) : int_of(1)) : span.surface_exit;
  hit &= (span.t_enter <= span.t_exit) & (bb > 0.0f);
  const real_mask open0 = cap0 == CAPLET_CAP_OPEN, open1 = cap1 == CAPLET_CAP_OPEN;
  span.enter = hit & ((enter_flat & (up ? open0 : open1)) == 0);
  span.exit = hit & ((exit_flat & (up ? open1 : open0)) == 0);
  span.t_enter += shift;
  span.t_exit += shift;

#if CAPLET_REAL_WIDTH == 8
  if (mask_bits(pierced) != 0) {
    const Span hull = cylinder_hull(ray, block, lane);
    span.t_enter = pierced ? hull.t_enter : span.t_enter;
    span.t_exit = pierced ? hull.t_exit : span.t_exit;
    span.enter = pierced ? hull.enter : span.enter;
    span.exit = pierced ? hull.exit : span.exit;
    span.surface_enter = pierced ? hull.surface_enter : span.surface_enter;
    span.surface_exit = pierced ? hull.surface_exit : span.surface_exit;
  }
#endif
  return span;
}

SPAN_HIT(cylinder)

#endif
