// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file reads slots, by which hits name primitives (HitRecord.slot; shapes.def, shapes.h).
#ifndef CAPLET_SLOTS_CL
#define CAPLET_SLOTS_CL

#include "groups.cl"
#include "shared/shapes.h"

static inline int kind_is_linked(uint kind) {
  return any_linked_shape && kind == shape_linked_capsule;
}

// Returns the slot of a lane of the leaf block that begins at `row`.
static inline uint leaf_slot(uint kind, uint row, uint lane) {
  return row * 8u + lane + (kind_is_linked(kind) ? CAPLET_SLOT_LINKED : 0u);
}

// Returns the place of a slot in `leaves`.
static inline uint slot_place(uint slot) {
  return any_linked_shape ? slot & ~CAPLET_SLOT_LINKED : slot;
}

// Returns the id of the primitive at a slot.
static inline uint primitive_at(const Tree* tree, uint slot) {
  const uint place = slot_place(slot);
  if (any_linked_shape && place != slot)
    return as_uint(*floats_at(leaves_of(tree), place & ~7u)) + (place & 7u);
  return as_uint(*floats_at(leaves_of(tree), place));
}

// Returns the number of the geometry of a primitive.
static inline uint geometry_of(const Surfaces* surfaces, uint primitive) {
  const uint page = surfaces->primitive_geometry[primitive / CAPLET_PAGE_PRIMITIVES];
  if ((page & 1u) == 0u) return page >> 1;
  return surfaces->primitive_geometry[(page >> 1) + primitive % CAPLET_PAGE_PRIMITIVES];
}

// Returns the number of the geometry at a slot.
static inline uint geometry_at(const Tree* tree, const Surfaces* surfaces, uint slot) {
  return geometry_of(surfaces, primitive_at(tree, slot));
}

// Returns the data of the primitive at a slot (shapes/fields.cl; linked capsules have a surface
// function of their own).
static inline __global const float* slot_data(const Tree* tree, uint slot) {
  return floats_at(leaves_of(tree), slot_place(slot)) + 8;
}

// Returns the u at both ends of the linked capsule of a chain at a slot.
static inline __global const float* linked_u(const Tree* tree, uint slot) {
  return floats_at(leaves_of(tree), slot_place(slot)) + CAPLET_LINK_U;
}

#endif
