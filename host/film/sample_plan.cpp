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

using OwnSum = SampledPixels::OwnSum;

OwnSum own_of(const Film& film, std::size_t pixel) {
  std::array<double, 3> xyz{};
  if (!replicates_differ(film, pixel, xyz)) return {};
  return {xyz[1] * xyz[1] * sample_variance_factor(film, pixel),
          film.sum(Layer::color, 1, pixel) / film.samples(pixel), 1};
}

/// RelativeVariance is the variance of one sample of a pixel over the square of its noise_unit: as
/// its own replicates say it, if they do, and as its neighbours' do.
struct RelativeVariance {
  double own = 0, others = 0;
  bool seen = false;
};

std::vector<RelativeVariance> relative_variances(const SampledPixels& pixels,
                                                 const NoiseMeasure& measure) {
  const std::vector<OwnSum>& own = pixels.own();
  OwnSum all;
  for (const OwnSum& pixel : own) all.add(pixel);
  const double floor = all.pixels > 0 ? noise_floor * all.luminance / all.pixels : 0;
  const std::vector<OwnSum> others =
      sums_around(own, pixels.window().width, pixels.window().height);
  std::vector<RelativeVariance> out(own.size());
  tbb::parallel_for(std::size_t{0}, own.size(), [&](std::size_t pixel) {
    const OwnSum& near = others[pixel];
    const double mean = near.pixels > 0 ? near.luminance / near.pixels : 0;
    if (!(std::max(0.0, mean) + floor > 0)) return;
    const double unit = noise_unit(measure, mean, floor);
    out[pixel].seen = own[pixel].pixels > 0;
    out[pixel].own = own[pixel].variance / (unit * unit);
    if (near.pixels > 0) out[pixel].others = near.variance / near.pixels / (unit * unit);
  });
  return out;
}

/// Wanted is how many samples pixels are to have: `per_root` times the root of their relative
/// variance.
class Wanted {
 public:
  Wanted(const SampledPixels& pixels, const NoiseTarget& target)
      : pixels_(pixels), target_(target), variances_(relative_variances(pixels, target.measure)) {
    double own = 0, squares = 0, seen = 0;
    for (std::size_t pixel = 0; pixel < variances_.size(); ++pixel) {
      if (!variances_[pixel].seen) continue;
      const double variance = variances_[pixel].own / pixels_.samples(pixel);
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
          sum += variances_[pixel].others /
                 std::max<double>(pixels_.samples(pixel),
                                  per_root > 0 ? samples(pixel, per_root) : 1.0);
      return sum;
    };
    // Deterministic: the same sum for any number of threads.
    return std::sqrt(tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::size_t>(0, variances_.size(), 4096), 0.0, add, std::plus<>()));
  }

  const SampledPixels& pixels_;
  const NoiseTarget& target_;
  const std::vector<RelativeVariance> variances_;
  double noise_ = 0, per_root_ = 0;
};

/// Returns `samples` rounded up to 8, 16, 24, 32, 48, 64, 96, ...
std::uint32_t step_of(double samples) {
  const auto whole = static_cast<std::uint32_t>(std::ceil(std::clamp(samples, 1.0, 0x1p30)));
  const std::uint32_t power = std::max(least_step, std::bit_ceil(whole)), less = power / 4 * 3;
  return less >= whole && less % least_step == 0 ? less : power;
}

/// Returns how many of a pixel's `count` samples a record of it has: 8, 32, 128, ..., of which it
/// then has at most 6. Few kinds of records make few batches, which are large.
std::uint32_t record_of(std::uint32_t count) {
  std::uint32_t each = least_step;
  while (count / each > 6) each *= 4;
  return count % each == 0 ? each : count;
}

