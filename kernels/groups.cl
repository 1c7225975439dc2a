// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file defines the groups of shared/groups.h as structs. Functions take those that they need.
#ifndef CAPLET_GROUPS_CL
#define CAPLET_GROUPS_CL

#include "math/floats.cl"
#include "shared/groups.h"
#include "shared/records.h"

#ifdef CAPLET_PART
#undef PARTS
#define PARTS(name, type) \
  BUFFER(name##_1, type, IN) BUFFER(name##_2, type, IN) BUFFER(name##_3, type, IN)
#endif

#define ONE(type) __global const type* restrict
#define IN(type) __global const type* restrict
#define STATE(type) __global type* restrict
#define STATE_LAYERS(type) STATE(type)
#define STATE_CONES(type) STATE(type)
#define STATE_SIDES(type) STATE(type)
#define STATE_MEDIA(type) STATE(type)
#define STATE_TIMES(type) STATE(type)

// anything_moves says whether instances may move (FlatScene::moves).
#ifdef CAPLET_MOTION
enum { anything_moves = 1 };
#undef TREE_TIME
#define TREE_TIME float time;
#else
enum { anything_moves = 0 };
#endif

#define GROUP_BEGIN(Type, group) typedef struct {
#define BUFFER(name, type, access) access(type) name;
#define GROUP_END(Type) \
  }                     \
  Type;
ALL_GROUPS
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
#undef TREE_TIME
#define TREE_TIME

// <array>_of(group) returns where an array lies.
#ifdef CAPLET_PART
#define FLOATS_OF(Type, array)                                                                  \
  static inline Floats array##_of(const Type* of) {                                             \
    const Floats out = {(__global const float*)of->array, (__global const float*)of->array##_1, \
                        (__global const float*)of->array##_2,                                   \
                        (__global const float*)of->array##_3, 0};                               \
    return out;                                                                                 \
  }
#else
#define FLOATS_OF(Type, array) \
  static inline Floats array##_of(const Type* of) { return (__global const float*)of->array; }
#endif
FLOATS_OF(Tree, nodes)
FLOATS_OF(Tree, leaves)
FLOATS_OF(Materials, texels)
FLOATS_OF(Lights, light_texels)
FLOATS_OF(Lights, light_cdf)
FLOATS_OF(Media, media_grids)
#undef FLOATS_OF

// Returns a node of those that wide traversal walks.
static inline __global const float* node_at(Floats nodes, uint node) {
  return floats_at(nodes, (size_t)node * CAPLET_NODE_FLOATS);
}

// Returns the leaf block that begins at `row`.
static inline __global const float* leaf_block(const Tree* tree, uint row) {
  return floats_at(leaves_of(tree), (size_t)row * 8);
}

// Scene holds what sampling a light needs: its shape, its surfaces, its spectrum, and the materials
// that let rays through it.
typedef struct {
  Tree tree;
  Surfaces surfaces;
  Spectra spectra;
  Lights lights;
  Materials materials;
} Scene;

#endif
