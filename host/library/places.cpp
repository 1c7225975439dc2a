// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "library/detail/places.h"

#include <fmt/format.h>

namespace caplet::v0 {

glm::dmat4 to_model(const Transform& rows) {
  glm::dmat4 out(1);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c)
      out[c][r] = rows[4 * static_cast<std::size_t>(r) + static_cast<std::size_t>(c)];
  return out;
}

Transform to_public(const glm::dmat4& m) {
  Transform rows;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c)
      rows[4 * static_cast<std::size_t>(r) + static_cast<std::size_t>(c)] = m[c][r];
  return rows;
}

TransformKeys keys_of(const std::vector<double>& times, std::span<const Transform> transforms) {
  if (times.size() != transforms.size())
    throw InputError(
        fmt::format("there are {} times and {} transforms", times.size(), transforms.size()));
  TransformKeys out;
  for (std::size_t i = 0; i < times.size(); ++i) out.push_back({times[i], to_model(transforms[i])});
  return out;
}

ShapeAt place_of(const caplet::Scene& scene, std::uint32_t shape) {
  std::size_t left = shape;
  if (left < scene.shapes.size()) return {{}, shape};
  left -= scene.shapes.size();
  for (std::size_t object = 0; object < scene.objects.size(); ++object) {
    const std::size_t count = scene.objects[object].shapes.size();
    if (left < count) return {static_cast<std::uint32_t>(object), static_cast<std::uint32_t>(left)};
    left -= count;
  }
  throw InputError(fmt::format("there is no shape {}, counted from 0", shape));
}

}  // namespace caplet::v0
