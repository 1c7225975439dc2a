// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes the capsule's span. A capsule is a tube around the axis, closed by the spheres at its
// ends.
//
// With the ray moved to its point p nearest to p0, axis b = p1 - p0, the parts of p and d across
// the axis are e = p - (p.b / b.b) b and f = d - (d.b / b.b) b. The tube is |e + t f| = r: nearest
// to the axis at t0 = -e.f / f.f, where the distance vector is q = e + t0 f, half a chord away from
// both crossings: h^2 = (r^2 - q^2) / f.f. A crossing beyond an end of the axis is replaced by the
// crossing of that end's sphere.
//
// The quadratic's b^2 - 4ac is not used: its terms grow as L^2 and cancel to r^2, an error of eps
// L^2 / r. Here f is off by at most 3 eps |d|, which tilts the ray by no more than 3 eps L over the
// capsule, and given f everything else is relative to |e| <= L + r. The reported point is within 12
// eps (|o - p0| + L + r) of the surface, eps = 2^-24 (docs/numerics.md).
#ifndef CAPLET_SHAPES_CAPSULE_CL
#define CAPLET_SHAPES_CAPSULE_CL

#include "shapes/lanes.cl"

typedef struct {
  real px, py, pz;   // the ray's point nearest to p0, relative to p0
  real bx, by, bz;   // axis
  real u, v, t0, h;  // position on the axis (0..1) is u + v t; the tube is crossed at t0 -+ h
                     // (capsule_line leaves h squared)
  real r, ff;        // ff: f.f
} CapsuleLine;

// Returns the crossing on the entering (sign -1) or leaving (+1) side, as an offset from the moved
// origin; lanes without one leave `hit`.
static inline real capsule_end(const ShapeRay* ray, const CapsuleLine* c, float sign,
                               real_mask* hit) {
  const real side = c->t0 + sign * c->h;
  const real y = c->u + c->v * side;
  const real_mask body = (y >= 0.0f) & (y <= 1.0f);
  const real_mask beyond = y > 0.5f;
  const real zero = real_of(0.0f);
  const real cx = c->px - (beyond ? c->bx : zero), cy = c->py - (beyond ? c->by : zero),
             cz = c->pz - (beyond ? c->bz : zero);
  const real tc = -real_dot(cx, cy, cz, ray->dx, ray->dy, ray->dz) * ray->inv_dd;
  const real qx = cx + tc * ray->dx, qy = cy + tc * ray->dy, qz = cz + tc * ray->dz;
  const real qq = real_dot(qx, qy, qz, qx, qy, qz), disc = c->r * c->r - qq;
  // This is 2 to 4 eps (L + r) of room: where rounding takes a crossing of the tube past its end,
  // it must still count as on the sphere.
  const real outer = c->r + 0x1p-23f * (fabs(c->bx) + fabs(c->by) + fabs(c->bz) + c->r);
  *hit &= body | (qq <= outer * outer);
  return body ? side : tc + sign * sqrt(real_max(disc, zero) * ray->inv_dd);
}

// Fills `c` and returns the lanes whose tube the line meets. `shift`: the moved origin.
static inline real_mask capsule_line(const ShapeRay* ray, RealVector p0, RealVector p1, real r,
                                     CapsuleLine* line, real* shifted) {
  CapsuleLine c;
  const real wx = ray->ox - p0.x, wy = ray->oy - p0.y, wz = ray->oz - p0.z;
  c.bx = p1.x - p0.x;
  c.by = p1.y - p0.y;
  c.bz = p1.z - p0.z;
  c.r = r;
  const real shift = -real_dot(wx, wy, wz, ray->dx, ray->dy, ray->dz) * ray->inv_dd;
  c.px = wx + shift * ray->dx;
  c.py = wy + shift * ray->dy;
  c.pz = wz + shift * ray->dz;
  const real bb = real_dot(c.bx, c.by, c.bz, c.bx, c.by, c.bz);
  const real inv_bb = bb > 0.0f ? 1.0f / bb : real_of(0.0f);  // no axis: a sphere, all of it body
  c.u = real_dot(c.px, c.py, c.pz, c.bx, c.by, c.bz) * inv_bb;
  c.v = real_dot(c.bx, c.by, c.bz, ray->dx, ray->dy, ray->dz) * inv_bb;
  const real ex = c.px - c.u * c.bx, ey = c.py - c.u * c.by, ez = c.pz - c.u * c.bz;
  const real fx = ray->dx - c.v * c.bx, fy = ray->dy - c.v * c.by, fz = ray->dz - c.v * c.bz;
  // Along the axis f vanishes; the lower limit makes the tube's span longer than any capsule whose
  // shape single precision can hold.
  c.ff = real_dot(fx, fy, fz, fx, fy, fz);
  const real inv_ff = 1.0f / real_max(c.ff, real_of(ray->ff_min));
  c.t0 = -real_dot(ex, ey, ez, fx, fy, fz) * inv_ff;
  const real qx = ex + c.t0 * fx, qy = ey + c.t0 * fy, qz = ez + c.t0 * fz;
  const real disc = c.r * c.r - real_dot(qx, qy, qz, qx, qy, qz);
  c.h = disc * inv_ff;
  *line = c;
  *shifted = shift;
  return disc >= 0.0f;
}

