// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Neighbouring rays through the tree together, for processors with eight lanes: a node is fetched once for all rays that come to it, and
// each of its children is visited by those that meet it. Pays for camera rays, which share most of their way. Hits are those of trace_ray
// to the bit: what is found depends on neither order. For scenes without instances.
//
// What the including file has defined: many.cl.
#ifndef CAPLET_TRACE_STREAM_CL
#define CAPLET_TRACE_STREAM_CL

#include "trace/pool.cl"

#ifndef CAPLET_STREAM_RAYS
#define CAPLET_STREAM_RAYS 128  // a multiple of 8, at most 256
#endif
#define CAPLET_STREAM_STACK (7 * CAPLET_PATH_NODES + 8)

typedef struct {
  float near_ix, near_iy, near_iz, near_ox, near_oy, near_oz;
  float far_ix, far_iy, far_iz, far_ox, far_oy, far_oz;
  float t_min, t_best;  // t_best: as nearest.t of the StreamRay
} StreamSlab;

typedef struct {
  ShapeRay shape;
  NearRay near;
  NearestHit nearest;
} StreamRay;

// Rays [first, first + count), at most CAPLET_STREAM_RAYS.
static void trace_stream(const Stage* g, uint first, uint count) {
  const Tree* tree = TRACED_TREE(g);
  const uint root = TRACED_ROOT(g);
  StreamSlab slabs[CAPLET_STREAM_RAYS];
  StreamRay rays[CAPLET_STREAM_RAYS];
  uchar octants[CAPLET_STREAM_RAYS], met[CAPLET_STREAM_RAYS + 8], near[CAPLET_STREAM_RAYS + 8];
  uchar lists[CAPLET_STREAM_STACK * CAPLET_STREAM_RAYS + 16];  // of rays, by number
  int list_child[CAPLET_STREAM_STACK], list_at[CAPLET_STREAM_STACK], list_count[CAPLET_STREAM_STACK];

  for (uint i = 0; i < count; i++) {
    const RayRecord ray = traced_ray(g, first + i);
    const float3 o = (float3)(ray.ox, ray.oy, ray.oz), d = (float3)(ray.dx, ray.dy, ray.dz);
    const SlabRay s = slab_ray(o, d);
    StreamSlab* to = &slabs[i];
    to->near_ix = s.near_ix; to->near_iy = s.near_iy; to->near_iz = s.near_iz;
    to->near_ox = s.near_ox; to->near_oy = s.near_oy; to->near_oz = s.near_oz;
    to->far_ix = s.far_ix; to->far_iy = s.far_iy; to->far_iz = s.far_iz;
    to->far_ox = s.far_ox; to->far_oy = s.far_oy; to->far_oz = s.far_oz;
    to->t_min = ray.t_min > 0.0f ? ray.t_min : 0.0f;
    StreamRay* r = &rays[i];
    r->shape = shape_ray(o, d, to->t_min, tree->leaves);
    r->near = near_ray(o, d);
    r->nearest = nothing_before(ray.t_max);
    to->t_best = r->nearest.t;
    const int valid = line_is_valid(o, d) && ray.t_min < ray.t_max && to->t_min < to->t_best;
    octants[i] = (uchar)(valid ? octant_of(&s) : 8);
  }
  for (int flip = 0; flip < 8; flip++) {
    int begun = 0;
    for (uint i = 0; i < count; i++) {
      lists[begun] = (uchar)i;
      begun += octants[i] == flip;
    }
    if (begun == 0) continue;
    const int near_x = flip & 1 ? 24 : 0, near_y = flip & 2 ? 32 : 8, near_z = flip & 4 ? 40 : 16;
    const int far_x = 24 - near_x, far_y = 40 - near_y, far_z = 56 - near_z;
    int top = 1;
    list_child[0] = (int)root;
    list_at[0] = 0;
    list_count[0] = begun;
    while (top > 0) {
      top--;
      const int current = list_child[top], at = list_at[top], n = list_count[top];
      if (current >= 0) {
        __global const float* node = tree->nodes + (size_t)(uint)current * CAPLET_NODE_FLOATS;
        const float8 nx = vload8(0, node + near_x), ny = vload8(0, node + near_y), nz = vload8(0, node + near_z);
        const float8 fx = vload8(0, node + far_x), fy = vload8(0, node + far_y), fz = vload8(0, node + far_z);
        uint any = 0;
        for (int i = 0; i < n; i++) {
          const StreamSlab* s = &slabs[lists[at + i]];
          const float8 near_t = real_max(real_max(nx * s->near_ix - s->near_ox, ny * s->near_iy - s->near_oy),
                                         real_max(nz * s->near_iz - s->near_oz, real_of(s->t_min)));
          const float8 far_t = real_min(real_min(fx * s->far_ix - s->far_ox, fy * s->far_iy - s->far_oy),
                                        real_min(fz * s->far_iz - s->far_oz, real_of(s->t_best)));
          const uint bits = mask_bits(near_t <= far_t);
          met[i] = (uchar)bits;
          any |= bits;
        }
        vstore8((uchar8)(0), 0, met + n);
        int end = at + n;
        __global const int* child = (__global const int*)(node + 48);
        for (int s = 7; s >= 0; s--) {
          const int k = s ^ flip;
          if ((any >> k & 1u) == 0) continue;
          const int begin = end;
          for (int i = 0; i < n; i += 8) {
            const uint column = bit_column(as_ulong(vload8(0, met + i)), k);
            vstore8(permuted_bytes(vload8(0, lists + at + i), as_uchar8(set_bits[column])), 0, lists + end);
            end += (int)popcount(column);
          }
          list_child[top] = child[k];
          list_at[top] = begin;
          list_count[top] = end - begin;
          top++;
          fetch_ahead(child[k] < 0 ? tree->leaves + (size_t)CAPLET_LEAF_ROW(child[k]) * 8
                                  : tree->nodes + (size_t)(uint)child[k] * CAPLET_NODE_FLOATS);
        }
        continue;
      }
      const uint kind = CAPLET_LEAF_KIND(current), row = CAPLET_LEAF_ROW(current);
      __global const float* block = tree->leaves + (size_t)row * 8;
      int nears = 0;
      for (int i = 0; i < n; i++) {
        const uchar id = lists[at + i];
        near[nears] = id;
#ifdef CAPLET_CAPSULE_NEAR
        if (kind == shape_capsule &&
            mask_bits(capsule_near(&rays[id].near, block, 0, slabs[id].t_min, slabs[id].t_best) & lanes_filled(block, 0)) == 0)
          continue;
#endif
        nears++;
      }
      for (int i = 0; i < nears; i++) {
        const uchar id = near[i];
        test_leaf(tree, kind, row, 0, &rays[id].shape, CAPLET_NONE, &rays[id].nearest);
        slabs[id].t_best = rays[id].nearest.t;
      }
    }
  }
  for (uint i = 0; i < count; i++) {
    const HitRecord hit = hit_record(&rays[i].nearest);
    traced_hit(g, first + i, &hit);
  }
}

#endif
