// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/sample_plan.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "base/check.h"
#include "film/detail/sums_around.h"
#include "film/noise.h"
#include "film/replicate_estimate.h"

namespace caplet {

namespace {

constexpr int tile = 8;  // pixels, as kernels/stages/path.cl numbers them
constexpr std::uint32_t least_step = 8;
// Plans aim at a noise that is a little lower: what they reach differs from what they aim at, and
// another look at the film costs more than these samples (2 %).
constexpr double aim_below = 0.99;

/// Around is the sum over some pixels with an estimate of the variance of a sample of luminance,
/// and of luminance.
struct Around {
  double variance = 0, luminance = 0, pixels = 0;
  void add(const Around& other) {
    variance += other.variance;
    luminance += other.luminance;
    pixels += other.pixels;
  }
};

Around around(const Film& film, std::size_t pixel) {
  std::array<double, 3> xyz{};
  if (!replicates_differ(film, pixel, xyz)) return {};
  return {xyz[1] * xyz[1] * sample_variance_factor(film, pixel),
          film.sum(Layer::color, 1, pixel) / film.samples(pixel), 1};
}

/// RelativeVariance is the variance of one sample of a pixel over the square of the luminance
/// around it and the floor: as its own replicates say it, if they do, and as its neighbours' do.
struct RelativeVariance {
  double own = 0, others = 0;
  bool seen = false;
};

std::vector<RelativeVariance> relative_variances(const Film& film) {
  const Window& window = film.layout().window;
  std::vector<Around> own(window.pixels());
  tbb::parallel_for(std::size_t{0}, own.size(),
                    [&](std::size_t pixel) { own[pixel] = around(film, pixel); });
  Around all;
  for (const Around& pixel : own) all.add(pixel);
  const double floor = all.pixels > 0 ? noise_floor * all.luminance / all.pixels : 0;
  const std::vector<Around> others = sums_around(own, window.width, window.height);
  std::vector<RelativeVariance> out(own.size());
  tbb::parallel_for(std::size_t{0}, own.size(), [&](std::size_t pixel) {
    const Around& near = others[pixel];
    const double mean = near.pixels > 0 ? near.luminance / near.pixels : 0,
                 luminance = std::max(0.0, mean) + floor;
    if (!(luminance > 0)) return;
    out[pixel].seen = own[pixel].pixels > 0;
    out[pixel].own = own[pixel].variance / (luminance * luminance);
    if (near.pixels > 0) out[pixel].others = near.variance / near.pixels / (luminance * luminance);
  });
  return out;
}

/// Wanted is how many samples pixels are to have: `per_root` times the root of their relative
/// variance.
class Wanted {
 public:
  Wanted(const Film& film, const NoiseTarget& target)
      : film_(film), target_(target), variances_(relative_variances(film)) {
    double own = 0, squares = 0, seen = 0;
    for (std::size_t pixel = 0; pixel < variances_.size(); ++pixel) {
      if (!variances_[pixel].seen) continue;
      const double variance = variances_[pixel].own / film_.samples(pixel);
      own += variance;
      squares += variance * variance;
      ++seen;
    }
    if (!(own > 0)) return;
    // The sum's standard deviation is at most the root of the squares' sum; half of it over the sum
    // is that of the root. Where few pixels make up most of it, it says little.
    noise_ = std::sqrt(own / seen) * (1 + 0.5 * std::sqrt(squares) / own);
    if (noise_ <= target.noise) return;
    // Neighbours that happened to vary little have asked for too few samples, and still say so. A
    // pixel's own estimate does not depend on how many it got: the mean of these is what is true.
    const double by_others = noise_at(0), aim = aim_below * target.noise * by_others / noise_;
    // Noise falls as the factor grows: bisection of its logarithm, down to 1 / 1000.
    double low = -30, high = 90;
    while (high - low > 1.4e-3) {
      const double middle = (low + high) / 2;
      (noise_at(std::exp2(middle)) > aim ? low : high) = middle;
    }
    per_root_ = std::exp2(high);
  }

  /// Returns the picture's noise.
  double noise() const { return noise_; }
  double samples(std::size_t pixel) const {
    return per_root_ > 0 ? samples(pixel, per_root_) : target_.least;
  }

