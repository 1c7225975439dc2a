// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes the cone's span. A cone is the convex hull of its two ends, each a disk across the axis
// (flat, open) or a ball (round). It is a frustum where both are flat, a tapered capsule where both
// are round.
//
// The ends are joined by the cone c |e| + k y = D that touches both, at height y above p0 and
// offset e from the axis: (c, k) is the normal's parts across and along the axis. It touches a disk
// in its rim, a ball in the circle at k times the radius above the centre. The solid is the
// intersection of
// - the nappe c |e| <= D - k y, whose part beyond a ball's circle is replaced by the ball's own
//   surface (as in capsule.cl),
// - a half-space at every flat end; or, where the other end's ball reaches through that disk
//   without holding it (its radius is longer than the axis), the second cone from the rim to the
//   ball, outside the disk.
// So the span is the latest entrance and the earliest exit of them all, and no gap can open between
// side and cap. A ball that holds the other end is the whole solid. The reported point is within 16
// eps (|o - p0| + L + r0 + r1) of the surface (docs/numerics.md, "Cones").
#ifndef CAPLET_SHAPES_CONE_CL
#define CAPLET_SHAPES_CONE_CL

#include "shapes/lanes.cl"
#include "shapes/sphere.cl"

// AxisLine is a line in cylinder coordinates of an axis: offset e + t f and height u + v t, t from
// the moved origin.
typedef struct {
  real ex, ey, ez, fx, fy, fz, ff;
  real u, v;
  real nearest;  // t of the point nearest to the axis
} AxisLine;

// Nappe is the solid c |e| <= D - k y, one half of a double cone. `thin`: height of the circle at
// the thin end of the part that matters.
typedef struct {
  real c, k, D, thin;
} Nappe;

// Returns the lanes whose line meets the nappe, and both crossings: t (infinite where the line
// stays within) and height. They solve c^2 (e + t f)^2 = (D - k (u + v t))^2, expanded about the
// point nearest to the axis or about the thin circle (docs/numerics.md, "Cones").
static inline real_mask nappe_span(const AxisLine* l, const Nappe* n, real* t_enter, real* t_exit,
                                   real* y_enter, real* y_exit) {
  const real zero = real_of(0.0f), far = real_of(INFINITY);
  const real cc = n->c * n->c, slope = l->v * n->k;
  const real a = cc * l->ff - slope * slope;
  const real_mask across =
      a > 0.0f;  // steeper to the axis than the cone: both crossings are on one nappe
  const real base = (across | (slope == 0.0f)) ? l->nearest : (n->thin - l->u) / l->v;
  const real qx = l->ex + base * l->fx, qy = l->ey + base * l->fy, qz = l->ez + base * l->fz;
  const real y = l->u + base * l->v, rest = n->D - y * n->k;
  const real b = cc * real_dot(qx, qy, qz, l->fx, l->fy, l->fz) + rest * slope;
  const real free = cc * real_dot(qx, qy, qz, qx, qy, qz) - rest * rest;
  const real disc = b * b - a * free;
  const real root = sqrt(real_max(disc, zero));
  const real s = -(b + (b < 0.0f ? -root : root));  // no cancellation
  // Parallel to the cone the other nappe is met at infinity.
  const real t1 = s / (a == 0.0f ? real_of(-FLT_MIN) : a), t2 = s == 0.0f ? zero : free / s;
  const real first = real_min(t1, t2), second = real_max(t1, t2);
  // Along the cone the nappe is met once, where D - k y is greater, and never left towards its wide
  // end; along a tube not at all.
  const real_mask along = (a == 0.0f) & (slope == 0.0f);
  const real low = across ? first : (slope < 0.0f ? second : -far);
  const real high = across ? second : (slope > 0.0f ? first : far);
  *t_enter = base + low;
  *t_exit = base + high;
  *y_enter = y + low * l->v;
  *y_exit = y + high * l->v;
  return along ? (free <= 0.0f) & (rest >= 0.0f)
               : (across ? (disc >= 0.0f) & (rest >= 0.0f) : slope != 0.0f);
}

