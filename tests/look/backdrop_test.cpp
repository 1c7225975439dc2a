// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What lies behind a picture, by hand.
#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "film/image.h"
#include "film/preview.h"
#include "film/under.h"
#include "support/data.h"

namespace caplet {
namespace {

LayeredImage pixels(const std::vector<std::array<float, 4>>& rgba, const Backdrop& backdrop) {
  LayeredImage image;
  image.width = image.data_width = static_cast<int>(rgba.size());
  image.height = image.data_height = 1;
  image.backdrop = backdrop;
  for (std::size_t c = 0; c < 4; ++c) {
    Channel channel{std::string(1, "RGBA"[c]), {}, {}};
    for (const auto& pixel : rgba) channel.floats.push_back(pixel[c]);
    image.channels.push_back(channel);
  }
  return image;
}

using Bytes = std::vector<std::uint8_t>;

TEST(Backdrop, WhiteIs255AndShapesAreToneMappedAlone) {
  const Backdrop white{Backdrop::Kind::color, glm::dvec3(1), nullptr};
  // Nothing; a grey of 0.18 all over; the same over half of the pixel; light of 4 over half of it.
  const LayeredImage image = pixels({{1, 1, 1, 0},
                                     {0.18f, 0.18f, 0.18f, 1},
                                     {0.59f, 0.59f, 0.59f, 0.5f},
                                     {2.5f, 2.5f, 2.5f, 0.5f}},
                                    white);
  const Shown seen = shown(image);
  EXPECT_FALSE(seen.has_alpha());
  EXPECT_FLOAT_EQ(seen.rgb[2][0], 0.59f);
  EXPECT_NEAR(seen.rgb[3][1], 0.5f * tone_map({4, 4, 4})[1] + 0.5f, 1e-6);
  const Bytes bytes = bytes_of(seen);
  ASSERT_EQ(bytes.size(), 12U);
  EXPECT_EQ(Bytes(bytes.begin(), bytes.begin() + 3), Bytes(3, 255));
  EXPECT_EQ(bytes[3], 118);  // 0.18, as in preview_test
  EXPECT_EQ(bytes[6], 202);  // 1.055 * 0.59^(1/2.4) - 0.055 = 0.79179, times 255: 201.91
}

TEST(Backdrop, TransparencyIsAlphaAndColoursAreNotMultipliedByIt) {
  const LayeredImage image =
      pixels({{0, 0, 0, 0}, {0.09f, 0.09f, 0.09f, 0.5f}, {0.18f, 0.18f, 0.18f, 1}}, Backdrop{});
  const Bytes bytes = bytes_of(shown(image));
  EXPECT_EQ(bytes, (Bytes{0, 0, 0, 0, 118, 118, 118, 128, 118, 118, 118, 255}));
  // Over black, 0.09: 1.055 * 0.09^(1/2.4) - 0.055 = 0.3318, times 255: 84.6.
  EXPECT_EQ(preview_rgb8(image)[3], 85);
}

TEST(Backdrop, PicturesCoverTheFilm) {
  auto picture = std::make_shared<EnvironmentImage>();
  picture->width = 8;
  picture->height = 2;
  for (int i = 0; i < 16; ++i)
    for (int c = 0; c < 3; ++c)
      picture->rgb.push_back(c == 2 ? static_cast<float>(i / 8) : static_cast<float>(i % 8) / 8);
  const Backdrop backdrop{Backdrop::Kind::image, {}, picture};
  // A film of 4 x 2: columns 2 to 5 of the picture, texel by texel.
  for (int x = 0; x < 4; ++x)
    EXPECT_FLOAT_EQ(under(backdrop, 4, 2, x, 1)[0], static_cast<float>(x + 2) / 8);
  for (int y = 0; y < 2; ++y)
    EXPECT_FLOAT_EQ(under(backdrop, 4, 2, 1, y)[2], static_cast<float>(y));
  // On a film of 2 x 1 each pixel is the mean of 2 x 2 texels of those.
  EXPECT_NEAR(under(backdrop, 2, 1, 0, 0)[1], (2.5 / 8), 1e-6);
  EXPECT_NEAR(under(backdrop, 2, 1, 1, 0)[1], (4.5 / 8), 1e-6);
}

// A picture and a film that both lie on their side show the same: of a tall picture rows are left
// out above and below.
TEST(Backdrop, PicturesCoverTheFilmTheSameWayUpright) {
  const auto picture_of = [](int width, int height, bool is_turned) {
    auto picture = std::make_shared<EnvironmentImage>();
    picture->width = width;
    picture->height = height;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (int c = 0; c < 3; ++c)
          picture->rgb.push_back(
              static_cast<float>((is_turned ? 37 * y + 101 * x : 37 * x + 101 * y) * (c + 3) % 97) /
              97);
    return Backdrop{Backdrop::Kind::image, {}, picture};
  };
  // Sizes of pictures and films: cut on either side, larger and smaller than the film.
  for (const auto& [wide, tall, across, down] : {std::array{8, 2, 4, 2},
                                                 {9, 4, 5, 3},
                                                 {3, 7, 20, 4},
                                                 {16, 40, 3, 4},
                                                 {5, 6, 5, 6},
                                                 {4, 9, 6, 1}}) {
    const Backdrop lying = picture_of(wide, tall, false), upright = picture_of(tall, wide, true);
    for (int y = 0; y < down; ++y)
      for (int x = 0; x < across; ++x) {
        const auto a = under(lying, across, down, x, y), b = under(upright, down, across, y, x);
        for (std::size_t c = 0; c < 3; ++c)
          EXPECT_NEAR(a[c], b[c], 1e-6) << wide << " " << tall << ", " << x << " " << y;
      }
  }
  // By hand: of 2 x 8 texels on a film of 2 x 4, rows 2 to 5.
  auto tall = std::make_shared<EnvironmentImage>();
  tall->width = 2;
  tall->height = 8;
  for (int i = 0; i < 16; ++i) tall->rgb.insert(tall->rgb.end(), 3, static_cast<float>(i / 2) / 8);
  const Backdrop backdrop{Backdrop::Kind::image, {}, tall};
  for (int y = 0; y < 4; ++y)
    EXPECT_FLOAT_EQ(under(backdrop, 2, 4, 1, y)[0], static_cast<float>(y + 2) / 8);
  // A pixel is the mean of the texels that it covers.
  const Backdrop many = picture_of(12, 8, false);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) {
      double mean = 0;
      for (int i = 0; i < 16; ++i)
        mean +=
            double{many.image
                       ->rgb[3 * static_cast<std::size_t>(12 * (4 * y + i / 4) + 4 * x + i % 4)]} /
            16;
      EXPECT_NEAR(under(many, 3, 2, x, y)[0], mean, 1e-6);
    }
}

// A crop shows what the whole picture shows there, over a picture behind it too.
TEST(Backdrop, ACropIsPartOfTheWhole) {
  auto behind = std::make_shared<EnvironmentImage>();
  behind->width = 12;
  behind->height = 8;
  for (int i = 0; i < 3 * 96; ++i) behind->rgb.push_back(static_cast<float>(i * 29 % 83) / 83);
  LayeredImage whole;
  whole.width = whole.data_width = 12;
  whole.height = whole.data_height = 8;
  whole.backdrop = Backdrop{Backdrop::Kind::image, {}, behind};
  for (std::size_t c = 0; c < 4; ++c) {
    Channel channel{std::string(1, "RGBA"[c]), {}, {}};
    for (int i = 0; i < 96; ++i)
      channel.floats.push_back(c == 3 ? static_cast<float>(i % 5) / 4 : 1);
    whole.channels.push_back(channel);
  }
  const Shown all = shown(whole);
  for (const auto& [x0, y0, wide, tall] :
       {std::array{0, 0, 12, 8}, {3, 2, 5, 4}, {7, 0, 5, 8}, {0, 5, 12, 3}, {11, 7, 1, 1}}) {
    LayeredImage crop = whole;
    crop.x = x0;
    crop.y = y0;
    crop.data_width = wide;
    crop.data_height = tall;
    for (std::size_t c = 0; c < 4; ++c) {
      crop.channels[c].floats.clear();
      for (int y = y0; y < y0 + tall; ++y)
        for (int x = x0; x < x0 + wide; ++x)
          crop.channels[c].floats.push_back(
              whole.channels[c].floats[static_cast<std::size_t>(12 * y + x)]);
    }
    const Shown part = shown(crop);
    ASSERT_EQ(part.rgb.size(), static_cast<std::size_t>(wide * tall));
    for (int y = 0; y < tall; ++y)
      for (int x = 0; x < wide; ++x)
        EXPECT_EQ(part.rgb[static_cast<std::size_t>(wide * y + x)],
                  all.rgb[static_cast<std::size_t>(12 * (y0 + y) + x0 + x)])
            << x0 + x << " " << y0 + y;
  }
}

#ifdef CAPLET_WITH_OIIO

TEST(Backdrop, FilesKeepAlpha) {
  const auto folder = test::temporary_folder();
  const LayeredImage image =
      pixels({{0, 0, 0, 0}, {0.09f, 0.09f, 0.09f, 0.5f}, {0.18f, 0.18f, 0.18f, 1}}, Backdrop{});
  for (const char* name : {"a.png", "a.tif"}) {
    EXPECT_NO_THROW(check_preview_alpha(folder / name, "--preview"));
    write_preview(folder / name, image);
    const TextureImage back = FileImageReader().read_texture(folder / name, {});
    ASSERT_EQ(back.channels, 4) << name;
    EXPECT_EQ(back.bytes, (Bytes{0, 0, 0, 0, 118, 118, 118, 128, 118, 118, 118, 255})) << name;
  }
  EXPECT_THROW(check_preview_alpha(folder / "a.jpg", "--preview"), InputError);
}

#endif

}  // namespace
}  // namespace caplet
