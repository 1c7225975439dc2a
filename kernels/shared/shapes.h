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

#ifdef __cplusplus

// These are the traits of each kind. A kind is exactly one of solid, sheet and compound; it is a
// light by itself, by its ball, or (instances) not at all.
constexpr std::uint32_t traits_of[] = {
#define SHAPE(name, traits) traits,
#include "shared/shapes.def"
#undef SHAPE
};
#define SHAPE(name, traits)                                                                                                        \
  static_assert(std::has_single_bit(std::uint32_t((traits) & (trait_solid | trait_sheet | trait_compound))), #name);               \
  static_assert(((traits) & (trait_own_light | trait_ball_light)) != 0, #name ": sampled by itself, by its ball, or by either");
#define COMPOUND(name, traits) \
  static_assert(std::has_single_bit(std::uint32_t((traits) & (trait_solid | trait_sheet | trait_compound))), #name);
#include "shared/shapes.def"
#undef SHAPE

constexpr std::uint32_t data_of[] = {
#define SHAPE(name, traits) name##_data,
#include "shared/shapes.def"
#undef SHAPE
};
/// Returns the rows of 8 floats of a leaf block: the ids, then the data.
constexpr std::uint32_t rows_of(std::uint32_t shape) { return 1 + data_of[shape]; }

constexpr std::uint64_t shape_bit(std::uint32_t shape) { return std::uint64_t{1} << shape; }
constexpr bool shape_has(std::uint32_t shape, std::uint32_t trait) { return (traits_of[shape] & trait) != 0; }
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
