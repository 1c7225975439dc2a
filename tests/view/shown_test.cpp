// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <gtest/gtest.h>

#include "view/detail/snapshot.h"

namespace caplet::view {
namespace {

LayeredImage image_of(std::vector<float> r, std::vector<float> g, std::vector<float> b) {
  LayeredImage out;
  out.width = out.data_width = static_cast<int>(r.size());
  out.height = out.data_height = 1;
  out.channels = {{"R", std::move(r), {}}, {"G", std::move(g), {}}, {"B", std::move(b), {}}};
  return out;
}

TEST(Shown, IsTheColoursAndIds) {
  LayeredImage image = image_of({1, 0.25f}, {0.5f, 4}, {2, 0});
  image.channels.push_back({"object.id", {}, {3, 9}});
  image.channels.push_back({"primitive.id", {}, {5, 7}});
  const Picture with = shown_of(image, true, false), without = shown_of(image, false, false);
  EXPECT_EQ(with.width, 2);
  EXPECT_EQ(with.height, 1);
  EXPECT_EQ(with.color, (std::vector<std::uint16_t>{to_half(1), to_half(0.5f), to_half(2),
                                                    to_half(0.25f), to_half(4), 0}));
  EXPECT_EQ(with.objects, (std::vector<std::uint32_t>{3, 9}));
  EXPECT_EQ(with.primitives, (std::vector<std::uint32_t>{5, 7}));
  EXPECT_EQ(without.color, with.color);
  EXPECT_TRUE(without.objects.empty());
}

TEST(Shown, HasCoverageFrom0To1WhereThePagePutsSomethingUnder) {
  LayeredImage image = image_of({1, 0.25f, 0}, {0.5f, 4, 0}, {2, 0, 0});
  image.channels.push_back({"A", {1.25f, 0.5f, -0.25f}, {}});
  EXPECT_EQ(shown_of(image, false, true).alpha,
            (std::vector<std::uint16_t>{to_half(1), to_half(0.5f), 0}));
  EXPECT_TRUE(shown_of(image, false, false).alpha.empty());
  EXPECT_FALSE(is_put_under_by_page({}));
  EXPECT_FALSE(is_put_under_by_page(Backdrop{Backdrop::Kind::image, {}, {}}));
  EXPECT_TRUE(is_put_under_by_page(Backdrop{}));
  EXPECT_TRUE(is_put_under_by_page(Backdrop{Backdrop::Kind::color, {1, 1, 1}, {}}));
}

// White is white in every space; the green of BT.2020 is, in sRGB, -0.5876 1.1329 -0.1006 (ITU-R
// BT.2087's matrix, inverted).
TEST(Shown, IsInSrgbWhateverTheFilmsSpace) {
  LayeredImage image = image_of({1, 0}, {1, 1}, {1, 0});
  image.space = ColorSpace::rec2020;
  const Picture shown = shown_of(image, false, false);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(shown.color[c], to_half(1)) << c;
  EXPECT_EQ(shown.color[3], 0);
  EXPECT_EQ(shown.color[4], to_half(1.1329f));
  EXPECT_EQ(shown.color[5], 0);
}

}  // namespace
}  // namespace caplet::view
