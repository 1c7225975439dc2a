// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "film/transfer.h"
#include "post/detail/canvas.h"

namespace caplet::post {

namespace {

double distance_to_segment(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 along = b - a;
  const double squared = glm::dot(along, along);
  const double t = squared > 0 ? std::clamp(glm::dot(p - a, along) / squared, 0.0, 1.0) : 0;
  return glm::length(p - a - t * along);
}

}  // namespace

void Mask::line(const glm::dvec2& from, const glm::dvec2& to, double width) {
  // Lines thinner than a pixel are drawn fainter, not thinner.
  const double strength = std::min(width, 1.0), half = 0.5 * std::max(width, 1.0), reach = half + 1;
  const auto bound = [](double v, int end) {
    return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(end)));
  };
  const glm::dvec2 low = glm::min(from, to) - reach, high = glm::max(from, to) + reach;
  for (int y = bound(std::floor(low.y), height_); y < bound(std::ceil(high.y), height_); ++y)
    for (int x = bound(std::floor(low.x), width_); x < bound(std::ceil(high.x), width_); ++x) {
      const double away = distance_to_segment({x + 0.5, y + 0.5}, from, to);
      const double share = strength * std::clamp(half + 0.5 - away, 0.0, 1.0);
      at(x, y) = std::max(at(x, y), static_cast<float>(share));
    }
}

void Mask::box(const glm::dvec2& low, const glm::dvec2& high) {
  const auto overlap = [](double a0, double a1, int pixel) {
    return std::max(0.0, std::min(a1, pixel + 1.0) - std::max(a0, static_cast<double>(pixel)));
  };
  const auto bound = [](double v, int end) {
    return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(end)));
  };
  for (int y = bound(std::floor(low.y), height_); y < bound(std::ceil(high.y), height_); ++y)
    for (int x = bound(std::floor(low.x), width_); x < bound(std::ceil(high.x), width_); ++x)
      at(x, y) = std::max(
          at(x, y), static_cast<float>(overlap(low.x, high.x, x) * overlap(low.y, high.y, y)));
}

void paint(Shown& picture, std::size_t pixel, float share, const std::array<float, 3>& srgb) {
  if (!(share > 0)) return;
  const float under = picture.has_alpha() ? picture.alpha[pixel] : 1.0f,
              over = share + (1 - share) * under;
  for (std::size_t c = 0; c < 3; ++c) {
    float& of = picture.rgb[pixel][c];
    of = linear_from_srgb((share * srgb[c] + (1 - share) * under * srgb_from_linear(of)) / over);
  }
  if (picture.has_alpha()) picture.alpha[pixel] = over;
}

void paint(Shown& picture, const Mask& mask, const std::array<float, 3>& srgb) {
  const std::vector<float>& shares = mask.shares();
  for (std::size_t i = 0; i < shares.size(); ++i) paint(picture, i, shares[i], srgb);
}

}  // namespace caplet::post
