// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace caplet::test {
namespace {

LayeredImage rows_of(const std::vector<float>& g, const std::vector<float>& variance) {
  LayeredImage out;
  out.channels.push_back({"G", g, {}});
  if (!variance.empty()) out.channels.push_back({"variance.G", variance, {}});
  return out;
}

TEST(PictureNoise, IsTheRootOfTheMeanVarianceOverTheMean) {
  PictureNoise noise;
  noise.add(rows_of({1, 2, 3}, {0.01f, 0.02f, 0.03f}));
  noise.add(rows_of({10}, {0.3f}));
  EXPECT_NEAR(noise.relative().value(), std::sqrt(0.09) / 4, 1e-8);  // 0.36 / 4, and 16 / 4
}

TEST(PictureNoise, IsThereForPicturesWithVariances) {
  PictureNoise noise;
  EXPECT_FALSE(noise.relative());
  noise.add(rows_of({1, 2}, {}));
  EXPECT_FALSE(noise.relative());
  noise.add(rows_of({0, 0}, {1, 1}));
  EXPECT_FALSE(noise.relative()) << "of black";
  noise.add(rows_of({4, 0}, {0, 0}));
  EXPECT_NEAR(noise.relative().value(), std::sqrt(0.5), 1e-12);
}

}  // namespace
}  // namespace caplet::test
