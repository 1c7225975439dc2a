// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Packed nodes serve rays that are traced one at a time (host/lower/packed_nodes.h). A node holds
// eight boxes in bytes, 96 bytes a node. Its words of 4 bytes are:
//   0..2   p: the least corner of the boxes, floats
//   3      the exponents of the steps sx, sy, sz, a byte each as floats have them (255: the axis is
//          not tested); then a bit for each child that there is
//   4..15  rows of eight bytes: low x, y, z, high x, y, z, in steps from p
//   16..23 references of the children, as those of other nodes (shared/kinds.h)
#ifndef CAPLET_TRACE_PACKED_CL
#define CAPLET_TRACE_PACKED_CL

#include "math/vector.cl"
#include "shapes/real.cl"

// BoxRay is the ray as tests of these boxes use it. With NaN all of them are met.
//
// With eps = 2^-24, plane p + q s of an axis is crossed at T = (p + q s - o) i, i = 1 / d. The code
// computes q a + b, with a = s i exact (s is a power of two) and b = (p - o) i -+ room |i|. i is
// off by 5 eps (OpenCL allows 2.5 ulp). The difference, its product and the sum with the room are
// off by eps each, 3 eps |p - o| |i| together, the product q a by eps q s |i|, the sum by eps T. As
// |p - o| <= |p + q s - o| + q s, that is 9 eps of T and 4 eps q s |i|. The former is covered by
// the factors 1 -+ 2^-20; 4 eps q s is less than 2^-13 of a step, by which the host has made the
// box larger. The error of shapes (16 eps of the origin's distance at most) and the rounding of the
// room are covered by the room, 32 eps of it. A contracted sum is rounded less. Steps are at least
// 2^-100, so that what is lost where subnormal numbers are zeros is covered too. On infinities: |o|
// and |p| are at most 2^126 where they are used, so p - o is finite. a, b and q a + b may be
// infinite, or NaN where they differ in sign or q is 0: fmin and fmax ignore NaN, so that the box
// only seems larger.
typedef struct {
  float ix, iy, iz;
  float room;
  uint octant;  // bit k: the ray goes down along axis k
} BoxRay;

static inline BoxRay box_ray(float3 o, float3 d) {
  // A vanishing component becomes 2^-64 of the largest: its slab is then crossed at once or never,
  // and nothing is NaN.
  const float largest = max3(fabs(d)), smallest = largest * 0x1p-64f, reach = max3(fabs(o));
  const float3 s =
      (float3)(copysign(fmax(fabs(d.x), smallest), d.x), copysign(fmax(fabs(d.y), smallest), d.y),
               copysign(fmax(fabs(d.z), smallest), d.z));
  const float3 i = clamp(1.0f / s, -1e37f, 1e37f);
  BoxRay r;
  r.ix = reach <= 0x1p126f ? i.x : NAN;
  r.iy = reach <= 0x1p126f ? i.y : NAN;
  r.iz = reach <= 0x1p126f ? i.z : NAN;
  r.room = reach * 0x1p-19f;
  r.octant = (s.x < 0.0f ? 1u : 0u) | (s.y < 0.0f ? 2u : 0u) | (s.z < 0.0f ? 4u : 0u);
  return r;
}

static inline __global const uint4* packed_node(Floats nodes, uint node) {
  return (__global const uint4*)floats_at(nodes, (size_t)node * CAPLET_PACKED_NODE_FLOATS);
}

static inline int packed_child(Floats nodes, uint node, uint slot) {
  return as_int(*floats_at(nodes, (size_t)node * CAPLET_PACKED_NODE_FLOATS + 16u + slot));
}

// Returns the children whose box a ray from `o` meets within [t_min, t_best]; bit slot ^ octant, so
// that the children it (nearly) meets first are the lowest.
static inline uint packed_node_hits(Floats nodes, uint node, const BoxRay* r, float ox, float oy,
                                    float oz, float t_min, float t_best) {
  __global const uint4* at = packed_node(nodes, node);
  const uint4 head = at[0], low = at[1], mixed = at[2], high = at[3];
  const float ax = as_float((head.w & 255u) << 23) * r->ix,
              ay = as_float((head.w >> 8 & 255u) << 23) * r->iy,
              az = as_float((head.w >> 16 & 255u) << 23) * r->iz;
  const float bx = (as_float(head.x) - ox) * r->ix, by = (as_float(head.y) - oy) * r->iy,
              bz = (as_float(head.z) - oz) * r->iz;
  const float rx = r->room * fabs(r->ix), ry = r->room * fabs(r->iy), rz = r->room * fabs(r->iz);
  const float near_x = bx - rx, near_y = by - ry, near_z = bz - rz;
  const float far_x = bx + rx, far_y = by + ry, far_z = bz + rz;
  const int down_x = (r->octant & 1u) != 0, down_y = (r->octant & 2u) != 0,
            down_z = (r->octant & 4u) != 0;
  uint bits = 0;
  for (uint part = 0; part < 2; part++) {
    const uint lx = part == 0 ? low.x : low.y, ly = part == 0 ? low.z : low.w,
               lz = part == 0 ? mixed.x : mixed.y;
    const uint hx = part == 0 ? mixed.z : mixed.w, hy = part == 0 ? high.x : high.y,
               hz = part == 0 ? high.z : high.w;
    uint nx = down_x ? hx : lx, ny = down_y ? hy : ly, nz = down_z ? hz : lz;
    uint fx = down_x ? lx : hx, fy = down_y ? ly : hy, fz = down_z ? lz : hz;
    for (uint i = 0; i < 4; i++) {
      const float near =
          fmax(fmax((float)(nx & 255u) * ax + near_x, (float)(ny & 255u) * ay + near_y),
               (float)(nz & 255u) * az + near_z);
      const float far = fmin(fmin((float)(fx & 255u) * ax + far_x, (float)(fy & 255u) * ay + far_y),
                             (float)(fz & 255u) * az + far_z);
      const int met =
          fmax(near * (1.0f - 0x1p-20f), t_min) <= fmin(far * (1.0f + 0x1p-20f), t_best);
      bits |= (met ? head.w >> (24u + 4u * part + i) & 1u : 0u) << ((4u * part + i) ^ r->octant);
      nx >>= 8;
      ny >>= 8;
      nz >>= 8;
      fx >>= 8;
      fy >>= 8;
      fz >>= 8;
    }
  }
  return bits;
}

#endif