// ConeEnds are the two ends: the first at height 0 of the axis, the second at `length`.
typedef struct {
  real length, r0, r1, taper;  // taper: r0 - r1
  real_mask round0, round1;
  real_mask mixed;  // one is round, the other a disk
  real ball, rim;   // radii of these two
} ConeEnds;

// JoiningCone is the nappe c |e| <= D - k y that touches both ends, at heights `low` and `high`.
typedef struct {
  real c, k, D, low, high;
  real w;                // length of its generator from end to end
  real dd;               // length^2 + rim^2
  real_mask all0, all1;  // the ball of this end holds the other end, and is the whole solid
} JoiningCone;

// BallSpan is where a line meets the ball of a round end.
typedef struct {
  real enter, exit;
  real_mask met;
} BallSpan;

// Returns a line through p, which lies near the origin, in cylinder coordinates of the unit axis m.
static inline AxisLine axis_line(const ShapeRay* ray, real px, real py, real pz, real mx, real my,
                                 real mz) {
  const real zero = real_of(0.0f);
  AxisLine l;
  l.u = real_dot(px, py, pz, mx, my, mz);
  l.v = real_dot(mx, my, mz, ray->dx, ray->dy, ray->dz);
  l.ex = px - l.u * mx;
  l.ey = py - l.u * my;
  l.ez = pz - l.u * mz;
  l.fx = ray->dx - l.v * mx;
  l.fy = ray->dy - l.v * my;
  l.fz = ray->dz - l.v * mz;
  l.ff = real_dot(l.fx, l.fy, l.fz, l.fx, l.fy, l.fz);
  // Along the axis f is rounding noise: it is set to 0, so that the point stays where it is.
  const real_mask crosses = l.ff * ray->inv_dd > 0x1p-50f;
  l.fx = crosses ? l.fx : zero;
  l.fy = crosses ? l.fy : zero;
  l.fz = crosses ? l.fz : zero;
  l.ff = crosses ? l.ff : zero;
  l.nearest = crosses ? -real_dot(l.ex, l.ey, l.ez, l.fx, l.fy, l.fz) / l.ff : zero;
  return l;
}

// Returns the cone that joins the ends. From a rim of radius s to a ball of radius R its generator
// has the length w, w^2 = L^2 + s^2 - R^2; between two balls w^2 = L^2 - (r0 - r1)^2, between two
// rims L^2 + (r0 - r1)^2.
static inline JoiningCone joining_cone(const ConeEnds* e) {
  const real zero = real_of(0.0f);
  const real length = e->length, taper = e->taper, ball = e->ball, rim = e->rim,
             product = taper * (e->r0 + e->r1);
  const real_mask balls = e->round0 & e->round1;
  const real ww = balls ? (length - taper) * (length + taper)
                        : (e->mixed ? length * length + (e->round0 ? -product : product)
                                    : length * length + taper * taper);
  JoiningCone out;
  out.w = sqrt(real_max(ww, zero));
  out.dd = length * length + rim * rim;
  const real inv = 1.0f / (balls ? length : (e->mixed ? out.dd : out.w));
  out.c = (balls ? out.w : (e->mixed ? rim * ball + length * out.w : length)) * inv;
  out.k = e->mixed ? product / real_max(length * ball + rim * out.w, real_of(FLT_MIN))
                   : taper * inv;  // 0 without radii
  out.D = e->round0 ? e->r0 : out.c * e->r0;
  out.low = e->round0 ? e->r0 * out.k : zero;
  out.high = e->round1 ? length + e->r1 * out.k : length;
  const real_mask one_ball = (e->round0 | e->round1) & (ww <= 0.0f);
  out.all0 = one_ball & e->round0 & ((taper >= 0.0f) | (e->round1 == 0));
  out.all1 = one_ball & (out.all0 == 0);
  return out;
}

