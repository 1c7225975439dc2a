// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/family_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace caplet {

float* FamilyData::field(std::string_view name, std::uint32_t floats) {
  for (std::size_t i = 0; i < fields_.size(); ++i)
    if (fields_[i].name == name && fields_[i].floats == floats && (done_ >> i & 1) == 0) {
      done_ |= std::uint64_t{1} << i;
      return to_ + fields_[i].at;
    }
  throw std::logic_error(fmt::format(
      "there is no field '{}' of {} floats, or it has its value already", name, floats));
}

void FamilyData::put(std::string_view name, double value) {
  *field(name, 1) = static_cast<float>(value);
}

void FamilyData::put(std::string_view name, const glm::dvec3& v) {
  float* at = field(name, 3);
  for (int k = 0; k < 3; ++k) at[k] = static_cast<float>(v[k]);
}

void FamilyData::put_index(std::string_view name, std::uint32_t index) {
  *field(name, 1) = std::bit_cast<float>(index);
}

void FamilyData::put_rows(std::string_view name, const glm::dmat3& transposed) {
  float* at = field(name, 9);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) *at++ = static_cast<float>(transposed[r][c]);
}

void FamilyData::put_floats(std::string_view name, std::span<const float> values) {
  std::ranges::copy(values, field(name, static_cast<std::uint32_t>(values.size())));
}

void FamilyData::put_picture(std::string_view name, std::span<const std::uint32_t> numbers) {
  std::ranges::transform(numbers, field(name, static_cast<std::uint32_t>(numbers.size())),
                         [](std::uint32_t number) { return std::bit_cast<float>(number); });
}

void FamilyData::finish() const {
  for (std::size_t i = 0; i < fields_.size(); ++i)
    if ((done_ >> i & 1) == 0)
      throw std::logic_error(fmt::format("the field '{}' has no value", fields_[i].name));
}

}  // namespace caplet
