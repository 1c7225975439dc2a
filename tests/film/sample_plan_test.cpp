// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// How many samples pixels get, against sums by hand.
#include "film/sample_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "film_sums.h"

namespace caplet::test::sample_plan_test {
namespace {

using testing::ElementsAre;

constexpr std::uint32_t usual = 32;  // samples

/// A pixel whose first replicate's mean luminance is `y + d`, and the second's `y - d`, so that the
/// variance of a sample is d^2 n.
struct Pixel {
  double y = 1, d = 0;
  std::uint32_t samples = usual;
  double coverage = 1;
};

/// The variance of the mean of a sample, of `usual` samples, is `variance`.
Pixel noisy(double variance, double y = 1) { return {y, std::sqrt(variance / usual)}; }

/// The noise that pixels with these variances of their means have, over a luminance of 1 and the
/// floor, and one standard error more.
double noise_of(const std::vector<double>& variances) {
  double sum = 0, squares = 0;
  for (const double variance : variances) {
    sum += variance / 1.5625;
    squares += variance / 1.5625 * variance / 1.5625;
  }
  return std::sqrt(sum / static_cast<double>(variances.size())) *
         (1 + std::sqrt(squares) / sum / 2);
}

Film film_of(int width, int height, const std::vector<Pixel>& pixels) {
  FilmLayout layout;
  layout.width = width + 5;
  layout.height = height + 7;
  layout.window = {2, 3, width, height};
  layout.layers = Layers::none().with(Layer::variance);
  Film film(layout);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Pixel& pixel = pixels[i];
    const double half = pixel.samples / 2.0;
    film.words()[i * layout.words_per_pixel()] =
        std::uint64_t{pixel.samples / 2} << 32 | pixel.samples;
    set_sum(film, Layer::color, 1, i, 2 * half * pixel.y);
    set_sum(film, Layer::variance, 1, i, half * (pixel.y + pixel.d));
    set_sum(film, Layer::coverage, 0, i, pixel.samples * pixel.coverage);
  }
  return film;
}

Film even_film(int width, int height, const Pixel& pixel) {
  return film_of(width, height,
                 std::vector<Pixel>(static_cast<std::size_t>(width * height), pixel));
}

/// How many more samples each pixel gets, by its place in the window.
std::map<std::pair<uint, uint>, std::uint32_t> more_of(const SamplePlan& plan) {
  std::map<std::pair<uint, uint>, std::uint32_t> out;
  double paths = 0;
  for (const PixelSamples& each : plan.samples)
    for (std::size_t i = 0; i < each.pixels.size(); ++i) {
      const PixelRecord& pixel = each.pixels[i];
      const auto [found, fresh] = out.insert({{pixel.x - 2, pixel.y - 3}, each.count});
      if (!fresh) {
        // Records of a pixel lie together, and their samples follow each other.
        const PixelRecord& before = each.pixels[i - 1];
        EXPECT_TRUE(i > 0 && is_same_pixel(before, pixel)) << "twice";
        EXPECT_EQ(pixel.sample_begin, before.sample_begin + each.count);
        found->second += each.count;
      }
      paths += each.count;
    }
  EXPECT_EQ(plan.paths, paths);
  EXPECT_GE(plan.paths_left, paths);
  return out;
}

// Pixels of a luminance of 4 are shown as white, where noise is hardly seen: in the display's space
// they get the fewest samples, and all of those that are asked for more are dark.
TEST(SamplePlan, OfADisplayGivesDarkPixelsMore) {
  std::vector<Pixel> pixels(200, noisy(0.5, 4));
  for (std::size_t i = 0; i < 200; ++i)
    if (i % 20 < 10) pixels[i] = noisy(0.02, 0.2);
  const Film film = film_of(20, 10, pixels);
  NoiseTarget target{0.01, 16, 4096};
  target.measure = NoiseSpace::display;
  const SamplePlan plan = plan_samples(film, 0, target);
  const auto more = more_of(plan);
  EXPECT_EQ(more.count({0, 5}), 1u);
  EXPECT_EQ(more.count({19, 5}), 0u);
  // Three of ten dark columns see bright ones around them. Relative noise would be 0.031.
  const double slope = 1.055 / 2.4 * std::pow(0.2, 1 / 2.4 - 1);
  EXPECT_GT(plan.noise, std::sqrt(0.02 / 32 * slope * slope / 2) * 0.8);
  EXPECT_LT(plan.noise, std::sqrt(0.02 / 32 * slope * slope / 2) * 1.2);
}

// Of a variance of 0.5 of a sample, noise is sqrt(0.5 / 32) / (1 + 1 / 4) = 0.1, and of 200 pixels
// 0.5 / sqrt(200) more. Half of it takes 4 times the samples: one doubling now, two in all. The aim
// is 0.99 of the target.
TEST(SamplePlan, HasTheNoiseOfAnEvenPicture) {
  const Film film = even_film(20, 10, noisy(0.5));
  const double noise = 0.1 * (1 + 0.5 / std::sqrt(200));
  EXPECT_NEAR(noise_of(std::vector<double>(200, 0.5 / 32)), noise, 1e-12);
  const SamplePlan plan = plan_samples(film, 100, {noise / 2, 16, 4096});
  EXPECT_NEAR(plan.noise, noise, 1e-9);
  const auto more = more_of(plan);
  EXPECT_EQ(more.size(), 200u);
  ASSERT_EQ(plan.samples.size(), 1u);
  EXPECT_EQ(plan.samples[0].count, 8u);
  for (const auto& [pixel, samples] : more) EXPECT_EQ(samples, 32u);
  for (std::size_t i = 0; i < plan.samples[0].pixels.size(); ++i)
    EXPECT_EQ(plan.samples[0].pixels[i].sample_begin, 132u + 8 * (i % 4));
  const double left = 200 * (128 / (0.99 * 0.99) - 32);
  EXPECT_NEAR(plan.paths_left, left, left * 2e-3);
  EXPECT_TRUE(plan_samples(film, 100, {1.001 * noise, 16, 4096}).empty());
  EXPECT_TRUE(plan_samples(film, 100, {0.05, 16, 32}).empty()) << "they have the most";
}

TEST(SamplePlan, StaysWithinLeastAndMost) {
  const Film film = even_film(8, 8, noisy(0.5));
  EXPECT_EQ(plan_samples(film, 0, {0.05, 16, 45}).samples.at(0).count, 13u);
  EXPECT_EQ(plan_samples(film, 0, {0.5, 100, 4096}).samples.at(0).count, 68u);
  // With noise 0 all get the most at once, whatever they vary.
  EXPECT_EQ(plan_samples(even_film(8, 8, noisy(0)), 0, {0, 32, 4096}).samples.at(0).count, 4064u);
  EXPECT_TRUE(plan_samples(even_film(8, 8, noisy(0)), 0, {0.01, 16, 4096}).empty());
}

// Two halves, of standard deviations 1 and 3 of a sample and one luminance: the least samples for a
// noise are in this proportion. Far from their border, 12 to 36 of 32 that they all have: the first
// half gets none.
TEST(SamplePlan, SamplesAreInProportionToTheDeviation) {
  std::vector<Pixel> pixels;
  for (int i = 0; i < 40 * 10; ++i) pixels.push_back(noisy(i % 40 < 20 ? 1 : 9));
  const Film film = film_of(40, 10, pixels);
  const auto halves = [](double one, double other) {
    std::vector<double> out(200, one);
    out.resize(400, other);
    return noise_of(out);
  };
  EXPECT_NEAR(plan_samples(film, 0, {1e-4, 16, 1u << 30}).noise, halves(1.0 / usual, 9.0 / usual),
              1e-9);
  // 1 / n1 + 9 / n2 = 2 unit noise^2, n2 = 3 n1: with n1 = 46, n2 = 138; 14 more are rounded to 16.
  // As far above what is asked for as the film's standard error puts it.
  const double above = halves(1.0 / usual, 9.0 / usual) / std::sqrt(5 / 1.5625 / usual),
               noise = above * std::sqrt((1.0 / 46 + 9.0 / 138) / 2 / 1.5625);
  const SamplePlan plan = plan_samples(film, 0, {noise, 16, 4096});
  auto more = more_of(plan);
  for (uint y = 0; y < 10; ++y)
    for (uint x = 0; x < 40; ++x) {
      if (x >= 17 && x < 23) continue;  // they see both
      EXPECT_EQ((more[{x, y}]), x < 20 ? 16u : 32u) << x << " " << y;
    }
}

// A pixel alone that varies: its neighbours get samples, and it does not.
TEST(SamplePlan, NeighboursDecide) {
  std::vector<Pixel> pixels(15 * 15, noisy(0));
  pixels[7 * 15 + 7] = noisy(4);
  const auto more = more_of(plan_samples(film_of(15, 15, pixels), 0, {1e-4, 16, 4096}));
  EXPECT_EQ(more.size(), 48u);
  for (const auto& [place, count] : more) {
    EXPECT_NE(place, (std::pair<uint, uint>{7, 7}));
    EXPECT_LE(std::abs(static_cast<int>(place.first) - 7), 3);
    EXPECT_LE(std::abs(static_cast<int>(place.second) - 7), 3);
    EXPECT_EQ(count, 32u);
  }
}

// What a pixel got does not change its own number: two pixels far from each other exchange what
// they have, so that the picture's mean and noise stay as they are.
TEST(SamplePlan, ItsOwnSamplesDoNotDecide) {
  constexpr int width = 30;
  for (const double variance : {0.0, 3.0, 40.0}) {
    std::vector<Pixel> pixels;
    for (int i = 0; i < width * width; ++i) pixels.push_back(noisy(0.1 * (i * 7 % 13)));
    const std::size_t here = 7 * width + 7, far = 22 * width + 22;
    pixels[here] = noisy(variance);
    const NoiseTarget target{0.1, 16, 4096};
    auto before = more_of(plan_samples(film_of(width, width, pixels), 0, target));
    std::swap(pixels[here], pixels[far]);
    auto after = more_of(plan_samples(film_of(width, width, pixels), 0, target));
    EXPECT_EQ((after[{7, 7}]), (before[{7, 7}])) << variance;
    EXPECT_EQ((after[{22, 22}]), (before[{22, 22}])) << variance;
    EXPECT_TRUE(variance < 10 || after != before) << "their neighbours'";
  }
}

// Empty pixels and constant ones count neither as pixels nor as neighbours; a sky that varies does.
TEST(SamplePlan, SkiesWithoutNoiseTakeNoPart) {
  std::vector<Pixel> pixels(20 * 10, Pixel{5, 0, usual, 0});
  for (std::size_t i = 0; i < pixels.size(); ++i)
    if (i % 20 < 10) pixels[i] = noisy(0.5);
  const SamplePlan plan = plan_samples(film_of(20, 10, pixels), 0, {0.08, 16, 4096});
  const double noise = noise_of(std::vector<double>(100, 0.5 / 32));
  EXPECT_NEAR(plan.noise, noise, 1e-9);
  for (const auto& [place, count] : more_of(plan)) EXPECT_LT(place.first, 13u);
  for (Pixel& pixel : pixels) pixel.coverage = 0;
  EXPECT_NEAR(plan_samples(film_of(20, 10, pixels), 0, {0.08, 16, 4096}).noise, noise, 1e-9);
}

// A pixel with few samples says as much about the variance of a sample as one with many.
TEST(SamplePlan, PixelsWithOtherNumbersOfSamplesSayTheSame) {
  std::vector<Pixel> pixels;
  for (int i = 0; i < 14 * 14; ++i) {
    Pixel pixel = noisy(2);
    if (i % 2 == 1) {
      pixel.samples = 512;
      pixel.d = std::sqrt(2.0 / 512);
    }
    pixels.push_back(pixel);
  }
  std::vector<double> variances(98, 2.0 / 32);
  variances.resize(196, 2.0 / 512);
  const double noise = noise_of(variances),
               above = noise / (std::sqrt((2.0 / 32 + 2.0 / 512) / 2) / 1.25);
  const SamplePlan plan = plan_samples(film_of(14, 14, pixels), 0, {0.1 * above, 16, 1u << 20});
  EXPECT_NEAR(plan.noise, noise, 1e-9);
  // 2 / n / 1.5625 = 0.02 - 2 / 512 / 1.5625: n = 73, which is 41 more, rounded to 48; at most 32.
  for (const auto& [place, count] : more_of(plan)) EXPECT_EQ(count, 32u);
  EXPECT_NEAR(plan.paths_left, 98 * 41.0, 98 * 2.0);
}

// Fewer lists make larger batches: records are of 8, 32, 128 ... samples, at most 6 a pixel, and
// pixels have 8, 16, 24, 32, 48, ...
TEST(SamplePlan, CountsAreFew) {
  std::vector<Pixel> pixels;
  for (int i = 0; i < 40 * 40; ++i) {
    pixels.push_back(noisy(0.001 * i));
    pixels.back().samples = 1024;
    pixels.back().d *= std::sqrt(32.0 / 1024);
  }
  const SamplePlan plan = plan_samples(film_of(40, 40, pixels), 0, {0.018, 16, 1u << 20});
  std::vector<std::uint32_t> records;
  for (const PixelSamples& each : plan.samples) records.push_back(each.count);
  EXPECT_THAT(records, ElementsAre(8, 32, 128, 512));
  std::set<std::uint32_t> counts;
  for (const auto& [pixel, count] : more_of(plan)) {
    counts.insert(count);
    const std::uint32_t odd = count / (count & -count);
    EXPECT_TRUE(count >= 8 && count <= 1024 && (odd == 1 || odd == 3)) << count;
    EXPECT_EQ(count % 8, 0u);
  }
  EXPECT_GT(counts.size(), 9u);
  for (const PixelSamples& each : plan.samples)
    for (std::size_t i = 6; i < each.pixels.size(); ++i)
      EXPECT_FALSE(is_same_pixel(each.pixels[i - 6], each.pixels[i]));
}

TEST(SamplePlan, TilesFollowEachOther) {
  const SamplePlan plan = plan_samples(even_film(20, 10, noisy(1)), 0, {0.01, 16, 4096});
  const std::vector<PixelRecord>& pixels = plan.samples.at(0).pixels;
  ASSERT_EQ(pixels.size(), 800u);  // 4 times 8 samples each
  for (std::size_t i = 0; i < 256; ++i) {
    EXPECT_EQ(pixels[i].x, 2 + i / 4 % 8);
    EXPECT_EQ(pixels[i].y, 3 + i / 32);
  }
  EXPECT_EQ(pixels[256].x, 10u);
  EXPECT_EQ(pixels[640].y, 3u + 8);
}

TEST(SamplePlan, IsThatOfRowsSeenOneByOne) {
  std::vector<Pixel> pixels;
  for (int i = 0; i < 40 * 10; ++i) pixels.push_back(noisy(0.1 * (i * 7 % 13)));
  pixels[123].samples = 96;
  const Film film = film_of(40, 10, pixels);
  SampledPixels sampled(film.layout());
  EXPECT_EQ(sampled.mean_samples(), 0);
  for (const auto& [first, count] : {std::pair{7, 3}, {0, 4}, {4, 3}})
    sampled.look_at(film.rows(first, count));
  EXPECT_EQ(sampled.mean_samples(), film.mean_samples());
  const SamplePlan by_rows = plan_samples(sampled, 5, {0.03, 16, 4096}),
                   whole = plan_samples(film, 5, {0.03, 16, 4096});
  EXPECT_EQ(by_rows.noise, whole.noise);
  EXPECT_EQ(more_of(by_rows), more_of(whole));
  EXPECT_GT(more_of(whole).size(), 100u);
}

TEST(SamplePlan, IsTakenInPieces) {
  std::vector<Pixel> pixels;
  for (int i = 0; i < 40 * 10; ++i) pixels.push_back(noisy(i % 40 < 20 ? 1 : 9));
  SamplePlan plan = plan_samples(film_of(40, 10, pixels), 0, {0.05, 16, 45});
  const auto whole = more_of(plan);
  const double paths = plan.paths, left = plan.paths_left;
  std::map<std::pair<uint, uint>, std::uint32_t> taken;
  std::size_t pieces = 0;
  for (; !plan.empty(); ++pieces) {
    double now = 0;
    std::set<std::pair<uint, uint>> of_piece;
    for (const PixelSamples& each : plan.take(1000))
      for (const PixelRecord& pixel : each.pixels) {
        const std::pair<uint, uint> place{pixel.x - 2, pixel.y - 3};
        EXPECT_EQ(of_piece.insert(place).second, !taken.contains(place)) << "in two pieces";
        taken[place] += each.count;
        now += each.count;
      }
    EXPECT_GT(now, 0);
    EXPECT_LE(now, 1000 + 45) << "and a pixel";
  }
  EXPECT_EQ(taken, whole);
  EXPECT_EQ(plan.paths, 0);
  EXPECT_NEAR(plan.paths_left, left - paths, 1e-6);
  EXPECT_NEAR(static_cast<double>(pieces), paths / 1000, 2);
  // One pixel at least, so that something is done.
  SamplePlan other = plan_samples(even_film(8, 8, noisy(1)), 0, {0.01, 16, 4096});
  EXPECT_EQ(other.take(0).at(0).pixels.size(), 4u);
}

TEST(FilmCounts, AreEvenOrHaveAMean) {
  Film film = even_film(4, 3, noisy(1));
  EXPECT_TRUE(film.is_even());
  EXPECT_EQ(film.mean_samples(), 32);
  film.words()[7 * film.layout().words_per_pixel()] += 12;
  EXPECT_FALSE(film.is_even());
  EXPECT_EQ(film.mean_samples(), 33);
}

}  // namespace
}  // namespace caplet::test::sample_plan_test
