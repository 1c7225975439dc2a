// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/check.h"
#include "lower/detail/flat_shapes.h"
#include "lower/detail/shapes.h"

namespace caplet {

using glm::dvec3;

namespace {

/// Returns twice the area of the triangle when the shutter opens, along its normal.
dvec3 cross_at_start(const FlatPrimitive& p, const std::vector<float>& leaves) {
  const float* v = &leaves[moving_triangle_begin(p.data)];
  return glm::cross(point3(v + 3) - point3(v), point3(v + 6) - point3(v));
}

}  // namespace

std::uint32_t append_key_times(const ShutterKeys& times, std::vector<float>& leaves) {
  const auto begin = narrow<std::uint32_t>(leaves.size());
  leaves.insert(leaves.end(), times.pairs().begin(), times.pairs().end());
  while (leaves.size() % 8 != 0) leaves.push_back(0);
  return begin;
}

MovingTriangles::MovingTriangles(const MeshMotion& motion, std::vector<float>& leaves)
    : motion_(motion), leaves_(leaves), times_(append_key_times(motion.times(), leaves)) {}

FlatPrimitive MovingTriangles::primitive(const std::array<std::uint32_t, 3>& corners) {
  const bool has_normals = !motion_.keys()[0].normals.empty();
  FlatPrimitive p = make_primitive(shape_moving_triangle);
  p.data[moving_triangle_at_begin] = std::bit_cast<float>(narrow<std::uint32_t>(leaves_.size()));
  p.data[moving_triangle_at_times] = std::bit_cast<float>(times_);
  p.data[moving_triangle_at_segments] = std::bit_cast<float>(motion_.times().segments());
  p.data[moving_triangle_at_stride] = std::bit_cast<float>(has_normals ? 18u : 9u);
  const auto put_all = [&](const std::vector<glm::vec3>& of) {
    for (const std::uint32_t corner : corners)
      for (int k = 0; k < 3; ++k) leaves_.push_back(of[corner][k]);
  };
  glm::vec3 low(INFINITY), high(-INFINITY), largest(0);
  for (const MeshMotion::Key& key : motion_.keys()) {
    put_all(key.positions);
    if (has_normals) put_all(key.normals);
    for (const std::uint32_t corner : corners) {
      low = glm::min(low, key.positions[corner]);
      high = glm::max(high, key.positions[corner]);
      largest = glm::max(largest, glm::abs(key.positions[corner]));
    }
  }
  while (leaves_.size() % 8 != 0) leaves_.push_back(0);
  // Vertices go straight between two keys. A fused product rounds a difference and a sum: less than
  // 2^-20 of the largest number.
  for (int k = 0; k < 3; ++k) {
    const double more = 0x1p-20 * static_cast<double>(largest[k]);
    p.kept_box()[k] =
        std::nextafter(static_cast<float>(static_cast<double>(low[k]) - more), -INFINITY);
    p.kept_box()[3 + k] =
        std::nextafter(static_cast<float>(static_cast<double>(high[k]) + more), INFINITY);
  }
  return p;
}

double moving_triangle_area(const FlatPrimitive& p, const std::vector<float>& leaves) {
  return 0.5 * glm::length(cross_at_start(p, leaves));
}

void moving_triangle_pieces(const FlatPrimitive& p, const std::vector<float>& leaves,
                            Pieces& pieces) {
  pieces.flat(0, 0.5 * cross_at_start(p, leaves));
}

}  // namespace caplet
