// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is part of stream.cl, which includes it twice: it traces rays of a stream in one space
// through one tree, without instances (WALK_MEETS_INSTANCES 0) or with them (1).
//
// Its parameters say where in the arrays of one work-item its rays are; a struct of them would be
// filled for each instance.
//
// It begins at node `root`, with the `begun` rays whose numbers begin at `l->ids[begin]`; their
// directions fall in the octant `flip`. Entries from `base` on are free. `instance`: that the rays
// are in.
static void STREAM_WALK(const Stage* g, uint first, const Tree* tree, uint root, int flip,
                        uint instance, StreamSpace* space, NearestHit* nearest, StreamLists* l,
                        int base, int begin, int begun
#if WALK_MEETS_INSTANCES
                        ,
                        StreamSpace* inner
#endif
) {
  const int near_x = flip & 1 ? 24 : 0, near_y = flip & 2 ? 32 : 8, near_z = flip & 4 ? 40 : 16;
  const int far_x = 24 - near_x, far_y = 40 - near_y, far_z = 56 - near_z;
  int top = base + 1;
  l->child[base] = (int)root;
  l->at[base] = begin;
  l->count[base] = begun;
  while (top > base) {
    top--;
    const int current = l->child[top], at = l->at[top], n = l->count[top];
    if (current >= 0) {
      __global const float* node = node_at(nodes_of(tree), (uint)current);
      const float8 nx = vload8(0, node + near_x), ny = vload8(0, node + near_y),
                   nz = vload8(0, node + near_z);
      const float8 fx = vload8(0, node + far_x), fy = vload8(0, node + far_y),
                   fz = vload8(0, node + far_z);
      uint any = 0;
      for (int i = 0; i < n; i++) {
        const StreamSlab* s = &space->slabs[l->ids[at + i]];
        const float8 near_t =
            real_max(real_max(nx * s->near_ix - s->near_ox, ny * s->near_iy - s->near_oy),
                     real_max(nz * s->near_iz - s->near_oz, real_of(s->t_min)));
        const float8 far_t =
            real_min(real_min(fx * s->far_ix - s->far_ox, fy * s->far_iy - s->far_oy),
                     real_min(fz * s->far_iz - s->far_oz, real_of(s->t_best)));
        const uint bits = mask_bits(near_t <= far_t);
        l->met[i] = (uchar)bits;
        any |= bits;
      }
      vstore8((uchar8)(0), 0, l->met + n);
      int end = at + n;
      __global const int* child = (__global const int*)(node + CAPLET_NODE_CHILDREN);
      for (int s = 7; s >= 0; s--) {
        const int k = s ^ flip;
        if ((any >> k & 1u) == 0) continue;
        const int list = end;
        for (int i = 0; i < n; i += 8) {
          const uint column = bit_column(as_ulong(vload8(0, l->met + i)), k);
          vstore8(permuted_bytes(vload8(0, l->ids + at + i), as_uchar8(set_bits[column])), 0,
                  l->ids + end);
          end += (int)popcount(column);
        }
        l->child[top] = child[k];
        l->at[top] = list;
        l->count[top] = end - list;
        top++;
        fetch_ahead(child[k] < 0 ? leaf_block(tree, CAPLET_LEAF_ROW(child[k]))
                                 : node_at(nodes_of(tree), (uint)child[k]));
      }
      continue;
    }
    const uint kind = CAPLET_LEAF_KIND(current), row = CAPLET_LEAF_ROW(current);
    __global const float* block = leaf_block(tree, row);
#if WALK_MEETS_INSTANCES
    if (CAPLET_HAS_SHAPE(shape_instance) && kind == shape_instance) {
      stream_instance(g, first, tree, ((__global const uint*)block)[0], space, inner, nearest, l,
                      top, at, n);
      continue;
    }
#endif
    int nears = 0;
    for (int i = 0; i < n; i++) {
      const uchar id = l->ids[at + i];
      l->near[nears] = id;
#ifdef CAPLET_SHAPES_CAPSULE_CL
      if (!leaf_may_hit(kind, &space->near[id], block, space->slabs[id].t_min,
                        space->slabs[id].t_best))
        continue;
#endif
      nears++;
    }
    for (int i = 0; i < nears; i++) {
      const uchar id = l->near[i];
      test_leaf(tree, kind, row, 0, &space->shapes[id], instance, &nearest[id]);
      space->slabs[id].t_best = nearest[id].t;
    }
  }
}
#undef STREAM_WALK
#undef WALK_MEETS_INSTANCES
