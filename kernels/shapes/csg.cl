// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A csg shape combines closed solids by union, intersection and difference. The crossings of all
// operands are visited in order along the ray, and each turns its operand on or off; where the
// expression's value changes the ray crosses the result.
//
// host/lower/shapes/csg.cpp writes leaves[begin ..] in rows of 8; whole numbers by their bits;
// offsets count floats of `leaves`:
//   header: centre c (3), radius of a ball around c that holds the result, groups, length of the
//     program, operands, 0
//   groups, a row each: shape kind, offset of the leaf block, operands (1 to 4), number of the
//     first operand, offset of the transform (object_from_csg and csg_from_object, 12 floats each),
//     or CAPLET_NONE, offset of u at both ends of each operand of chains (a row), or CAPLET_NONE,
//     segments of time, 0. With segments the transform is a motion (math/motion.cl) of these two.
//   operands: one number each, its surface 0's number in the csg shape, | CAPLET_CSG_SUBTRACTED
//     where it is subtracted
//   program: postfix, one number each: an operand, or CAPLET_CSG_UNION, _INTERSECTION, _DIFFERENCE
// A group is a leaf block of up to four operands of one kind in one space: lanes 0..3 hold them,
// lanes 4..7 the same solids grown by their error bound. Row 0 holds the offset of each operand's
// uv_space (GeometryRecord). csg space is the space of the tree moved by -c, so that coordinates
// are as small as the shape.
//
// A computed crossing is off its operand's surface by no more than the bound b. The solid is
// convex, so from where the ray enters the grown solid (t - s) to as far beyond the crossing (t +
// s) it is within b of the surface. Crossings of different operands that have an instant in common
// in these intervals are one event: moving each surface by no more than b makes them coincide. So
// solids that touch have no surface between them, and a flush subtraction leaves no thin layer
// (docs/numerics.md, "CSG").
#ifndef CAPLET_SHAPES_CSG_CL
#define CAPLET_SHAPES_CSG_CL

#include "math/vector.cl"
#include "shapes/csg_space.cl"
#include "shapes/fields.cl"
#include "shapes/spans.cl"

// CsgLine holds the operands' crossings of one ray. Event 2 i is where operand i is entered, 2 i +
// 1 where it is left.
typedef struct {
  float t[2 * CAPLET_CSG_MAX_OPERANDS], slack[2 * CAPLET_CSG_MAX_OPERANDS];
  ushort surface[2 * CAPLET_CSG_MAX_OPERANDS];  // of the operand
  ulong pending;                                // events to come, as bits
  uint inside;                                  // operands the ray is in
  int value;                                    // whether it is in the result
  float last;                                   // t of the crossing reported last
  __global const uint* CAPLET_WAITS operands;
  __global const uint* CAPLET_WAITS program;
  CAPLET_WAITS uint program_length;
  CAPLET_WAITS float t_min;  // of the ray
  CAPLET_WAITS int sees_entering, sees_leaving;
} CsgLine;

static inline uint lowest_event(ulong bits) { return (uint)popcount(~bits & (bits - 1ul)); }

static inline int csg_value(const CsgLine* line) {
  uint stack = 0;  // lowest bit on top
  for (uint i = 0; i < line->program_length; i++) {
    const uint code = line->program[i];
    if (code < CAPLET_CSG_UNION) {
      stack = stack << 1 | (line->inside >> code & 1u);
      continue;
    }
    const uint right = stack & 1u;
    stack >>= 1;
    if (code == CAPLET_CSG_UNION) stack |= right;
    if (code == CAPLET_CSG_INTERSECTION) stack &= right | ~1u;
    if (code == CAPLET_CSG_DIFFERENCE) stack &= ~right;
  }
  return (int)(stack & 1u);
}

#if CAPLET_REAL_WIDTH == 8
// CsgSpans holds the spans of a group's lanes: operands, and from lane 4 on the same ones grown.
typedef struct {
  float enter[8], exit[8];
  int surface_enter[8], surface_exit[8];
} CsgSpans;

// Adds the crossings of operand i, which is in lane `lane` and grown in lane `grown`; `shift` is
// added to all t.
static inline void csg_add(CsgLine* line, uint i, const CsgSpans* spans, uint lane, uint grown,
                           float shift) {
  const float enter = spans->enter[lane], exit = fmax(spans->exit[lane], enter);
  if (!(fabs(enter) < MAXFLOAT && fabs(exit) < MAXFLOAT)) return;
  line->t[2 * i] = shift + enter;
  line->t[2 * i + 1] = shift + exit;
  line->slack[2 * i] = fmax(enter - spans->enter[grown], 0.0f);
  line->slack[2 * i + 1] = fmax(spans->exit[grown] - exit, 0.0f);
  line->surface[2 * i] = (ushort)spans->surface_enter[lane];
  line->surface[2 * i + 1] = (ushort)spans->surface_exit[lane];
  line->pending |= 3ul << (2 * i);
}
#endif

