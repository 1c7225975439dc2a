// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A patch of a solvent-excluded surface: part of a sphere, between planes, or part of the inner
// side of a torus. `leaves` holds it (shared/shapes.def).
//
// The ray is moved to its point p nearest to the patch's centre first, where coordinates are as
// small as the carrier: 3 eps |o - c|. On a torus, with s the length along the ray, rho the
// distance from the axis and R and r the radii, the ray is on the surface where
//   g(s) = (rho - R)^2 + z^2 - r^2 = |x|^2 + R^2 - r^2 - 2 R rho = 0.
// rho is the length of an affine function of s, with the least value m: rho'' = a m^2 / rho^3,
// where a is the squared part of the unit direction across the axis. So g'' = 2 - 2 R rho'' changes
// its sign twice at most, at rho^3 = R a m^2. Between those places g is convex or concave, and
// Newton's method, begun at an end where g (or -g) is positive, goes to the nearest root there
// without passing it, or shows that there is none. g is computed from rho and z, so that a root is
// off the surface by the rounding of those alone: 8 eps (R + r), together 16 eps (|o - c| + R + r)
// (docs/numerics.md, "Derivations").
#ifndef CAPLET_SHAPES_MOLECULAR_PATCH_CL
#define CAPLET_SHAPES_MOLECULAR_PATCH_CL

#include "math/vector.cl"
#include "shapes/sphere.cl"

// Crossings of a line with a patch, in order of t. Bit i of `on` says whether t[i] is on the patch,
// and bit i of `leaving` whether the line leaves the molecule there.
typedef struct {
  float t[4];
  uint on, leaving;
} PatchCrossings;

// PatchRay is a ray near a patch: x(s) = p + s d, from the carrier's centre, with |d| = 1. Patches
// reach beyond their borders by `slack`, which is more than roundings move a crossing along them,
// so that no ray passes between neighbours.
typedef struct {
  float3 p, d;
  float t, t_rate;  // the parameter of p, and of a unit of length
  float slack;
} PatchRay;

static inline PatchRay patch_ray(const ShapeRay* ray, float3 center, float size) {
  const float3 d = (float3)(ray->dx, ray->dy, ray->dz);
  const float3 w = (float3)(ray->ox, ray->oy, ray->oz) - center;
  PatchRay out;
  const float shift = -dot(w, d) * ray->inv_dd;
  const float3 near = w + shift * d;
  // A second step removes the error of the first, which matters when the origin is far.
  const float rest = -dot(near, d) * ray->inv_dd;
  out.p = near + rest * d;
  out.t = shift + rest;
  out.t_rate = sqrt(ray->inv_dd);
  out.d = out.t_rate * d;
  out.slack = CAPLET_EPS * 4.0f * (fabs(w.x) + fabs(w.y) + fabs(w.z) + size);
  return out;
}

// --- Spheres ---

// Returns whether a point on the sphere, from its centre, is within its planes.
static inline int patch_holds(__global const float* planes, uint count, float3 x, float slack) {
  int inside = 1;
  for (uint i = 0; i < count; i++) {
    const float4 plane = vload4(i, planes);
    inside &= dot(plane.xyz, x) <= plane.w + slack;
  }
  return inside;
}

// data: shared/shapes.def.
static inline void sphere_patch_crossings(const ShapeRay* ray, __global const float* data,
                                          PatchCrossings* out) {
  const float r = data[3];
  const PatchRay near = patch_ray(ray, load3(data), r);
  const float room = r * r - dot(near.p, near.p);
  if (!(room >= 0.0f)) return;
  const float h = sqrt(room);
  const uint count = as_uint(data[4]);
  out->t[0] = near.t - h * near.t_rate;
  out->t[1] = near.t + h * near.t_rate;
  out->on = (uint)patch_holds(data + 8, count, near.p - h * near.d, near.slack) |
            (uint)patch_holds(data + 8, count, near.p + h * near.d, near.slack) << 1;
  // The molecule is within the spheres of balls and outside those of probes.
  out->leaving = data[5] != 0.0f ? 1u : 2u;
}

