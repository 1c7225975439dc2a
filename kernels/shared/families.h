// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file says where the data of materials, textures, lights and media lie in material_data,
// texture_data, light_data and media_data, and what their lists say of them. Valid as OpenCL C 1.2
// and as C++.
#ifndef CAPLET_SHARED_FAMILIES_H
#define CAPLET_SHARED_FAMILIES_H

#include "shared/kinds.h"

#ifdef __cplusplus
#include <bit>
#include <cstdint>
#include <span>
#include <string_view>
namespace caplet {
#endif

#define CAPLET_FLOATS_OF_scalar 1
#define CAPLET_FLOATS_OF_vector 3
#define CAPLET_FLOATS_OF_turn 9
#define CAPLET_FLOATS_OF_picture 5
#define CAPLET_FLOATS_OF_spectrum 1
#define CAPLET_FLOATS_OF_texture 1
#define CAPLET_FLOATS_OF_number 1
#define CAPLET_FLOATS_OF_matrix 12
#define CAPLET_FLOATS_OF_mapping 13
#define CAPLET_FLOATS_OF_material 1

// spot_at_axis is the first float of a field, spot_floats the number of floats of a light of that
// kind. The count restarts at each kind. Textures and media share names with others, so theirs are
// mix_texture_at_amount and mix_texture_floats.
enum {
#define MATERIAL(name, traits) name##_before_floats = -1,
#define FIELD(kind, name, type) kind##_at_##name, kind##_end_of_##name = kind##_at_##name + CAPLET_FLOATS_OF_##type - 1,
#define MATERIAL_END(name) name##_floats,
#include "shared/materials.def"
#undef MATERIAL
#define TEXTURE(name) name##_texture_before_floats = -1,
#define FIELD(kind, name, type) \
  kind##_texture_at_##name, kind##_texture_end_of_##name = kind##_texture_at_##name + CAPLET_FLOATS_OF_##type - 1,
#define TEXTURE_END(name) name##_texture_floats,
#include "shared/textures.def"
#undef TEXTURE
#define LIGHT(name, way) name##_before_floats = -1,
#define FIELD(kind, name, type) kind##_at_##name, kind##_end_of_##name = kind##_at_##name + CAPLET_FLOATS_OF_##type - 1,
#define LIGHT_END(name) name##_floats,
#include "shared/lights.def"
#undef LIGHT
#define MEDIUM(name, way) name##_medium_before_floats = -1,
#define FIELD(kind, name, type) \
  kind##_medium_at_##name, kind##_medium_end_of_##name = kind##_medium_at_##name + CAPLET_FLOATS_OF_##type - 1,
#define MEDIUM_END(name) name##_medium_floats,
#include "shared/media.def"
#undef MEDIUM
  family_floats_end
};

// spot_axis(data) returns a field; vectors and turns are a pointer to their first float.
#ifdef __cplusplus
#define CAPLET_DATA const float*
#define CAPLET_ACCESSOR(type) constexpr type
#define CAPLET_BITS(value) std::bit_cast<std::uint32_t>(value)
#define CAPLET_UINT std::uint32_t
#else
#define CAPLET_DATA __global const float*
#define CAPLET_ACCESSOR(type) static inline type
#define CAPLET_BITS(value) as_uint(value)
#define CAPLET_UINT uint
#endif
#define CAPLET_FIELD_scalar(function, at) \
  CAPLET_ACCESSOR(float) function(CAPLET_DATA data) { return data[at]; }
#define CAPLET_FIELD_vector(function, at) \
  CAPLET_ACCESSOR(CAPLET_DATA) function(CAPLET_DATA data) { return data + (at); }
#define CAPLET_FIELD_turn(function, at) CAPLET_FIELD_vector(function, at)
#define CAPLET_FIELD_picture(function, at) CAPLET_FIELD_vector(function, at)
#define CAPLET_FIELD_spectrum(function, at) \
  CAPLET_ACCESSOR(CAPLET_UINT) function(CAPLET_DATA data) { return CAPLET_BITS(data[at]); }
#define CAPLET_FIELD_texture(function, at) CAPLET_FIELD_spectrum(function, at)
#define CAPLET_FIELD_number(function, at) CAPLET_FIELD_spectrum(function, at)
#define CAPLET_FIELD_matrix(function, at) CAPLET_FIELD_vector(function, at)
#define CAPLET_FIELD_mapping(function, at) CAPLET_FIELD_vector(function, at)
#define CAPLET_FIELD_material(function, at) CAPLET_FIELD_spectrum(function, at)
#define MATERIAL(name, traits)
#define FIELD(kind, name, type) CAPLET_FIELD_##type(kind##_##name, kind##_at_##name)
#include "shared/materials.def"
#undef MATERIAL
#define TEXTURE(name)
#define FIELD(kind, name, type) CAPLET_FIELD_##type(kind##_texture_##name, kind##_texture_at_##name)
#include "shared/textures.def"
#undef TEXTURE
#define LIGHT(name, way)
#define FIELD(kind, name, type) CAPLET_FIELD_##type(kind##_##name, kind##_at_##name)
#include "shared/lights.def"
#undef LIGHT
#define MEDIUM(name, way)
#define FIELD(kind, name, type) CAPLET_FIELD_##type(kind##_medium_##name, kind##_medium_at_##name)
#include "shared/media.def"
#undef MEDIUM
#undef CAPLET_DATA
#undef CAPLET_ACCESSOR
#undef CAPLET_BITS
#undef CAPLET_UINT
#undef CAPLET_FIELD_scalar
#undef CAPLET_FIELD_vector
#undef CAPLET_FIELD_turn
#undef CAPLET_FIELD_picture
#undef CAPLET_FIELD_spectrum
#undef CAPLET_FIELD_texture
#undef CAPLET_FIELD_number
#undef CAPLET_FIELD_matrix
#undef CAPLET_FIELD_mapping
#undef CAPLET_FIELD_material

#ifdef __cplusplus

/// FamilyField is a field of a material, texture, light or medium.
struct FamilyField {
  std::string_view name;
  std::uint32_t at, floats;
};

#define MATERIAL(name, traits) inline constexpr FamilyField name##_field_list[] = {
#define LIGHT(name, way) inline constexpr FamilyField name##_field_list[] = {
#define FIELD(kind, name, type) {#name, kind##_at_##name, CAPLET_FLOATS_OF_##type},
#define MATERIAL_END(name) {}};
#define LIGHT_END(name) {}};
#include "shared/materials.def"
#define FIELD(kind, name, type) {#name, kind##_at_##name, CAPLET_FLOATS_OF_##type},
#include "shared/lights.def"
#undef MATERIAL
#undef LIGHT
#define TEXTURE(name) inline constexpr FamilyField name##_texture_field_list[] = {
#define FIELD(kind, name, type) {#name, kind##_texture_at_##name, CAPLET_FLOATS_OF_##type},
#define TEXTURE_END(name) {}};
#include "shared/textures.def"
#undef TEXTURE
#define MEDIUM(name, way) inline constexpr FamilyField name##_medium_field_list[] = {
#define FIELD(kind, name, type) {#name, kind##_medium_at_##name, CAPLET_FLOATS_OF_##type},
#define MEDIUM_END(name) {}};
#include "shared/media.def"
#undef MEDIUM

/// These are the fields of each kind, without the last of each list, which is empty.
inline constexpr std::span<const FamilyField> material_fields[] = {
#define MATERIAL(name, traits) std::span<const FamilyField>(name##_field_list).first(std::size(name##_field_list) - 1),
#include "shared/materials.def"
#undef MATERIAL
};
inline constexpr std::span<const FamilyField> texture_fields[] = {
#define TEXTURE(name) std::span<const FamilyField>(name##_texture_field_list).first(std::size(name##_texture_field_list) - 1),
#include "shared/textures.def"
#undef TEXTURE
};
inline constexpr std::span<const FamilyField> light_fields[] = {
#define LIGHT(name, way) std::span<const FamilyField>(name##_field_list).first(std::size(name##_field_list) - 1),
#include "shared/lights.def"
#undef LIGHT
};
inline constexpr std::span<const FamilyField> medium_fields[] = {
#define MEDIUM(name, way) std::span<const FamilyField>(name##_medium_field_list).first(std::size(name##_medium_field_list) - 1),
#include "shared/media.def"
#undef MEDIUM
};
inline constexpr std::uint32_t medium_floats[] = {
#define MEDIUM(name, way) name##_medium_floats,
#include "shared/media.def"
#undef MEDIUM
};
inline constexpr std::uint32_t material_floats[] = {
#define MATERIAL(name, traits) name##_floats,
#include "shared/materials.def"
#undef MATERIAL
};
inline constexpr std::uint32_t texture_floats[] = {
#define TEXTURE(name) name##_texture_floats,
#include "shared/textures.def"
#undef TEXTURE
};
inline constexpr std::uint32_t light_floats[] = {
#define LIGHT(name, way) name##_floats,
#include "shared/lights.def"
#undef LIGHT
};
inline constexpr std::uint32_t material_traits[] = {
#define MATERIAL(name, traits) traits,
#include "shared/materials.def"
#undef MATERIAL
};
static_assert(material_count <= 64 && texture_count <= 64 && light_count <= 64 && medium_count <= 64, "masks have 64 bits");

}  // namespace caplet
#endif
#endif
