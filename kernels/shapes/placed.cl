// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Where instances are. Of scenes in which some move, a Tree is the scene at its `time`; programs
// for other scenes have no times.
#ifndef CAPLET_SHAPES_PLACED_CL
#define CAPLET_SHAPES_PLACED_CL

#include "groups.cl"
#include "math/motion.cl"
#include "math/vector.cl"
#include "shapes/real.cl"

#ifdef CAPLET_MOTION
static inline Affine placed_at(const Tree* tree, uint instance, uint matrix) {
  __global const InstanceRecord* placed = tree->instances + instance;
  if (placed->motion_segments == 0u)
    return affine_load(matrix == 0u ? placed->object_from_world : placed->world_from_object);
  return motion_at(floats_at(leaves_of(tree), placed->motion_begin), placed->motion_segments, 2u,
                   matrix, tree->time);
}
static inline Affine object_from_world(const Tree* tree, uint instance) {
  return placed_at(tree, instance, 0u);
}
static inline Affine world_from_object(const Tree* tree, uint instance) {
  return placed_at(tree, instance, 1u);
}
#else
static inline Affine object_from_world(const Tree* tree, uint instance) {
  return affine_load(tree->instances[instance].object_from_world);
}
static inline Affine world_from_object(const Tree* tree, uint instance) {
  return affine_load(tree->instances[instance].world_from_object);
}
#endif

// Returns the top node of the world's tree, or of an instance's object, at the tree's time. What
// moves has a tree for each of several parts of the time that the shutter is open
// (host/lower/interval_trees.cpp).
#ifdef CAPLET_MOTION
static inline uint root_then(const Tree* tree, uint root, uint intervals, uint roots) {
  if (intervals <= 1u) return root;
  // `intervals` is a power of two, so the product is exact.
  const uint now = min((uint)(tree->time * (float)intervals), intervals - 1u);
  return as_uint(*floats_at(leaves_of(tree), roots + now));
}
static inline uint world_root(const Tree* tree) {
  return root_then(tree, tree->world->root, tree->world->intervals, tree->world->roots);
}
static inline uint instance_root(const Tree* tree, uint instance) {
  __global const InstanceRecord* placed = tree->instances + instance;
  return root_then(tree, placed->root, placed->intervals, placed->roots);
}
#else
static inline uint world_root(const Tree* tree) { return tree->world->root; }
static inline uint instance_root(const Tree* tree, uint instance) {
  return tree->instances[instance].root;
}
#endif

// Returns the ray for the tree's shapes, at the tree's time.
static inline ShapeRay shape_ray_of(const Tree* tree, float3 o, float3 d, float t_min) {
  ShapeRay ray = shape_ray(o, d, t_min, leaves_of(tree));
#ifdef CAPLET_MOTION
  ray.time = tree->time;
#endif
  return ray;
}

// Returns when the tree is seen, in [0, 1] of the shutter.
static inline float time_of(const Tree* tree) {
#ifdef CAPLET_MOTION
  return tree->time;
#else
  (void)tree;
  return 0.0f;
#endif
}

// Returns the scene's tree at another time.
static inline Tree tree_at(const Tree* tree, float time) {
  Tree out = *tree;
#ifdef CAPLET_MOTION
  out.time = time;
#else
  (void)time;
#endif
  return out;
}

static inline uint world_root_at(const Tree* tree, float time) {
  const Tree then = tree_at(tree, time);
  return world_root(&then);
}

#endif
