// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file defines the groups of shared/groups.h as structs. Functions take those that they need.
#ifndef CAPLET_GROUPS_CL
#define CAPLET_GROUPS_CL

#include "math/leaves.cl"
#include "shared/groups.h"
#include "shared/records.h"

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

// Returns where a tree's leaves lie.
static inline Leaves leaves_of(const Tree* tree) {
#ifdef CAPLET_LEAF_PART
  const Leaves out = {tree->leaves, tree->leaves_1, tree->leaves_2, tree->leaves_3};
  return out;
#else
  return tree->leaves;
#endif
}

// Returns the leaf block that begins at `row`.
static inline __global const float* leaf_block(const Tree* tree, uint row) {
  return leaf_at(leaves_of(tree), (size_t)row * 8);
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
