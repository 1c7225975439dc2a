// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "support/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace caplet::test {

namespace {

constexpr int block = 8;

double mean_of(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

using Block = std::array<double, 3>;

std::vector<Block> block_means(const Picture& picture) {
  const int columns = picture.width / block, rows = picture.height / block;
  std::vector<Block> out(static_cast<std::size_t>(columns * rows), Block{});
  for (int y = 0; y < rows * block; ++y)
    for (int x = 0; x < columns * block; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        out[static_cast<std::size_t>(y / block * columns + x / block)][c] +=
            static_cast<double>(
                picture.rgb[static_cast<std::size_t>(y * picture.width + x) * 3 + c]) /
            (block * block);
  return out;
}

void check_sizes(const Picture& a, const Picture& b) {
  if (a.width != b.width || a.height != b.height || a.rgb.size() != b.rgb.size() || a.rgb.empty())
    throw std::logic_error("pictures of different sizes: " + std::to_string(a.width) + "x" +
                           std::to_string(a.height) + " and " + std::to_string(b.width) + "x" +
                           std::to_string(b.height));
}

}  // namespace

Figures compare(const Picture& ours, const Picture& theirs) {
  check_sizes(ours, theirs);
  Figures out;
  const double mean = mean_of(theirs.rgb);
  out.mean = mean_of(ours.rgb) / mean - 1;

  const std::vector<Block> a = block_means(ours), b = block_means(theirs);
  double block_mean = 0, squares = 0;
  for (const Block& value : b)
    block_mean += (value[0] + value[1] + value[2]) / (3 * static_cast<double>(b.size()));
  for (std::size_t i = 0; i < b.size(); ++i) {
    const double scale = std::max((b[i][0] + b[i][1] + b[i][2]) / 3, 0.02 * block_mean);
    for (std::size_t c = 0; c < 3; ++c) squares += std::pow((a[i][c] - b[i][c]) / scale, 2);
  }
  out.blocks = std::sqrt(squares / (3 * static_cast<double>(b.size())));

  if (ours.variance.size() != ours.rgb.size() || theirs.variance.size() != theirs.rgb.size())
    return out;
  double sum = 0, sum_squares = 0;
  std::size_t far = 0;
  for (std::size_t i = 1; i < ours.rgb.size(); i += 3) {
    const double variance =
        static_cast<double>(ours.variance[i]) + static_cast<double>(theirs.variance[i]);
    if (!(variance > 0)) continue;
    const double z = (static_cast<double>(ours.rgb[i]) - static_cast<double>(theirs.rgb[i])) /
                     std::sqrt(variance);
    if (!std::isfinite(z)) continue;
    sum += z;
    sum_squares += z * z;
    far += std::abs(z) > 3;
    ++out.pixels;
  }
  const auto n = static_cast<double>(std::max<std::size_t>(out.pixels, 1));
  out.z_mean = sum / n;
  out.z_sd = std::sqrt(std::max(0.0, sum_squares / n - out.z_mean * out.z_mean));
  out.beyond_3 = static_cast<double>(far) / n;
  return out;
}

double clipped_relative_squared_error(const Picture& ours, const Picture& theirs) {
  check_sizes(ours, theirs);
  std::vector<double> errors;
  for (std::size_t i = 0; i < ours.rgb.size(); ++i) {
    const double a = ours.rgb[i], b = theirs.rgb[i];
    errors.push_back((a - b) * (a - b) / (b * b + 1e-2));
  }
  std::sort(errors.begin(), errors.end());
  errors.resize(errors.size() - errors.size() / 100);
  return std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
}

}  // namespace caplet::test