// --- Tori ---

// TorusLine is the ray in the torus' own space, whose z is the axis.
typedef struct {
  float3 p, d;
  float major, minor;
} TorusLine;

// Returns g and its derivative; at the axis, as far as rounding tells, that towards `way` (1 or
// -1).
static inline float2 torus_value(const TorusLine* line, float s, float way) {
  const float3 x = line->p + s * line->d;
  const float rho = sqrt(x.x * x.x + x.y * x.y), out = rho - line->major;
  const float slope = rho > 8.0f * CAPLET_EPS * (line->major + line->minor)
                          ? (x.x * line->d.x + x.y * line->d.y) / rho
                          : way * sqrt(line->d.x * line->d.x + line->d.y * line->d.y);
  return (float2)(out * out + x.z * x.z - line->minor * line->minor,
                  2.0f * (out * slope + x.z * line->d.z));
}

// Goes from `s` to the nearest root of `sign` * g, which is convex and positive at s, before `end`.
// Returns whether there is one; there is if g has the other sign at the end (`ends_below`), and
// then the interval is halved where rounding leads a step astray.
static inline int torus_root(const TorusLine* line, float sign, float s, float end, int ends_below,
                             float* root) {
  const float way = end >= s ? 1.0f : -1.0f;
  // Steps halve the distance from a double root; they end where they no longer change s.
  for (int i = 0; i < 40; i++) {
    const float2 g = sign * torus_value(line, s, way);
    if (g.x <= 0.0f) break;
    float next = s - g.x / g.y;
    if (!((next - s) * way >= 0.0f && (end - next) * way >= 0.0f)) {  // it rises, or stays above 0
      if (!ends_below) return 0;
      next = 0.5f * (s + end);
      if (sign * torus_value(line, next, way).x <= 0.0f) {
        end = next;
        continue;
      }
    }
    if (next == s) break;
    s = next;
  }
  *root = s;
  return 1;
}

// The part of the line where rho <= R and |z| <= r, which holds all inner crossings.
static inline int torus_range(const TorusLine* line, float a, float along, float* begin,
                              float* end) {
  const float3 p = line->p, d = line->d;
  const float pp = p.x * p.x + p.y * p.y, room = line->major * line->major - pp;
  float low = -INFINITY, high = INFINITY;
  // a s^2 + 2 along s = room.
  const float disc = along * along + a * room;
  if (a > 0.0f) {
    if (!(disc >= 0.0f)) return 0;
    const float h = sqrt(disc);
    // The larger sum first, so that nothing cancels.
    const float q = along >= 0.0f ? -(along + h) : h - along;
    const float s0 = q / a, s1 = q != 0.0f ? -room / q : s0;
    low = fmin(s0, s1);
    high = fmax(s0, s1);
  } else if (room < 0.0f) {
    return 0;
  }
  const float z0 = (-line->minor - p.z) / d.z, z1 = (line->minor - p.z) / d.z;
  if (d.z != 0.0f) {
    low = fmax(low, fmin(z0, z1));
    high = fmin(high, fmax(z0, z1));
  } else if (fabs(p.z) > line->minor) {
    return 0;
  }
  // A little beyond, so that crossings at the ends are there.
  const float more = 64.0f * CAPLET_EPS * (line->major + line->minor);
  *begin = low - more;
  *end = high + more;
  return low <= high;
}

// Returns whether a point of the torus, in its space, is on the patch.
static inline int torus_holds(__global const float* data, float3 x, float slack) {
  const float out = sqrt(x.x * x.x + x.y * x.y) - data[5];
  // Between the directions theta_min and theta_max from the tube's centre.
  const int between =
      data[16] * x.z - data[17] * out >= -slack && data[19] * out - data[18] * x.z >= -slack;
  const float c = data[6], s = data[7];  // of phi_max; 2: the whole turn
  // The third half-plane keeps the far side out where the other two leave little between them.
  const int left = x.y >= -slack, right = x.x * s - x.y * c >= -slack,
            near = x.x * (1.0f + c) + x.y * s >= -slack;
  return between && (c > 1.5f || (s >= 0.0f ? left && right && near : left || right));
}

