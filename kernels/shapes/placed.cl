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

#endif