 private:
  double samples(std::size_t pixel, double per_root) const {
    return std::clamp<double>(per_root * std::sqrt(variances_[pixel].others), target_.least,
                              target_.most);
  }
  /// Returns the root of the sum that noise is the mean of.
  double noise_at(double per_root) const {
    const auto add = [&](const tbb::blocked_range<std::size_t>& pixels, double sum) {
      for (std::size_t pixel = pixels.begin(); pixel != pixels.end(); ++pixel)
        if (variances_[pixel].others > 0)
          sum +=
              variances_[pixel].others /
              std::max<double>(film_.samples(pixel), per_root > 0 ? samples(pixel, per_root) : 1.0);
      return sum;
    };
    // Deterministic: the same sum for any number of threads.
    return std::sqrt(tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::size_t>(0, variances_.size(), 4096), 0.0, add, std::plus<>()));
  }

  const Film& film_;
  const NoiseTarget& target_;
  const std::vector<RelativeVariance> variances_;
  double noise_ = 0, per_root_ = 0;
};

/// Returns `samples` rounded up to 8, 12, 16, 24, 32, ...: few counts make large batches.
std::uint32_t step_of(double samples) {
  const auto whole = static_cast<std::uint32_t>(std::ceil(std::clamp(samples, 1.0, 0x1p30)));
  const std::uint32_t power = std::max(least_step, std::bit_ceil(whole)), less = power / 4 * 3;
  return less >= whole && less >= least_step ? less : power;
}

/// Calls look_at(number, x, y) for the pixels of a window, tile by tile.
template <class LookAt>
void for_tiles(const Window& window, const LookAt& look_at) {
  for (int band = 0; band < window.height; band += tile)
    for (int column = 0; column < window.width; column += tile)
      for (int y = band; y < std::min(band + tile, window.height); ++y)
        for (int x = column; x < std::min(column + tile, window.width); ++x)
          look_at(static_cast<std::size_t>(y) * static_cast<std::size_t>(window.width) +
                      static_cast<std::size_t>(x),
                  narrow<uint>(window.x + x), narrow<uint>(window.y + y));
}

}  // namespace

PixelSamples next_samples(const Film& film, std::uint32_t begin, std::uint32_t count) {
  PixelSamples out{count, {}};
  for_tiles(film.layout().window, [&](std::size_t pixel, uint x, uint y) {
    out.pixels.push_back({x, y, begin + film.samples(pixel), 0});
  });
  return out;
}

std::vector<PixelSamples> SamplePlan::take(double paths_wanted) {
  std::vector<PixelSamples> out;
  while (!samples.empty() && (out.empty() || paths_wanted > 0)) {
    PixelSamples& last = samples.back();
    const std::size_t pixels = static_cast<std::size_t>(
        std::clamp(paths_wanted / last.count, 1.0, static_cast<double>(last.pixels.size())));
    const auto first = last.pixels.end() - static_cast<std::ptrdiff_t>(pixels);
    out.push_back({last.count, {first, last.pixels.end()}});
    last.pixels.erase(first, last.pixels.end());
    const double taken = static_cast<double>(pixels) * last.count;
    paths -= taken;
    paths_left -= taken;
    paths_wanted -= taken;
    if (last.pixels.empty()) samples.pop_back();
  }
  return out;
}

SamplePlan plan_samples(const Film& film, std::uint32_t begin, const NoiseTarget& target) {
  CHECK_LE_(target.least, target.most);
  const Window& window = film.layout().window;
  std::optional<Wanted> wanted;
  if (target.noise > 0) wanted.emplace(film, target);
  SamplePlan plan;
  plan.noise = wanted ? wanted->noise() : 0;
  std::map<std::uint32_t, std::vector<PixelRecord>> by_count;
  const auto look_at = [&](std::size_t pixel, uint x, uint y) {
    const std::uint32_t has = film.samples(pixel);
    const double more = (wanted ? wanted->samples(pixel) : target.most) - has;
    if (more <= 0) return;
    std::uint32_t count = target.most - has;
    if (has < target.least)
      count = target.least - has;
    else if (wanted)
      count = std::min({count, step_of(more), step_of(has)});
    by_count[count].push_back({x, y, begin + has, 0});
    plan.paths += count;
    plan.paths_left += std::max<double>(more, count);
  };
  for_tiles(window, look_at);
  for (auto& [count, pixels] : by_count) plan.samples.push_back({count, std::move(pixels)});
  return plan;
}

}  // namespace caplet