static inline void torus_patch_crossings(const ShapeRay* ray, __global const float* data,
                                         PatchCrossings* out) {
  const float major = data[5], minor = data[3];
  const PatchRay near = patch_ray(ray, load3(data), major + minor);
  const float3 axis = load3(data + 8), start = load3(data + 12), y = cross(axis, start);
  TorusLine line;
  line.p = (float3)(dot(near.p, start), dot(near.p, y), dot(near.p, axis));
  line.d = (float3)(dot(near.d, start), dot(near.d, y), dot(near.d, axis));
  line.major = major;
  line.minor = minor;
  const float a = line.d.x * line.d.x + line.d.y * line.d.y;
  const float along = line.p.x * line.d.x + line.p.y * line.d.y;
  float begin, end;
  if (!torus_range(&line, a, along, &begin, &end)) return;
  // The inflections are `spread` before and after the point nearest to the axis. A ray along the
  // axis has none: any place will do there.
  const float turn = line.p.x * line.d.y - line.p.y * line.d.x;
  const float mm = a > 0.0f ? turn * turn / a : 0.0f;
  const float middle = a > 0x1p-60f ? -along / a : -line.p.z * line.d.z;
  const float inflection = major * pow(a * mm / (major * major), 1.0f / 3.0f),
              above = inflection * inflection - mm;
  const float spread = above > 0.0f && a > 0x1p-60f ? sqrt(above / a) : 0.0f;
  const float cuts[4] = {begin, clamp(middle - spread, begin, end),
                         clamp(middle + spread, begin, end), end};
  uint count = 0;
  for (int piece = 0; piece < 3; piece++) {
    const float sign = piece == 1 ? -1.0f : 1.0f, from = cuts[piece], to = cuts[piece + 1];
    if (!(from < to)) continue;
    const float first = sign * torus_value(&line, from, 1.0f).x,
                last = sign * torus_value(&line, to, 1.0f).x;
    if (!(first > 0.0f) && !(last > 0.0f)) continue;
    // Between ends of both signs there is one root, between positive ends none or two: entering and
    // leaving take turns.
    const int ends_below = !(first > 0.0f && last > 0.0f);
    float roots[2];
    if (first > 0.0f && !torus_root(&line, sign, from, to, ends_below, roots)) continue;
    if (last > 0.0f && !torus_root(&line, sign, to, from, ends_below, roots + 1)) continue;
    for (int k = 0; k < 2; k++) {
      if (!((k == 0 ? first : last) > 0.0f) || count == 4u) continue;
      // The molecule is where g > 0.
      out->t[count] = near.t + roots[k] * near.t_rate;
      out->leaving |= (uint)((k == 0) == (sign > 0.0f)) << count;
      out->on |= (uint)torus_holds(data, line.p + roots[k] * line.d, near.slack) << count;
      count++;
    }
  }
}

// --- Both ---

static inline PatchCrossings patch_crossings(const ShapeRay* ray, uint begin) {
  __global const float* data = floats_at(ray->leaves, begin);
  PatchCrossings out;
  out.on = out.leaving = 0u;
  if (as_uint(data[4]) == CAPLET_NONE)
    torus_patch_crossings(ray, data, &out);
  else
    sphere_patch_crossings(ray, data, &out);
  return out;
}

// Returns the lanes whose bounding balls the line meets.
static inline uint patches_near(const ShapeRay* ray, __global const float* block, uint lane) {
  const RealVector c = molecular_patch_c_lanes(block, lane);
  const real wx = ray->ox - c.x, wy = ray->oy - c.y, wz = ray->oz - c.z;
  real t_enter, t_exit;
  // The perpendicular from the centre is off by 4 eps |w|.
  const real room = 8.0f * CAPLET_EPS * (fabs(wx) + fabs(wy) + fabs(wz));
  return mask_bits(sphere_span_within(ray, wx, wy, wz, molecular_patch_r_lanes(block, lane), room,
                                      &t_enter, &t_exit));
}

