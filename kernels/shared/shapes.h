// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file says where the data of shapes lie, and what the traits of shapes.def say. Valid as
// OpenCL C 1.2 and as C++.
#ifndef CAPLET_SHARED_SHAPES_H
#define CAPLET_SHARED_SHAPES_H

#include "shared/kinds.h"

#ifdef __cplusplus
#include <bit>
#include <cstdint>
#include <span>
namespace caplet {
#endif

#define CAPLET_DATA_OF_scalar 1
#define CAPLET_DATA_OF_vector 3
#define CAPLET_DATA_OF_index 1

// capsule_at_r is the first datum of a field; capsule_data is the number of data of a primitive,
// and of their rows in a leaf block. The count restarts at each shape.
enum {
#define SHAPE(name, traits) name##_before_data = -1,
#define FIELD(shape, name, type) shape##_at_##name, shape##_last_of_##name = shape##_at_##name + CAPLET_DATA_OF_##type - 1,
#define SHAPE_END(name) name##_data,
#include "shared/shapes.def"
#undef SHAPE
  shape_data_end
};

// Bit k stands for shape kind k. CAPLET_SHAPES are the shapes that the program is for; it has no
// code for others.
#ifndef CAPLET_SHAPES
#define CAPLET_SHAPES 0xffffffffffffffffUL
#endif
#define CAPLET_HAS_SHAPE(kind) (((CAPLET_SHAPES >> (kind)) & 1u) != 0)

enum {
  // has_rare_shape says whether some shape is tested apart.
  has_rare_shape = 0
#define SHAPE(name, traits) || (CAPLET_HAS_SHAPE(shape_##name) && ((traits)&trait_rare) != 0)
#include "shared/shapes.def"
#undef SHAPE
};

enum {
  // any_ball_light says whether some light may be sampled by a ball around it.
  any_ball_light = 0
#define SHAPE(name, traits) || (CAPLET_HAS_SHAPE(shape_##name) && ((traits)&trait_ball_light) != 0)
#include "shared/shapes.def"
#undef SHAPE
};

enum {
  // any_linked_shape says whether some leaf blocks may be those of linked capsules.
  any_linked_shape = 0
#define SHAPE(name, traits) || (CAPLET_HAS_SHAPE(shape_##name) && ((traits)&trait_linked) != 0)
#include "shared/shapes.def"
#undef SHAPE
};

// A leaf block of linked capsules is CAPLET_LINK_ROWS rows of 8 floats: the id of the first capsule
// and the number of capsules (by their bits; the ids are consecutive), then the x of nine points,
// their y, their z and their radii. The capsule in lane i goes from point i to point i + 1. Those of
// a chain (CAPLET_GEOMETRY_CHAIN) have another row, and the points' u.
#define CAPLET_LINK_ROWS 5
#define CAPLET_LINK_X 2
#define CAPLET_LINK_Y 11
#define CAPLET_LINK_Z 20
#define CAPLET_LINK_R 29
#define CAPLET_LINK_U 38
// HitRecord.slot has this bit, besides the place that shapes.def states, for linked capsules.
#define CAPLET_SLOT_LINKED 0x80000000u

// A page says of which geometry CAPLET_PAGE_PRIMITIVES primitives in a row are: twice its number; or,
// where they are of several, twice the place of a table of their geometries, and 1.
#define CAPLET_PAGE_PRIMITIVES 64

#ifdef __cplusplus

// These are the traits of each kind. A kind is exactly one of solid, sheet and compound; it is a
// light by itself, by its ball, or (instances, linked capsules) not at all.
constexpr std::uint32_t traits_of[] = {
#define SHAPE(name, traits) traits,
#include "shared/shapes.def"
#undef SHAPE
};
#define SHAPE(name, traits)                                                                                                        \
  static_assert(std::has_single_bit(std::uint32_t((traits) & (trait_solid | trait_sheet | trait_compound))), #name);               \
  static_assert(((traits) & (trait_own_light | trait_ball_light | trait_linked)) != 0, #name ": sampled by itself, by its ball, or by either");
#define COMPOUND(name, traits) \
  static_assert(std::has_single_bit(std::uint32_t((traits) & (trait_solid | trait_sheet | trait_compound))), #name);
#include "shared/shapes.def"
#undef SHAPE

constexpr std::uint32_t data_of[] = {
#define SHAPE(name, traits) name##_data,
#include "shared/shapes.def"
#undef SHAPE
};
constexpr std::uint64_t shape_bit(std::uint32_t shape) { return std::uint64_t{1} << shape; }
constexpr bool shape_has(std::uint32_t shape, std::uint32_t trait) { return (traits_of[shape] & trait) != 0; }
/// Returns the rows of 8 floats of a leaf block: the ids, then the data.
constexpr std::uint32_t rows_of(std::uint32_t shape) {
  return shape_has(shape, trait_linked) ? CAPLET_LINK_ROWS : 1 + data_of[shape];
}
/// Returns the id of the primitive at a slot of the leaves (HitRecord.slot).
inline std::uint32_t primitive_at(std::span<const float> leaves, std::uint32_t slot) {
  if ((slot & CAPLET_SLOT_LINKED) == 0) return std::bit_cast<std::uint32_t>(leaves[slot]);
  const std::uint32_t place = slot & ~CAPLET_SLOT_LINKED;
  return std::bit_cast<std::uint32_t>(leaves[place & ~7u]) + (place & 7u);
}
/// Returns the number of the geometry of a primitive; `pages`: the buffer primitive_geometry.
inline std::uint32_t geometry_of(std::span<const std::uint32_t> pages, std::uint32_t primitive) {
  const std::uint32_t page = pages[primitive / CAPLET_PAGE_PRIMITIVES];
  return (page & 1u) == 0 ? page >> 1 : pages[(page >> 1) + primitive % CAPLET_PAGE_PRIMITIVES];
}
/// Returns the kinds that have a trait.
constexpr std::uint64_t shapes_with(std::uint32_t trait) {
  std::uint64_t out = 0;
  for (std::uint32_t shape = 0; shape < shape_count; ++shape)
    if (shape_has(shape, trait)) out |= shape_bit(shape);
  return out;
}

/// capsule_r(data) takes the data of one primitive in order; vectors are a pointer to x.
#define CAPLET_FIELD_scalar(function, at) \
  constexpr float function(const float* data) { return data[at]; }
#define CAPLET_FIELD_vector(function, at) \
  constexpr const float* function(const float* data) { return data + (at); }
#define CAPLET_FIELD_index(function, at) \
  constexpr std::uint32_t function(const float* data) { return std::bit_cast<std::uint32_t>(data[at]); }
#define SHAPE(name, traits)
#define FIELD(shape, name, type) CAPLET_FIELD_##type(shape##_##name, shape##_at_##name)
#include "shared/shapes.def"
#undef SHAPE
#undef CAPLET_FIELD_scalar
#undef CAPLET_FIELD_vector
#undef CAPLET_FIELD_index

}  // namespace caplet
#endif
#endif
