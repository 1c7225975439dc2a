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

std::vector<KeyPlace> key_places(const std::vector<float>& leaves, std::uint32_t times,
                                 std::uint32_t segments, float begin, float end) {
  const float* pairs = &leaves[times];
  const auto place_of = [&](float time) {
    std::uint32_t segment = 0;
    while (segment + 1 < segments && pairs[2 * segment + 2] <= time) ++segment;
    return KeyPlace{segment, std::min((time - pairs[2 * segment]) * pairs[2 * segment + 1], 1.0f)};
  };
  std::vector<KeyPlace> places{place_of(begin)};
  const KeyPlace last = place_of(end);
  for (std::uint32_t segment = places[0].segment + 1; segment <= last.segment; ++segment)
    places.push_back({segment, 0});
  places.push_back(last);
  return places;
}

void SweptBox::add(const float* from, const float* to, float u, float from_radius,
                   float to_radius) {
  const auto mix = fused_between(u);
  const double radius = mix(from_radius, to_radius);
  for (std::size_t k = 0; k < 3; ++k) {
    const double at = mix(from[k], to[k]);
    low_[k] = std::min(low_[k], at - radius);
    high_[k] = std::max(high_[k], at + radius);
    for (const float value : {from[k], to[k], from_radius, to_radius})
      largest_ = std::max(largest_, std::abs(double{value}));
  }
}

// Between two places everything is linear, and so are the sides of the box. A fused product rounds
// a difference and a sum: less than 2^-20 of the largest number.
void SweptBox::keep(FlatPrimitive& p) const {
  const double more = 0x1p-20 * largest_;
  for (std::size_t k = 0; k < 3; ++k) {
    p.kept_box()[k] = std::nextafter(static_cast<float>(low_[k] - more), -INFINITY);
    p.kept_box()[3 + k] = std::nextafter(static_cast<float>(high_[k] + more), INFINITY);
  }
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
  for (const MeshMotion::Key& key : motion_.keys()) {
    put_all(key.positions);
    if (has_normals) put_all(key.normals);
  }
  while (leaves_.size() % 8 != 0) leaves_.push_back(0);
  set_moving_triangle_box(p, leaves_, 0, 1);
  return p;
}

void set_moving_triangle_box(FlatPrimitive& p, const std::vector<float>& leaves, float begin,
                             float end) {
  SweptBox box;
  const std::size_t stride = moving_triangle_stride(p.data);
  for (const KeyPlace& place : key_places(leaves, moving_triangle_times(p.data),
                                          moving_triangle_segments(p.data), begin, end)) {
    const float* from = &leaves[moving_triangle_begin(p.data) + stride * place.segment];
    for (const std::size_t at : {0U, 3U, 6U}) box.add(from + at, from + stride + at, place.u, 0, 0);
  }
  box.keep(p);
}

double moving_triangle_area(const FlatPrimitive& p, const std::vector<float>& leaves) {
  return 0.5 * glm::length(cross_at_start(p, leaves));
}

void moving_triangle_pieces(const FlatPrimitive& p, const std::vector<float>& leaves,
                            Pieces& pieces) {
  pieces.flat(0, 0.5 * cross_at_start(p, leaves));
}

}  // namespace caplet