// Chooses the nearest of the crossings beyond t_min that the ray sees. Returns 0 if there is none.
static inline int patch_nearest(const ShapeRay* ray, const PatchCrossings* crossings, float* t,
                                int* side) {
  int found = 0;
  for (int i = 3; i >= 0; i--) {
    if ((crossings->on >> i & 1u) == 0u || !(crossings->t[i] > ray->t_min)) continue;
    const int leaving = (int)(crossings->leaving >> i & 1u);
    if ((leaving ? ray->sees_leaving : ray->sees_entering) == 0) continue;
    if (found && crossings->t[i] > *t) continue;
    *t = crossings->t[i];
    *side = leaving ? CAPLET_LEAVING : 0;
    found = 1;
  }
  return found;
}

static inline real_mask molecular_patch_hit(const ShapeRay* ray, __global const float* block,
                                            uint lane, real* t, real_mask* side) {
  const uint near = patches_near(ray, block, lane);
  int begins[CAPLET_REAL_WIDTH], hits[CAPLET_REAL_WIDTH], sides[CAPLET_REAL_WIDTH];
  float ts[CAPLET_REAL_WIDTH];
  mask_store(molecular_patch_begin_lanes(block, lane), begins);
  for (uint i = 0; i < CAPLET_REAL_WIDTH; i++) {
    hits[i] = sides[i] = 0;
    ts[i] = 0.0f;
    if ((near >> i & 1u) == 0u) continue;
    const PatchCrossings crossings = patch_crossings(ray, (uint)begins[i]);
    hits[i] = -patch_nearest(ray, &crossings, ts + i, sides + i);
  }
#if CAPLET_REAL_WIDTH == 8
  *t = vload8(0, ts);
  *side = vload8(0, sides);
  return vload8(0, hits);
#else
  *t = ts[0];
  *side = sides[0];
  return hits[0];
#endif
}

// Returns the first two crossings with each patch, or the last two (`from` 2), for hit lists. One
// enters and one leaves.
static inline Span patch_span_from(const ShapeRay* ray, __global const float* block, uint lane,
                                   uint from) {
  const uint near = patches_near(ray, block, lane);
  int begins[CAPLET_REAL_WIDTH], enters[CAPLET_REAL_WIDTH], exits[CAPLET_REAL_WIDTH];
  float t_enters[CAPLET_REAL_WIDTH], t_exits[CAPLET_REAL_WIDTH];
  mask_store(molecular_patch_begin_lanes(block, lane), begins);
  for (uint i = 0; i < CAPLET_REAL_WIDTH; i++) {
    enters[i] = exits[i] = 0;
    t_enters[i] = t_exits[i] = 0.0f;
    if ((near >> i & 1u) == 0u) continue;
    const PatchCrossings crossings = patch_crossings(ray, (uint)begins[i]);
    for (uint k = from; k < from + 2u; k++) {
      if ((crossings.on >> k & 1u) == 0u) continue;
      if (crossings.leaving >> k & 1u) {
        exits[i] = -1;
        t_exits[i] = crossings.t[k];
      } else {
        enters[i] = -1;
        t_enters[i] = crossings.t[k];
      }
    }
  }
#if CAPLET_REAL_WIDTH == 8
  Span span = span_of(vload8(0, enters), vload8(0, t_enters), vload8(0, t_exits));
  span.exit = vload8(0, exits);
#else
  Span span = span_of(enters[0], t_enters[0], t_exits[0]);
  span.exit = exits[0];
#endif
  return span;
}

static inline Span molecular_patch_span(const ShapeRay* ray, __global const float* block,
                                        uint lane) {
  return patch_span_from(ray, block, lane, 0u);
}

#endif
