// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Writes the floats of one material, texture or light, by the names of their fields in
// materials.def, textures.def and lights.def.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string_view>

#include "shared/families.h"

namespace caplet {

/// Writes fields to `to`, which has room for all of them. Put every field once: `finish` throws
/// std::logic_error where one was not put, and `put` where there is no such field or it is of
/// another size.
class FamilyData {
 public:
  FamilyData(std::span<const FamilyField> fields, float* to) : fields_(fields), to_(to) {}
  void put(std::string_view name, double value);
  void put(std::string_view name, const glm::dvec3& v);
  void put_index(std::string_view name, std::uint32_t index);  // a spectrum, a step of a texture
  void put_rows(
      std::string_view name,
      const glm::dmat3& transposed);  // a turn, whose rows are the columns of `transposed`
  void put_picture(std::string_view name, std::span<const std::uint32_t> numbers);
  void put_floats(std::string_view name, std::span<const float> values);  // a matrix, a mapping
  void finish() const;

 private:
  float* field(std::string_view name, std::uint32_t floats);
  std::span<const FamilyField> fields_;
  float* to_;
  std::uint64_t done_ = 0;
};

}  // namespace caplet
