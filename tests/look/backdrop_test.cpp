// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What lies behind a picture, by hand.
#include <gtest/gtest.h>

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
  const LayeredImage image =
      pixels({{1, 1, 1, 0}, {0.18f, 0.18f, 0.18f, 1}, {0.59f, 0.59f, 0.59f, 0.5f}, {2.5f, 2.5f, 2.5f, 0.5f}}, white);
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
  const LayeredImage image = pixels({{0, 0, 0, 0}, {0.09f, 0.09f, 0.09f, 0.5f}, {0.18f, 0.18f, 0.18f, 1}}, Backdrop{});
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
    for (int c = 0; c < 3; ++c) picture->rgb.push_back(c == 2 ? static_cast<float>(i / 8) : static_cast<float>(i % 8) / 8);
  const Backdrop backdrop{Backdrop::Kind::image, {}, picture};
  // A film of 4 x 2: columns 2 to 5 of the picture, texel by texel.
  for (int x = 0; x < 4; ++x) EXPECT_FLOAT_EQ(under(backdrop, 4, 2, x, 1)[0], static_cast<float>(x + 2) / 8);
  for (int y = 0; y < 2; ++y) EXPECT_FLOAT_EQ(under(backdrop, 4, 2, 1, y)[2], static_cast<float>(y));
  // Of 2 x 1 each pixel is the mean of 2 x 2 texels of those.
  EXPECT_NEAR(under(backdrop, 2, 1, 0, 0)[1], (2.5 / 8), 1e-6);
  EXPECT_NEAR(under(backdrop, 2, 1, 1, 0)[1], (4.5 / 8), 1e-6);
}

#ifdef CAPLET_WITH_OIIO

TEST(Backdrop, FilesKeepAlpha) {
  const auto folder = test::temporary_folder();
  const LayeredImage image = pixels({{0, 0, 0, 0}, {0.09f, 0.09f, 0.09f, 0.5f}, {0.18f, 0.18f, 0.18f, 1}}, Backdrop{});
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
