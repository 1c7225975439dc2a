// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Media beside pictures of pbrt-v4, of 1,024 samples a pixel and more (the shared data's
// reference/pbrt). With 64 of ours the allowances grow by our noise, of three standard errors of
// the mean and of blocks' noise and a half.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render_scene.h"
#include "support/compare.h"
#include "support/data.h"

namespace caplet::test {
namespace {

class MediaPictures : public testing::TestWithParam<const char*> {};

// Smoke that scatters, and fire whose light is scaled by a grid.
TEST_P(MediaPictures, AreThoseOfPbrt) {
  CAPLET_NEEDS_DATA();
  const auto folder = data_folder() / "reference" / "pbrt";
  const std::string name = GetParam();
  const Picture ours = picture_of(render_file(folder / (name + ".pbrt"), 64).image);
  const Picture theirs = picture_of(read_exr(folder / (name + ".exr")));
  const Figures figures = compare(ours, theirs);
  double sum = 0, variance = 0, blocks = 0;
  for (std::size_t i = 0; i < ours.rgb.size(); ++i)
    sum += theirs.rgb[i], variance += ours.variance[i];
  const double mean = sum / static_cast<double>(ours.rgb.size());
  for (std::size_t i = 0; i < ours.rgb.size(); ++i)
    blocks += ours.variance[i] / 64 / std::pow(std::max<double>(theirs.rgb[i], 0.02 * mean), 2);
  // Channels share their paths: the errors of R, G and B add linearly.
  EXPECT_LT(std::abs(figures.mean), 0.003 + 3 * std::sqrt(3 * variance) / sum);
  EXPECT_LT(figures.blocks,
            std::hypot(0.01, 1.5 * std::sqrt(blocks / static_cast<double>(ours.rgb.size()))));
  EXPECT_LT(std::abs(figures.z_mean), 0.3);
  EXPECT_LT(figures.beyond_3, 0.03);
  EXPECT_GT(figures.pixels, ours.rgb.size() / 3 / 2);
}

INSTANTIATE_TEST_SUITE_P(Pbrt, MediaPictures, testing::Values("grid"));

}  // namespace
}  // namespace caplet::test
