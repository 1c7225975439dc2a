// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Materials that show values by colour. Each is made at its first use.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "import/color_map.h"
#include "import/import_options.h"
#include "scene/scene.h"

namespace caplet {

/// Makes at most `steps` diffuse materials of the colour map, from `low` to `high`, named "WHAT
/// VALUE", and a grey one for missing values.
class ValueColors {
 public:
  ValueColors() = default;
  ValueColors(Scene& scene, std::string what, double low, double high, int steps,
              ColorMap map = viridis);
  /// Returns the material of the nearest step; values beyond the range take that of its end, NaN
  /// the grey one. `line` is the line of the file that a new material is attributed to.
  std::uint32_t of(double value, int line = 0);

 private:
  std::uint32_t add(const std::string& name, const glm::dvec3& color, int line);

  Scene* scene_ = nullptr;
  std::string what_;
  double low_ = 0, high_ = 0;
  ColorMap map_ = viridis;
  std::vector<std::int64_t> index_;  // for each step: a material, or -1
  std::int64_t without_value_ = -1;
};

/// Finds the range of the finite values; `is_there` stays false without any.
template <class Numbers>
ValueRange range_of(const Numbers& values) {
  ValueRange out;
  for (const auto value : values)
    if (value - value == 0) out.extend(static_cast<double>(value));
  return out;
}

}  // namespace caplet
