// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace caplet::test {
namespace {

LayeredImage rows_of(int width, const std::vector<float>& g, const std::vector<float>& variance,
                     float coverage = 1) {
  LayeredImage out;
  out.data_width = width;
  out.channels.push_back({"G", g, {}});
  out.channels.push_back({"A", std::vector<float>(g.size(), coverage), {}});
  if (!variance.empty()) out.channels.push_back({"variance.G", variance, {}});
  return out;
}

// 2 x 2 pixels see each other: all are relative to their mean, 4, and a quarter of it.
TEST(PictureNoise, IsTheRootOfTheMeanVarianceOverTheLuminance) {
  PictureNoise noise;
  noise.add(rows_of(2, {1, 2}, {0.01f, 0.02f}));
  noise.add(rows_of(2, {3, 10}, {0.03f, 0.3f}));
  EXPECT_NEAR(noise.relative().value(), std::sqrt(0.09) / 5, 1e-8);
}

// Luminance is that around a pixel, at most 3 away; the floor is that of the picture, 0.25 * 2.5.
TEST(PictureNoise, IsRelativeToTheLuminanceAroundAPixel) {
  PictureNoise noise;
  noise.add(rows_of(8, {1, 1, 1, 1, 4, 4, 4, 4}, {0.5f, 0, 0, 0, 0, 0, 0, 0.5f}));
  EXPECT_NEAR(noise.relative().value(),
              std::sqrt((0.5 / (1.625 * 1.625) + 0.5 / (4.625 * 4.625)) / 8), 1e-8);
  PictureNoise down;
  for (const float y : {1.f, 1.f, 1.f, 1.f, 4.f, 4.f, 4.f, 4.f})
    down.add(rows_of(1, {y}, {0.0625f}));
  double sum = 0;
  for (const double mean : {1.0, 8.0 / 5, 12.0 / 6, 16.0 / 7, 19.0 / 7, 18.0 / 6, 17.0 / 5, 4.0})
    sum += 0.0625 / (mean + 0.625) / (mean + 0.625);
  EXPECT_NEAR(down.relative().value(), std::sqrt(sum / 8), 1e-7);
}

TEST(PictureNoise, IsThereForPicturesWithVariances) {
  PictureNoise noise;
  EXPECT_FALSE(noise.relative());
  noise.add(rows_of(2, {1, 2}, {}));
  EXPECT_FALSE(noise.relative());
  noise.add(rows_of(2, {0, 0}, {1, 1}));
  EXPECT_FALSE(noise.relative()) << "of black";
  noise.add(rows_of(2, {4, 0}, {0, 0}));
  EXPECT_NEAR(noise.relative().value(), std::sqrt(2.0 / 4) / 1.25, 1e-7);
}

// Where nothing is seen and nothing varies, nothing counts.
TEST(PictureNoise, IsThatOfWhatIsSeen) {
  PictureNoise noise;
  noise.add(rows_of(2, {1, 1}, {0.25f, 0.25f}));
  noise.add(rows_of(2, {100, 100}, {0, 0}, 0));
  EXPECT_NEAR(noise.relative().value(), 0.5 / 1.25, 1e-7);
}

}  // namespace
}  // namespace caplet::test
