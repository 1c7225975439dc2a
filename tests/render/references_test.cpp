// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Renders against Mitsuba 3: a faster version of tests/validation. Fewer samples widen our own error: the allowances for means
// grow by three standard errors of the image mean, those of blocks by the expected noise of a block (both from our own variance
// layer).
#include <gtest/gtest.h>

#include <cmath>

#include "reference_scenes.h"
#include "render_scene.h"
#include "support/data.h"

namespace caplet::test {
namespace {

class References : public testing::TestWithParam<ReferenceScene> {};

TEST_P(References, AgreesWithMitsuba) {
  CAPLET_NEEDS_DATA();
  const ReferenceScene& scene = GetParam();
  const auto folder = data_folder() / "reference" / "mitsuba";
  const Rendered ours = render_file(folder / (scene.name + ".pbrt"), 64);
  const Picture a = picture_of(ours.image), b = picture_of(read_exr(folder / (scene.name + ".exr")));
  const Figures figures = compare(a, b);
  double variance_of_sum = 0, block_noise = 0, sum = 0;
  for (std::size_t i = 0; i < a.variance.size(); ++i) {
    variance_of_sum += a.variance[i];
    sum += b.rgb[i];
  }
  const double mean = sum / static_cast<double>(b.rgb.size());
  // Channels share their paths: the errors of R, G and B add linearly.
  const double mean_error = std::sqrt(3 * variance_of_sum) / sum;
  for (std::size_t i = 0; i < a.variance.size(); ++i)
    block_noise += a.variance[i] / 64 / std::pow(std::max<double>(b.rgb[i], 0.02 * mean), 2);
  block_noise = std::sqrt(block_noise / static_cast<double>(a.variance.size()));
  RecordProperty("figures",
                 std::to_string(figures.mean) + " " + std::to_string(figures.blocks) + " " + std::to_string(figures.z_mean));
  EXPECT_LT(std::abs(figures.mean), scene.mean + 3 * mean_error);
  EXPECT_LT(figures.blocks, std::hypot(scene.blocks, 1.5 * block_noise));
  if (!scene.spectral) {
    EXPECT_LT(std::abs(figures.z_mean), allowed_z_mean);
    EXPECT_LT(figures.beyond_3, allowed_beyond_3);
    EXPECT_GT(figures.pixels, a.rgb.size() / 3 / 2);
  }
}

INSTANTIATE_TEST_SUITE_P(Mitsuba, References, testing::ValuesIn(reference_scenes()), [](const auto& parameter) {
  std::string name = parameter.param.name;
  for (char& c : name)
    if (c == '-') c = '_';
  return name;
});

// What is left between the environment scene and Mitsuba's is where the rows of the image stand: Mitsuba spreads them from pole
// to pole, by 512/511. By sums over the rows the disk gets 0.233 % less light as pbrt places them; placed as by Mitsuba the
// pictures agree.
TEST(References, EnvironmentDiffersByThePlaceOfItsRows) {
  CAPLET_NEEDS_DATA();
  const auto folder = data_folder() / "reference" / "mitsuba";
  const Picture theirs = picture_of(read_exr(folder / "environment.exr"));
  const Picture ours = picture_of(render_file(folder / "environment.pbrt", 1024).image);
  const Picture placed = picture_of(render_file(folder / "environment.pbrt", 1024, place_rows_as_mitsuba).image);
  // The floor in front and to the sides, where no capsule stands and little but the sky is seen.
  double sums[3] = {0, 0, 0}, variance = 0;
  for (std::size_t y = 104; y < 120; ++y)
    for (std::size_t i = 3 * (128 * y + 24); i < 3 * (128 * y + 104); ++i) {
      sums[0] += ours.rgb[i];
      sums[1] += placed.rgb[i];
      sums[2] += theirs.rgb[i];
      variance += placed.variance[i];
    }
  // R, G and B share their paths: their errors add linearly. Theirs (some 2e-4 of the mean) is within the last term.
  const double error = std::sqrt(3 * variance) / sums[2];
  RecordProperty("figures", std::to_string(sums[0] / sums[2] - 1) + " " + std::to_string(sums[1] / sums[2] - 1) + " " +
                                std::to_string(error));
  EXPECT_NEAR(sums[1] / sums[2], 1, 4 * error + 3e-4);
  EXPECT_NEAR(sums[0] / sums[1], 1 - 0.00233, 5e-4);
  EXPECT_LT(error, 5e-4);
}

// The comparison itself must be able to fail.
TEST(Compare, SeesABiasOfOnePercent) {
  Picture a{64, 64, std::vector<float>(64 * 64 * 3, 1.01f), std::vector<float>(64 * 64 * 3, 1e-6f)};
  Picture b{64, 64, std::vector<float>(64 * 64 * 3, 1.0f), std::vector<float>(64 * 64 * 3, 1e-6f)};
  const Figures figures = compare(a, b);
  EXPECT_NEAR(figures.mean, 0.01, 1e-6);
  EXPECT_NEAR(figures.blocks, 0.01, 1e-6);
  EXPECT_NEAR(figures.z_mean, 0.01 / std::sqrt(2e-6), 1e-2);
  EXPECT_EQ(figures.beyond_3, 1.0);
}

}  // namespace
}  // namespace caplet::test
