// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/reference_box.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lower/detail/floats.h"
#include "lower/detail/shapes.h"

namespace caplet {

namespace {

ExactBox kept_box(const FlatPrimitive& p) {
  ExactBox box;
  std::copy_n(p.kept_box(), 3, box.min.begin());
  std::copy_n(p.kept_box() + 3, 3, box.max.begin());
  return box;
}

ExactBox exact_box(const FlatPrimitive& p) {
  switch (p.shape) {
#define SHAPE(name, traits)                                                                \
  case shape_##name:                                                                       \
    if constexpr (((traits) & (trait_kept_box | trait_linked)) == 0) return name##_box(p); \
    break;
#define COMPOUND(name, traits)
#include "shared/shapes.def"
#undef SHAPE
    default:
      break;
  }
  return kept_box(p);
}

}  // namespace

// The kernels' error is at most 16 eps (size + coordinates) for rays from nearby, eps = 2^-24, so
// 2^-20 of that is added. The slab test covers the part that grows with the distance of a ray's
// origin (kernels/trace/trace.cl).
ReferenceBox reference_box(const FlatPrimitive& p) {
  const ExactBox box = exact_box(p);
  double reach = 0;
  for (std::size_t k = 0; k < 3; k++)
    reach = std::max(
        {reach, std::abs(box.min[k]), std::abs(box.max[k]), 2 * (box.max[k] - box.min[k])});
  const double pad = reach * 0x1p-20;
  ReferenceBox r{};
  const double largest = double(std::numeric_limits<float>::max());
  for (std::size_t k = 0; k < 3; k++) {
    r.min[k] = next_down(static_cast<float>(std::clamp(box.min[k] - pad, -largest, largest)));
    r.max[k] = next_up(static_cast<float>(std::clamp(box.max[k] + pad, -largest, largest)));
    r.min[k] = std::max(r.min[k], -std::numeric_limits<float>::max());
    r.max[k] = std::min(r.max[k], std::numeric_limits<float>::max());
  }
  return r;
}

void primitive_box(const FlatPrimitive& p, double min[3], double max[3]) {
  const ExactBox box = exact_box(p);
  std::copy(box.min.begin(), box.min.end(), min);
  std::copy(box.max.begin(), box.max.end(), max);
}

}  // namespace caplet