/// Calls look_at(number, x, y) for the pixels of a window's rows [band, band + tile), tile by tile.
template <class LookAt>
void for_tiles(const Window& window, int band, const LookAt& look_at) {
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
  const Window& window = film.layout().window;
  for (int band = 0; band < window.height; band += tile)
    for_tiles(window, band, [&](std::size_t pixel, uint x, uint y) {
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
    auto first = last.pixels.end() - static_cast<std::ptrdiff_t>(pixels);
    while (first != last.pixels.begin() && is_same_pixel(*(first - 1), *first)) --first;
    const double taken = static_cast<double>(last.pixels.end() - first) * last.count;
    out.push_back({last.count, {first, last.pixels.end()}});
    last.pixels.erase(first, last.pixels.end());
    paths -= taken;
    paths_left -= taken;
    paths_wanted -= taken;
    if (last.pixels.empty()) samples.pop_back();
  }
  return out;
}

SampledPixels::SampledPixels(const FilmLayout& layout)
    : window_(layout.window), samples_(layout.window.pixels()) {
  if (layout.layers.has(Layer::variance)) own_.resize(samples_.size());
}

void SampledPixels::look_at(const Film& rows) {
  const Window& window = rows.layout().window;
  CHECK_EQ_(window.x, window_.x);
  CHECK_EQ_(window.width, window_.width);
  CHECK_EQ_(window_.holds(window), true);
  const std::size_t first =
      static_cast<std::size_t>(window.y - window_.y) * static_cast<std::size_t>(window_.width);
  tbb::parallel_for(std::size_t{0}, window.pixels(), [&](std::size_t pixel) {
    samples_[first + pixel] = rows.samples(pixel);
    if (!own_.empty()) own_[first + pixel] = own_of(rows, pixel);
  });
}

double SampledPixels::mean_samples() const {
  double sum = 0;
  for (const std::uint32_t samples : samples_) sum += samples;
  return samples_.empty() ? 0 : sum / static_cast<double>(samples_.size());
}

SamplePlan plan_samples(const Film& film, std::uint32_t begin, const NoiseTarget& target) {
  SampledPixels pixels(film.layout());
  pixels.look_at(film);
  return plan_samples(pixels, begin, target);
}

SamplePlan plan_samples(const SampledPixels& pixels, std::uint32_t begin,
                        const NoiseTarget& target) {
  CHECK_LE_(target.least, target.most);
  const Window& window = pixels.window();
  std::optional<Wanted> wanted;
  if (target.noise > 0) wanted.emplace(pixels, target);
  // Bands of tiles are looked at side by side, and joined in their order.
  struct Band {
    std::map<std::uint32_t, std::vector<PixelRecord>> by_count;
    double paths = 0, paths_left = 0;
  };
  std::vector<Band> bands(static_cast<std::size_t>((window.height + tile - 1) / tile));
  tbb::parallel_for(std::size_t{0}, bands.size(), [&](std::size_t number) {
    Band& band = bands[number];
    for_tiles(window, static_cast<int>(number) * tile, [&](std::size_t pixel, uint x, uint y) {
      const std::uint32_t has = pixels.samples(pixel);
      const double more = (wanted ? wanted->samples(pixel) : target.most) - has;
      if (more <= 0) return;
      std::uint32_t count = target.most - has;
      if (has < target.least)
        count = target.least - has;
      else if (wanted)
        count = std::min({count, step_of(more), step_of(has)});
      const std::uint32_t each = record_of(count);
      for (std::uint32_t done = 0; done < count; done += each)
        band.by_count[each].push_back({x, y, begin + has + done, 0});
      band.paths += count;
      band.paths_left += std::max<double>(more, count);
    });
  });
  SamplePlan plan;
  plan.noise = wanted ? wanted->noise() : 0;
  std::map<std::uint32_t, std::vector<PixelRecord>> by_count;
  for (const Band& band : bands) {
    plan.paths += band.paths;
    plan.paths_left += band.paths_left;
    for (const auto& [count, some] : band.by_count) {
      std::vector<PixelRecord>& all = by_count[count];
      all.insert(all.end(), some.begin(), some.end());
    }
  }
  for (auto& [count, some] : by_count) plan.samples.push_back({count, std::move(some)});
  return plan;
}

}  // namespace caplet