// Intersects the joining cone, whose parts beyond the circles are the balls of round ends. Returns
// the lanes that meet it.
static inline real_mask side_span(const AxisLine* l, const ConeEnds* e, const JoiningCone* cone,
                                  const BallSpan* ball0, const BallSpan* ball1, Span* span) {
  const real low = cone->low, high = cone->high;
  const real_mask all0 = cone->all0, all1 = cone->all1;
  real y_enter, y_exit;
  const Nappe nappe = {cone->c, cone->k, cone->D, e->taper > 0.0f ? high : low};
  real_mask hit = nappe_span(l, &nappe, &span->t_enter, &span->t_exit, &y_enter, &y_exit);
  hit = (hit & (e->length > 0.0f)) | all0 | all1;
  const real_mask enter_at0 = all0 | (e->round0 & (y_enter < low) & (all1 == 0)),
                  exit_at0 = all0 | (e->round0 & (y_exit < low) & (all1 == 0));
  const real_mask enter_at1 = all1 | (e->round1 & (y_enter > high) & (all0 == 0)),
                  exit_at1 = all1 | (e->round1 & (y_exit > high) & (all0 == 0));
  hit &= ((enter_at0 | exit_at0) == 0) | ball0->met;
  hit &= ((enter_at1 | exit_at1) == 0) | ball1->met;
  span->t_enter = enter_at0 ? ball0->enter : (enter_at1 ? ball1->enter : span->t_enter);
  span->t_exit = exit_at0 ? ball0->exit : (exit_at1 ? ball1->exit : span->t_exit);
  // A shallow ray may meet a ball on the other side of the circle than the cone: the side where it
  // meets it counts.
  y_enter = l->u + l->v * span->t_enter;
  y_exit = l->u + l->v * span->t_exit;
  const real_mask side = int_of(0), one_end = int_of(1), other_end = int_of(2);
  span->surface_enter = (all0 | (enter_at0 & (y_enter < low)))
                            ? one_end
                            : ((all1 | (enter_at1 & (y_enter > high))) ? other_end : side);
  span->surface_exit = (all0 | (exit_at0 & (y_exit < low)))
                           ? one_end
                           : ((all1 | (exit_at1 & (y_exit > high))) ? other_end : side);
  span->enter = span->exit = int_of(-1);
  return hit;
}

// Limits a span to the tube through the rim of a wide flat end. There two surfaces of a short cone
// meet in a sharp edge, and roundings of both can move it far out. tube: the square of half the
// chord across the axis.
static inline void clip_to_tube(const AxisLine* l, const ConeEnds* e, real tube, Span* span) {
  const real_mask sharp =
      ((e->taper > 0.0f) & (e->round0 == 0)) | ((e->taper < 0.0f) & (e->round1 == 0));
  const real h = l->ff > 0.0f ? sqrt(real_max(tube, real_of(0.0f)) / l->ff) : real_of(INFINITY);
  const real_mask enter_tube = sharp & (l->nearest - h > span->t_enter),
                  exit_tube = sharp & (l->nearest + h < span->t_exit);
  const real_mask side = int_of(0);
  span->t_enter = enter_tube ? l->nearest - h : span->t_enter;
  span->t_exit = exit_tube ? l->nearest + h : span->t_exit;
  span->surface_enter = enter_tube ? side : span->surface_enter;
  span->surface_exit = exit_tube ? side : span->surface_exit;
}