// Returns the lanes that capsule_hit_of may return for t in [t_min, t_max], and few others: those
// whose axis, seen along the ray, is nearer to it than r.
//
// In the frame (u, v, w) the ends are a and b relative to the ray's origin, each component off by
// 12 eps |a| at most: one rounding of a difference, three products and two sums, 6 eps by which the
// frame is none. The nearest point q of the segment is found with a parameter off by 6 eps |a| / |b
// - a|, which lengthens |q| by 6 eps |a|. The hit of capsule_hit is a point of the ray within 16
// eps (|o - p0| + L + r) of the surface, L <= 2 D with D the greater of |a| and |b|; a t in lengths
// is off by 16 eps of it. Together 82 eps D + 16 eps r; 96 eps (D + r) are allowed, with D as a sum
// of components, and 1e-18 for segments seen end-on, whose direction has no digits.
static inline real_mask capsule_near_of(const NearRay* ray, RealVector p0, RealVector p1, real r,
                                        float t_min, float t_max) {
  const real ax = p0.x - ray->ox, ay = p0.y - ray->oy, az = p0.z - ray->oz;
  const real bx = p1.x - ray->ox, by = p1.y - ray->oy, bz = p1.z - ray->oz;
  const real au = real_dot(ax, ay, az, ray->ux, ray->uy, ray->uz),
             bu = real_dot(bx, by, bz, ray->ux, ray->uy, ray->uz);
  const real av = real_dot(ax, ay, az, ray->vx, ray->vy, ray->vz),
             bv = real_dot(bx, by, bz, ray->vx, ray->vy, ray->vz);
  const real aw = real_dot(ax, ay, az, ray->wx, ray->wy, ray->wz),
             bw = real_dot(bx, by, bz, ray->wx, ray->wy, ray->wz);
  const real eu = bu - au, ev = bv - av;
  const real along = -(au * eu + av * ev) / real_max(eu * eu + ev * ev, real_of(1e-37f));
  const real at = real_max(real_min(along, real_of(1.0f)), real_of(0.0f));
  const real qu = au + at * eu, qv = av + at * ev;
  const real reach =
      real_max(fabs(au), fabs(bu)) + real_max(fabs(av), fabs(bv)) + real_max(fabs(aw), fabs(bw));
  const real outer = r + (0x1.8p-18f * (reach + r) + 1e-18f);
  const real begin = real_min(aw, bw) - outer, end = real_max(aw, bw) + outer;
  return (qu * qu + qv * qv <= outer * outer) & (begin <= t_max * ray->length) &
         (end >= t_min * ray->length);
}

static inline real_mask capsule_near(const NearRay* ray, __global const float* block, uint lane,
                                     float t_min, float t_max) {
  return capsule_near_of(ray, capsule_p0_lanes(block, lane), capsule_p1_lanes(block, lane),
                         capsule_r_lanes(block, lane), t_min, t_max);
}

static inline real_mask capsule_hit_of(const ShapeRay* ray, RealVector p0, RealVector p1, real r,
                                       real* t, real_mask* side) {
  CapsuleLine c;
  real shift;
  real_mask hit = capsule_line(ray, p0, p1, r, &c, &shift);
  *t = shift;
  *side = int_of(0);
  if (mask_bits(hit) == 0) return hit;
  c.h = sqrt(real_max(c.h, real_of(0.0f)));
  *t = shift + capsule_end(ray, &c, -1.0f, &hit);
  const real_mask leaving = hit & (*t <= ray->t_min) & (shift + (c.t0 + c.h) > ray->t_min);
  if (mask_bits(leaving) != 0) {
    // A capsule that is entered is also left: where rounding lets the ray miss the end's sphere, it
    // is left at the point nearest to that sphere.
    real_mask exits = hit;
    const real t_exit = shift + capsule_end(ray, &c, 1.0f, &exits);
    *t = leaving ? t_exit : *t;
    *side = leaving ? int_of(CAPLET_LEAVING) : int_of(0);
  }
  return hit;
}

static inline real_mask capsule_hit(const ShapeRay* ray, __global const float* block, uint lane,
                                    real* t, real_mask* side) {
  return capsule_hit_of(ray, capsule_p0_lanes(block, lane), capsule_p1_lanes(block, lane),
                        capsule_r_lanes(block, lane), t, side);
}

static inline Span capsule_span_of(const ShapeRay* ray, RealVector p0, RealVector p1, real r) {
  CapsuleLine c;
  real shift;
  real_mask enters = capsule_line(ray, p0, p1, r, &c, &shift);
  real_mask exits = enters;
  c.h = sqrt(real_max(c.h, real_of(0.0f)));
  const real t_enter = shift + capsule_end(ray, &c, -1.0f, &enters);
  const real t_exit = shift + capsule_end(ray, &c, 1.0f, &exits);
  return span_of(enters, t_enter, t_exit);
}

static inline Span capsule_span(const ShapeRay* ray, __global const float* block, uint lane) {
  return capsule_span_of(ray, capsule_p0_lanes(block, lane), capsule_p1_lanes(block, lane),
                         capsule_r_lanes(block, lane));
}

#endif
