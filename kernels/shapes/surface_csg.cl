// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A csg shape's surface is that of an operand. It is computed in two halves around surface_shape,
// so that a kernel has the switch over shapes only once.
#ifndef CAPLET_SHAPES_SURFACE_CSG_CL
#define CAPLET_SHAPES_SURFACE_CSG_CL

#include "shapes/csg_space.cl"
#include "shapes/surface_shapes.cl"

// CsgOperand says which operand a csg shape's surface comes from.
typedef struct {
  float3 center;
  int subtracted;
  CsgSpace space;  // where placed
  int placed;
} CsgOperand;

// Finds the operand that surface q->surface belongs to: returns its shape kind, and the query for
// surface_shape. Layout: csg.cl.
static inline uint csg_operand(const SurfaceQuery* q, CsgOperand* operand, SurfaceQuery* own) {
  const Floats leaves = q->leaves;
  __global const float* header = floats_at(leaves, csg_begin(q->data));
  __global const uint* numbers = (__global const uint*)header;
  const uint groups = numbers[4];
  __global const uint* operands = numbers + 8 * (1 + groups);
  // Operands are not in the order of their surfaces, so this finds the last one that begins no
  // later.
  uint found = 0, begin = 0;
  for (uint i = 0; i < numbers[6]; i++) {
    const uint first = operands[i] & CAPLET_SURFACE_MASK;
    if (first > q->surface || first < begin) continue;
    begin = first;
    found = i;
  }
  uint group = 0;
  while (group + 1 < groups && found >= numbers[8 * (2 + group) + 3]) group++;
  __global const uint* row = numbers + 8 * (1 + group);

  operand->center = load3(header);
  operand->subtracted = (operands[found] & CAPLET_CSG_SUBTRACTED) != 0;
  operand->placed = row[4] != CAPLET_NONE;
  operand->space = csg_space(leaves, row, q->time);
  own->surface = q->surface - begin;
  own->data = lane_data(floats_at(leaves, row[1]), found - row[3]);
  own->x = q->x - operand->center;
  // This is row 0, which in a leaf holds the primitive's id.
  const uint space = as_uint(own->data[-8]);
  own->space = space != CAPLET_NONE ? floats_at(leaves, space) : 0;
  own->fallback = operand->subtracted ? -q->fallback : q->fallback;
  own->chain_u =
      any_chain && row[5] != CAPLET_NONE ? floats_at(leaves, row[5]) + 2u * (found - row[3]) : 0;
  if (operand->placed) {
    const Affine in = object_from_csg(&operand->space), out = csg_from_object(&operand->space);
    own->x = affine_point(&in, own->x);
    own->direction = affine_vector(&in, own->direction);
    own->fallback = unit_or(affine_transposed(&out, own->fallback), own->fallback);
  }
  return row[0];
}

// Returns the csg shape's surface from its operand's.
static inline LocalSurface csg_surface(const CsgOperand* operand, LocalSurface s) {
  if (operand->placed) {
    const Affine out = csg_from_object(&operand->space), in = object_from_csg(&operand->space);
    s = surface_transformed(&out, &in, s);
  }
  if (operand->subtracted) {
    s.ng = -s.ng;
    s.ns = -s.ns;
  }
  // Into csg space a ray's origin is rounded by eps of its distance from the centre, and the point
  // on the way back by eps of its size; twice each.
  const float3 moved = operand->center + s.p;
  s.error += CAPLET_EPS * (2.0f * norm1(s.p) + 2.0f * norm1(moved));
  s.p = moved;
  return s;
}

#endif