// Limits a span to the half-spaces of the flat ends `flat0` and `flat1`. A line along them stays on
// its side for ever.
static inline void clip_to_flat_ends(const AxisLine* l, real length, real_mask flat0,
                                     real_mask flat1, real cap0, real cap1, Span* span) {
  const real far = real_of(INFINITY);
  const real_mask one_end = int_of(1), other_end = int_of(2), up = l->v >= 0.0f;
  const real v = l->v == 0.0f ? real_of(FLT_MIN) : l->v;
  const real at0 = -l->u / v, at1 = (length - l->u) / v;
  const real flat_enter = (up ? flat0 : flat1) ? (up ? at0 : at1) : -far,
             flat_exit = (up ? flat1 : flat0) ? (up ? at1 : at0) : far;
  const real_mask enter_flat = flat_enter > span->t_enter, exit_flat = flat_exit < span->t_exit;
  const real_mask open0 = cap0 == CAPLET_CAP_OPEN, open1 = cap1 == CAPLET_CAP_OPEN;
  span->t_enter = enter_flat ? flat_enter : span->t_enter;
  span->t_exit = exit_flat ? flat_exit : span->t_exit;
  span->surface_enter = enter_flat ? (up ? one_end : other_end) : span->surface_enter;
  span->surface_exit = exit_flat ? (up ? other_end : one_end) : span->surface_exit;
  span->enter &= (enter_flat & (up ? open0 : open1)) == 0;
  span->exit &= (exit_flat & (up ? open1 : open0)) == 0;
}

// Limits a span, in the lanes `second`, to the second cone: from the rim to the ball that reaches
// through the rim's disk. Returns the lanes that meet it, or are not of `second`.
static inline real_mask clip_to_second_cone(const AxisLine* l, const ConeEnds* e,
                                            const JoiningCone* cone, const BallSpan* ball0,
                                            const BallSpan* ball1, real_mask second, Span* span) {
  const real length = e->length, ball = e->ball, rim = e->rim;
  const real_mask round0 = e->round0, side = int_of(0), number = round0 ? int_of(1) : int_of(2);
  const real c = (ball - length) * (ball + length) / (rim * ball + length * cone->w);
  const real turned = (length * ball + rim * cone->w) / cone->dd;
  const real k = round0 ? turned : -turned;
  const real circle = round0 ? ball * k : length + ball * k;
  const real D = round0 ? ball : ball + length * k;
  real t_enter, t_exit, y_enter, y_exit;
  const Nappe nappe = {c, k, D, circle};
  const real_mask within = nappe_span(l, &nappe, &t_enter, &t_exit, &y_enter, &y_exit);
  const real_mask enter_beyond = round0 ? y_enter > circle : y_enter < circle;
  const real_mask exit_beyond = round0 ? y_exit > circle : y_exit < circle;
  const real_mask met =
      (second == 0) |
      (within & (((enter_beyond | exit_beyond) == 0) | (round0 ? ball0->met : ball1->met)));
  t_enter = enter_beyond ? (round0 ? ball0->enter : ball1->enter) : t_enter;
  t_exit = exit_beyond ? (round0 ? ball0->exit : ball1->exit) : t_exit;
  y_enter = l->u + l->v * t_enter;
  y_exit = l->u + l->v * t_exit;
  const real_mask enter_ball = enter_beyond & (round0 ? y_enter > circle : y_enter < circle);
  const real_mask exit_ball = exit_beyond & (round0 ? y_exit > circle : y_exit < circle);
  const real_mask later = second & (t_enter > span->t_enter),
                  earlier = second & (t_exit < span->t_exit);
  span->t_enter = later ? t_enter : span->t_enter;
  span->t_exit = earlier ? t_exit : span->t_exit;
  span->surface_enter = later ? (enter_ball ? number : side) : span->surface_enter;
  span->surface_exit = earlier ? (exit_ball ? number : side) : span->surface_exit;
  return met;
}

