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

constexpr float kSeen = 0.5f;  // coverage from which a pixel counts as a shape
constexpr std::uint32_t kNothing = std::numeric_limits<std::uint32_t>::max();  // that a sample hit
constexpr double kJump = 0.03;     // of the visible depth range: the least step that is outlined
constexpr double kHalfway = 1.25;  // ratio of distances below which a depth is of either side
constexpr double kSteeper = 2;     // times the slope beside it, to tell a step from a slope

class Field {
 public:
  explicit Field(const LayeredImage& layers, std::span<const std::uint32_t> joined = {})
      : width_(layers.data_width),
        height_(layers.data_height),
        coverage_(layers.find("A")->floats),
        depth_(layers.find("Z")->floats) {
    for (std::size_t i = 0; i < coverage_.size(); ++i)
      if (coverage_[i] >= kSeen) {
        near_ = std::min(near_, depth_[i]);
        far_ = std::max(far_, depth_[i]);
      }
    if (layers.find("object.id")) objects_ = objects_of(layers.find("object.id")->uints, joined);
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
    const Profile depths = profile(x0, y0, x1 - x0, y1 - y0);
    return objects_[a] != objects_[b] || is_step(depths) ? step_place(depths) : -1;
  }

 private:
  // Depths along a row or column, from two pixels before a pair of neighbours to two after it.
  using Profile = std::array<double, 6>;

  /// Returns the object of each pixel that counts as a shape.
  std::vector<std::uint32_t> objects_of(const std::vector<std::uint32_t>& numbers,
                                        std::span<const std::uint32_t> joined) const {
    std::vector<std::uint32_t> own(numbers.size(), kNothing);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (coverage_[i] >= kSeen)
        own[i] = numbers[i] < joined.size() ? joined[numbers[i]] : numbers[i];
    std::vector<std::uint32_t> out = own;
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x)
        if (coverage_[index(x, y)] >= kSeen) out[index(x, y)] = likely_object(own, x, y);
    return out;
  }

  /// Returns the object that fills most of a pixel. Its number is that of one sample, which may
  /// have missed that object. So a pixel between two objects is of the one whose depth is nearer to
  /// its own; others that continue no line of their object, between two opposite neighbours, take
  /// the most frequent one around them.
  std::uint32_t likely_object(const std::vector<std::uint32_t>& objects, int x, int y) const {
    struct Neighbour {
      std::uint32_t object = kNothing;
      double depth = 0;
    };
    const std::uint32_t own = objects[index(x, y)];
    const double depth = double{depth_[index(x, y)]};
    std::array<Neighbour, 8> around{};  // opposite ones are 4 apart
    for (std::size_t k = 0; k < around.size(); ++k) {
      constexpr std::array<int, 8> dx = {1, 1, 0, -1, -1, -1, 0, 1},
                                   dy = {0, 1, 1, 1, 0, -1, -1, -1};
      const int u = x + dx.at(k), v = y + dy.at(k);
      if (u < 0 || v < 0 || u >= width_ || v >= height_) continue;
      around.at(k) = {objects[index(u, v)], double{depth_[index(u, v)]}};
    }
    bool goes_on = false;
    double widest = 0;  // difference of two sides' depths
    std::uint32_t side = kNothing;
    for (std::size_t k = 0; k < 4; ++k) {
      const Neighbour &a = around.at(k), &b = around.at(k + 4);
      if (a.object == kNothing || b.object == kNothing) continue;
      goes_on |= a.object == own && b.object == own;
      const double to_a = std::abs(depth - a.depth), to_b = std::abs(depth - b.depth),
                   apart = std::abs(a.depth - b.depth);
      const bool is_between = to_a <= apart && to_b <= apart,
                 is_other = own != kNothing && own != a.object && own != b.object;
      if (a.object == b.object || is_other || !is_between || apart <= widest) continue;
      widest = apart;
      const bool is_halfway = std::max(to_a, to_b) < kHalfway * std::min(to_a, to_b);
      side = is_halfway ? own : to_a < to_b ? a.object : b.object;
    }
    if (side != kNothing) return side;
    if (goes_on) return own;
    std::uint32_t out = own;
    std::ptrdiff_t most = 0;
    for (const Neighbour& one : around) {
      const std::ptrdiff_t count = std::ranges::count(around, one.object, &Neighbour::object);
      if (one.object == kNothing || count <= most) continue;
      most = count;
      out = one.object;
    }
    return out;
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

  Profile profile(int x, int y, int dx, int dy) const {
    Profile out{};
    for (int i = 0; i < 6; ++i) out[static_cast<std::size_t>(i)] = depth_along(x, y, dx, dy, i - 2);
    return out;
  }

  static double between(const Profile& at, std::size_t i, std::size_t j) {
    return std::abs(at.at(i) - at.at(j));
  }

  /// Returns whether depths differ across the middle two pixels by more than a slope. Pixels on an
  /// edge have depths between those of both sides, so a step is measured over three pixels.
  static bool is_steep(const Profile& at) {
    return between(at, 1, 4) > kSteeper * (between(at, 0, 1) + between(at, 4, 5));
  }

  /// Returns whether such a step counts where nothing else tells shapes apart, and is steepest
  /// here.
  bool is_step(const Profile& at) const {
    const bool is_steepest =
        between(at, 2, 3) >= between(at, 1, 2) && between(at, 2, 3) > between(at, 3, 4);
    return is_steepest && between(at, 1, 4) > kJump * range() && is_steep(at);
  }

  /// Returns where between the middle two the depth is halfway between those of both sides, whose
  /// parts of a pixel its mean depth tells; in the middle of shapes that touch.
  static double step_place(const Profile& at) {
    if (!is_steep(at) || at[2] == at[3]) return 0.5;
    return std::clamp((0.5 * (at[1] + at[4]) - at[2]) / (at[3] - at[2]), 0.0, 1.0);
  }

  int width_, height_;
  const std::vector<float>&coverage_, &depth_;
  std::vector<std::uint32_t> objects_;
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
