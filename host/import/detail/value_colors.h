// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Materials whose colours tell numbers, made when first asked for.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "import/import_options.h"
#include "scene/scene.h"

namespace caplet {

/// `steps` diffuse materials of the colour map at most, from `low` to `high`, named "WHAT VALUE", and a grey one of what has no
/// value.
class ValueColors {
 public:
  ValueColors() = default;
  ValueColors(Scene& scene, std::string what, double low, double high, int steps);
  /// The material of a value, the nearest step's; beyond the ends that of the end, of NaN the grey one. `line`: of the file,
  /// where a new material is said to be from.
  std::uint32_t of(double value, int line = 0);

 private:
  std::uint32_t add(const std::string& name, const glm::dvec3& color, int line);

  Scene* scene_ = nullptr;
  std::string what_;
  double low_ = 0, high_ = 0;
  std::vector<std::int64_t> index_;  // of each step: a material, or -1
  std::int64_t without_value_ = -1;
};

/// The range of the finite ones among values; of none nothing is there.
template <class Numbers>
ValueRange range_of(const Numbers& values) {
  ValueRange out;
  for (const auto value : values)
    if (value - value == 0) out.extend(static_cast<double>(value));
  return out;
}

}  // namespace caplet