// Adds the crossings of the operands of one group with the ray `own`.
static inline void csg_add_group(CsgLine* line, const ShapeRay* own, __global const uint* group,
                                 float shift) {
  __global const float* block = floats_at(own->leaves, group[1]);
#if CAPLET_REAL_WIDTH == 8
  const uint kind = group[0], count = group[2], first = group[3];
  const Span span = solid_span(kind, own, block, 0);
  const uint bits = mask_bits(span.enter & span.exit);
  if ((bits & 15u) == 0) return;
  CsgSpans spans;
  real_store(span.t_enter, spans.enter);
  real_store(span.t_exit, spans.exit);
  mask_store(span.surface_enter, spans.surface_enter);
  mask_store(span.surface_exit, spans.surface_exit);
  for (uint i = 0; i < count; i++) {
    if ((bits >> i & 1u) == 0) continue;
    csg_add(line, first + i, &spans, i, (bits >> (i + 4) & 1u) != 0 ? i + 4 : i, shift);
  }
#else
  // The group is read again for each operand.
  __global const uint* CAPLET_WAITS rows = group;
  for (CAPLET_WAITS uint i = 0; i < rows[2]; i++) {
    // The loop has one place in the code for all solids, not two; results of the first round stay
    // in `line`, not in registers.
#pragma unroll 1
    for (CAPLET_WAITS uint grown = 0; grown < 2; grown++) {
      const Span span = solid_span(rows[0], own, block, i + 4 * grown);
      const uint at = 2 * (rows[3] + i);
      const int met = (span.enter & span.exit) != 0;
      if (grown == 0) {
        const float exit = fmax(span.t_exit, span.t_enter);
        if (!met || !(fabs(span.t_enter) < MAXFLOAT && fabs(exit) < MAXFLOAT)) break;
        line->t[at] = shift + span.t_enter;
        line->t[at + 1] = shift + exit;
        line->slack[at] = span.t_enter;
        line->slack[at + 1] = exit;
        line->surface[at] = (ushort)span.surface_enter;
        line->surface[at + 1] = (ushort)span.surface_exit;
        line->pending |= 3ul << at;
      } else {
        line->slack[at] = met ? fmax(line->slack[at] - span.t_enter, 0.0f) : 0.0f;
        line->slack[at + 1] = met ? fmax(span.t_exit - line->slack[at + 1], 0.0f) : 0.0f;
      }
    }
  }
#endif
}

// Computes the crossings of all operands of the csg shape at leaves[begin]. Returns 0 if there are
// none.
static inline int csg_start(const ShapeRay* ray, uint begin, CsgLine* line) {
  __global const float* header = floats_at(ray->leaves, begin);
  __global const uint* numbers = (__global const uint*)header;
  const float3 d = (float3)(ray->dx, ray->dy, ray->dz);
  float3 o = (float3)(ray->ox, ray->oy, ray->oz) - load3(header);
  // A ray from outside is moved to its point nearest to c first, once for all operands: the
  // rounding of that is the same for all, and later errors do not grow with the distance.
  const float radius = header[3], nearest = -dot(o, d) * ray->inv_dd;
  const float3 near = o + nearest * d;
  if (!(dot(near, near) <= radius * radius)) return 0;
  const int outside = dot(o, o) > radius * radius;
  const float shift = outside ? nearest : 0.0f;
  o = outside ? near : o;

  const uint groups = numbers[4];
  line->pending = 0;
  line->inside = 0;
  line->value = 0;
  line->last = -INFINITY;
  line->operands = numbers + 8 * (1 + groups);
  line->program = line->operands + (numbers[6] + 7) / 8 * 8;
  line->program_length = numbers[5];
  line->t_min = ray->t_min;
  line->sees_entering = ray->sees_entering;
  line->sees_leaving = ray->sees_leaving;
  CAPLET_WAITS float kept[7] = {o.x, o.y, o.z, d.x, d.y, d.z, shift};
  for (uint i = 0; i < groups; i++) {
    __global const uint* group = numbers + 8 * (1 + i);
    float3 group_o = (float3)(kept[0], kept[1], kept[2]),
           group_d = (float3)(kept[3], kept[4], kept[5]);
    if (group[4] != CAPLET_NONE) {
#ifdef CAPLET_MOTION
      const CsgSpace space = csg_space(ray->leaves, group, ray_time(ray));
      const Affine in = object_from_csg(&space);
      group_o = affine_point(&in, group_o);
      group_d = affine_vector(&in, group_d);
#else
      group_o = transform_point(floats_at(ray->leaves, group[4]), group_o);
      group_d = transform_vector(floats_at(ray->leaves, group[4]), group_d);
#endif
    }
#ifdef CAPLET_MOTION
    ShapeRay own = shape_ray(group_o, group_d, ray->t_min, ray->leaves);
    own.time = ray_time(ray);
#else
    const ShapeRay own = shape_ray(group_o, group_d, ray->t_min, ray->leaves);
#endif
    csg_add_group(line, &own, group, kept[6]);
  }
  return line->pending != 0;
}

