// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Draws depth cue and outlines from the picture's layers of depth and objects.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "post/detail/parts.h"

namespace caplet::post {

namespace {

constexpr float kSeen = 0.5f;   // coverage from which a pixel counts as a shape
constexpr double kJump = 0.03;  // of the visible depth range: the least step that is outlined
constexpr double kSteeper = 2;  // times the slope beside it, to tell a step from a slope

class Field {
 public:
  explicit Field(const LayeredImage& layers, std::span<const std::uint32_t> joined = {})
      : width_(layers.data_width),
        height_(layers.data_height),
        coverage_(layers.find("A")->floats),
        depth_(layers.find("Z")->floats),
        objects_(layers.find("object.id") ? &layers.find("object.id")->uints : nullptr),
        joined_(joined) {
    for (std::size_t i = 0; i < coverage_.size(); ++i)
      if (coverage_[i] >= kSeen) {
        near_ = std::min(near_, depth_[i]);
        far_ = std::max(far_, depth_[i]);
      }
  }

  int width() const { return width_; }
  int height() const { return height_; }
  double range() const { return far_ > near_ ? double{far_} - double{near_} : 0; }
  double nearest() const { return near_; }
  float depth(std::size_t i) const { return depth_[i]; }
  float coverage(std::size_t i) const { return coverage_[i]; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  /// Returns where a line crosses between the centres of two neighbours, from 0 to 1 from the
  /// first; below 0: none.
  double crossing(int x0, int y0, int x1, int y1) const {
    const std::size_t a = index(x0, y0), b = index(x1, y1);
    const bool seen_a = coverage_[a] >= kSeen, seen_b = coverage_[b] >= kSeen;
    if (seen_a != seen_b)
      return (double{kSeen} - double{coverage_[a]}) / (double{coverage_[b]} - double{coverage_[a]});
    if (!seen_a) return -1;
    if (object(a) != object(b)) return 0.5;
    return is_step(x0, y0, x1 - x0, y1 - y0) ? 0.5 : -1;
  }

 private:
  std::uint32_t object(std::size_t i) const {
    const std::uint32_t number = (*objects_)[i];
    return number < joined_.size() ? joined_[number] : number;
  }

  /// Returns the depth `steps` pixels from (x, y), or the last one before the background or the
  /// picture's edge.
  double depth_along(int x, int y, int dx, int dy, int steps) const {
    double out = double{depth_[index(x, y)]};
    for (int i = 0; i < std::abs(steps); ++i) {
      x += steps < 0 ? -dx : dx;
      y += steps < 0 ? -dy : dy;
      if (x < 0 || y < 0 || x >= width_ || y >= height_ || coverage_[index(x, y)] < kSeen) break;
      out = double{depth_[index(x, y)]};
    }
    return out;
  }

  /// Pixels on an edge have depths between those of both sides, so a step is measured over three
  /// pixels and placed where it is steepest.
  bool is_step(int x, int y, int dx, int dy) const {
    std::array<double, 6> at{};  // from two pixels before the pair to two after it
    for (int i = 0; i < 6; ++i) at[static_cast<std::size_t>(i)] = depth_along(x, y, dx, dy, i - 2);
    const auto difference = [&at](std::size_t i, std::size_t j) { return std::abs(at[i] - at[j]); };
    const double step = difference(1, 4), beside = difference(0, 1) + difference(4, 5);
    const bool is_steepest =
        difference(2, 3) >= difference(1, 2) && difference(2, 3) > difference(3, 4);
    return is_steepest && step > kJump * range() && step > kSteeper * beside;
  }

  int width_, height_;
  const std::vector<float>&coverage_, &depth_;
  const std::vector<std::uint32_t>* objects_;
  std::span<const std::uint32_t> joined_;
  float near_ = std::numeric_limits<float>::max(), far_ = 0;
};

}  // namespace

void draw_depth_cue(Shown& picture, const LayeredImage& layers, double strength) {
  const Field field(layers);
  if (!(field.range() > 0)) return;
  // The background colour is the mean of the uncovered pixels; without any it is black.
  std::array<double, 3> mean{};
  double count = 0;
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
    if (field.coverage(i) > 0) continue;
    for (std::size_t c = 0; c < 3; ++c) mean[c] += double{picture.rgb[i][c]};
    ++count;
  }
  for (double& value : mean) value = count > 0 ? value / count : 0;
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
    if (!(field.coverage(i) > 0)) continue;
    const double part =
        std::clamp((double{field.depth(i)} - field.nearest()) / field.range(), 0.0, 1.0) * strength;
    if (picture.has_alpha()) {
      picture.alpha[i] *= static_cast<float>(1 - part);
      continue;
    }
    for (std::size_t c = 0; c < 3; ++c)
      picture.rgb[i][c] =
          static_cast<float>((1 - part) * double{picture.rgb[i][c]} + part * mean[c]);
  }
}

void draw_outline(Shown& picture, const LayeredImage& layers, double width,
                  std::span<const std::uint32_t> joined) {
  const Field field(layers, joined);
  Mask mask(picture.width, picture.height);
  // Lines connect the crossings on the sides of each square of four pixel centres (marching
  // squares; Lorensen and Cline 1987).
  for (int y = 0; y + 1 < field.height(); ++y)
    for (int x = 0; x + 1 < field.width(); ++x) {
      const std::array<double, 4> at = {
          field.crossing(x, y, x + 1, y), field.crossing(x + 1, y, x + 1, y + 1),
          field.crossing(x, y + 1, x + 1, y + 1), field.crossing(x, y, x, y + 1)};
      const glm::dvec2 corner(x + 0.5, y + 0.5);
      const std::array<glm::dvec2, 4> points = {
          corner + glm::dvec2(at[0], 0), corner + glm::dvec2(1, at[1]),
          corner + glm::dvec2(at[2], 1), corner + glm::dvec2(0, at[3])};
      std::vector<glm::dvec2> ends;
      for (std::size_t side = 0; side < 4; ++side)
        if (at.at(side) >= 0) ends.push_back(points.at(side));
      if (ends.size() == 2) {
        mask.line(ends[0], ends[1], width);
      } else if (ends.size() > 2) {
        glm::dvec2 middle(0);
        for (const glm::dvec2& end : ends) middle += end / static_cast<double>(ends.size());
        for (const glm::dvec2& end : ends) mask.line(end, middle, width);
      }
    }
  paint(picture, mask, {0, 0, 0});
}

}  // namespace caplet::post