// Returns the span of the hull of the ends at p0 and p0 + b, for a ray from p0 + w. Caps:
// CAPLET_CAP_*.
static inline Span cone_span_of(const ShapeRay* ray, RealVector from, RealVector b, real r0,
                                real r1, real cap0, real cap1) {
  const real one = real_of(1.0f);
  // The ray's point nearest to p0 is computed in cylinder coordinates.
  const CAPLET_WAITS real shift =
      -real_dot(from.x, from.y, from.z, ray->dx, ray->dy, ray->dz) * ray->inv_dd;
  const real px = from.x + shift * ray->dx, py = from.y + shift * ray->dy,
             pz = from.z + shift * ray->dz;
  const real bb = real_dot(b.x, b.y, b.z, b.x, b.y, b.z);
  const real inv_length = 1.0f / (bb > 0.0f ? sqrt(bb) : one);
  const real length = bb * inv_length;  // as heights along m are measured
  const AxisLine l =
      axis_line(ray, px, py, pz, b.x * inv_length, b.y * inv_length, b.z * inv_length);
  const real qx = l.ex + l.nearest * l.fx, qy = l.ey + l.nearest * l.fy,
             qz = l.ez + l.nearest * l.fz;
  // Nothing lies outside the tube of the larger radius.
  const real wide = real_max(r0, r1);
  const CAPLET_WAITS real tube = wide * wide - real_dot(qx, qy, qz, qx, qy, qz);
  const real_mask near_axis = tube >= 0.0f;
  if (mask_bits(near_axis) == 0) return span_of(near_axis, shift, shift);

  // Balls are touched within 4 eps of everything: otherwise a crossing that rounding takes off both
  // the cone and the ball would be lost.
  const real room = 0x1p-22f * (length + wide);
  real ball_enter, ball_exit;
  const real_mask met0 = sphere_span_within(ray, px, py, pz, r0, room, &ball_enter, &ball_exit);
  const BallSpan ball0 = {ball_enter, ball_exit, met0};
  const real_mask met1 =
      sphere_span_within(ray, px - b.x, py - b.y, pz - b.z, r1, room, &ball_enter, &ball_exit);
  const BallSpan ball1 = {ball_enter, ball_exit, met1};

  const real_mask round0 = cap0 == CAPLET_CAP_ROUND, round1 = cap1 == CAPLET_CAP_ROUND;
  const ConeEnds ends = {length,
                         r0,
                         r1,
                         r0 - r1,
                         round0,
                         round1,
                         (round0 | round1) & ((round0 & round1) == 0),
                         round0 ? r0 : r1,
                         round0 ? r1 : r0};
  const JoiningCone cone = joining_cone(&ends);
  const real_mask one_ball = cone.all0 | cone.all1, pierced = ends.mixed & (ends.ball > length);
  Span span;
  real_mask hit = side_span(&l, &ends, &cone, &ball0, &ball1, &span);
  clip_to_tube(&l, &ends, tube, &span);
  clip_to_flat_ends(&l, length, (round0 | pierced | one_ball) == 0,
                    (round1 | pierced | one_ball) == 0, cap0, cap1, &span);
  const real_mask second = pierced & (one_ball == 0);
  if (mask_bits(second) != 0)
    hit &= clip_to_second_cone(&l, &ends, &cone, &ball0, &ball1, second, &span);
  hit &= near_axis & (span.t_enter <= span.t_exit);
  span.enter &= hit;
  span.exit &= hit;
  span.t_enter += shift;
  span.t_exit += shift;
  return span;
}

static inline Span cone_span(const ShapeRay* ray, __global const float* block, uint lane) {
  const RealVector p0 = cone_p0_lanes(block, lane), p1 = cone_p1_lanes(block, lane);
  const RealVector from = {ray->ox - p0.x, ray->oy - p0.y, ray->oz - p0.z},
                   b = {p1.x - p0.x, p1.y - p0.y, p1.z - p0.z};
  return cone_span_of(ray, from, b, cone_r0_lanes(block, lane), cone_r1_lanes(block, lane),
                      cone_cap0_lanes(block, lane), cone_cap1_lanes(block, lane));
}

SPAN_HIT(cone)

#endif