// Returns the earliest event to come; of equal ones that of the lowest number, so that an operand
// is entered before it is left.
static inline uint csg_earliest(const CsgLine* line) {
  uint earliest = lowest_event(line->pending);
  for (ulong rest = line->pending & (line->pending - 1ul); rest != 0; rest &= rest - 1ul) {
    const uint event = lowest_event(rest);
    if (line->t[event] < line->t[earliest]) earliest = event;
  }
  return earliest;
}

// Returns 1 with the t and HitRecord.surface of the next crossing of the result beyond t_min, or 0
// if there is none.
static inline int csg_next(CsgLine* line, float* t, int* side) {
  while (line->pending != 0) {
    const int before = line->value;
    uint event = csg_earliest(line);
    const int first_seen = line->t[event] > line->t_min;
    uint members = 0, crossed = event;
    float low = -INFINITY, high = INFINITY;  // the instants all members have in common
    for (;;) {
      const int leaves_operand = (int)(event & 1u);
      const float own_t = line->t[event], partner = line->t[event ^ 1u], slack = line->slack[event];
      const float own_low = leaves_operand ? fmax(own_t - slack, partner) : own_t - slack;
      const float own_high = leaves_operand ? own_t + slack : fmin(own_t + slack, partner);
      const float common_low = fmax(low, own_low), common_high = fmin(high, own_high);
      if (members != 0 && ((members >> (event >> 1) & 1u) != 0 || !(common_low <= common_high)))
        break;
      low = common_low;
      high = common_high;
      members |= 1u << (event >> 1);
      line->pending &= ~(1ul << event);
      line->inside ^= 1u << (event >> 1);
      const int value = csg_value(line);
      // `crossed` is the first member that makes the difference.
      if (line->value == before && value != before) crossed = event;
      line->value = value;
      if (line->pending == 0) break;
      event = csg_earliest(line);
    }
    // Several surfaces at which the ray begins are all behind it, unless the instants that they
    // have in common, and the crossing itself, lie ahead. (The ray may graze one of them for long,
    // so that the crossing of that one is far behind.)
    const int seen = line->t[crossed] > line->t_min && (first_seen || low > line->t_min);
    if (line->value == before || !seen) continue;
    if ((line->value != 0 ? line->sees_entering : line->sees_leaving) == 0) continue;
    const uint surface =
        (line->operands[crossed >> 1] & CAPLET_SURFACE_MASK) + line->surface[crossed];
    // Each crossing is reported beyond the last one, so that a chord of no length still enters
    // before it leaves.
    line->last = line->t[crossed] > line->last ? line->t[crossed] : nextafter(line->last, INFINITY);
    *t = line->last;
    *side = (int)surface | (line->value != 0 ? 0 : CAPLET_LEAVING);
    return 1;
  }
  return 0;
}

// Finds the nearest crossing of the csg shape at leaves[begin] beyond t_min.
static inline int csg_nearest(const ShapeRay* ray, uint begin, float* t, int* side) {
  CsgLine line;
  return csg_start(ray, begin, &line) && csg_next(&line, t, side);
}

static inline real_mask csg_hit(const ShapeRay* ray, __global const float* block, uint lane,
                                real* t, real_mask* side) {
  __global const int* ids = (__global const int*)block;
#if CAPLET_REAL_WIDTH == 8
  float ts[8];
  int sides[8], hits[8];
  for (uint i = 0; i < 8; i++) {
    ts[i] = 0.0f;
    sides[i] = 0;
    hits[i] =
        ids[i] >= 0 && csg_nearest(ray, csg_begin(lane_data(block, i)), &ts[i], &sides[i]) ? -1 : 0;
  }
  (void)lane;
  *t = vload8(0, ts);
  *side = vload8(0, sides);
  return vload8(0, hits);
#else
  *t = 0.0f;
  *side = 0;
  return ids[lane] >= 0 && csg_nearest(ray, csg_begin(lane_data(block, lane)), t, side);
#endif
}

#endif
