// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/value_colors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace caplet {

ValueColors::ValueColors(Scene& scene, std::string what, double low, double high, int steps,
                         ColorMap map)
    : scene_(&scene),
      what_(std::move(what)),
      low_(low),
      high_(high),
      map_(map),
      index_(static_cast<std::size_t>(std::max(steps, 1)), -1) {}

std::uint32_t ValueColors::add(const std::string& name, const glm::dvec3& color, int line) {
  scene_->materials.push_back(
      {DiffuseMaterial{RgbSpectrum{color}}, name, {scene_->source, line, 0}});
  return narrow<std::uint32_t>(scene_->materials.size() - 1);
}

std::uint32_t ValueColors::of(double value, int line) {
  if (std::isnan(value)) {
    if (without_value_ < 0) without_value_ = add(what_ + " unknown", {0.55, 0.56, 0.52}, line);
    return static_cast<std::uint32_t>(without_value_);
  }
  const double part = high_ > low_ ? std::clamp((value - low_) / (high_ - low_), 0.0, 1.0) : 0.5;
  const auto last = static_cast<double>(index_.size() - 1);
  const auto step = static_cast<std::size_t>(part * last + 0.5);
  std::int64_t& index = index_[step];
  if (index < 0) {
    const double at = last > 0 ? static_cast<double>(step) / last : 0.5;
    index = add(fmt::format("{} {:.6g}", what_, low_ + (high_ - low_) * at), map_(at), line);
  }
  return static_cast<std::uint32_t>(index);
}

}  // namespace caplet
