// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Images for importers: colour spaces, grey, alpha, transfer functions, broken files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "film/detail/limits.h"
#include "film/image.h"
#include "images.h"
#include "support/data.h"

namespace caplet {
namespace {

using testing::AllOf;
using testing::HasSubstr;

LayeredImage exr_of(const std::vector<std::pair<std::string, std::vector<float>>>& channels,
                    int width, int height) {
  LayeredImage image;
  image.width = image.data_width = width;
  image.height = image.data_height = height;
  for (const auto& [name, values] : channels) image.channels.push_back({name, values, {}});
  return image;
}

EnvironmentImage written_and_read(const LayeredImage& image) {
  const auto path = test::temporary_folder() / "image.exr";
  write_exr(path, image);
  return FileImageReader().read_rgb(path);
}

std::string error_of(const std::filesystem::path& path) {
  try {
    FileImageReader().read_rgb(path);
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
    return error.what();
  }
  return "no error";
}

TEST(ImageReader, InterleavesFromTheTop) {
  const EnvironmentImage image = written_and_read(exr_of(
      {{"R", {1, 2}}, {"G", {3, 4}}, {"B", {5, 6}}, {"A", {.5f, .5f}}, {"Z", {9, 9}}}, 1, 2));
  EXPECT_EQ(image.width, 1);
  EXPECT_EQ(image.height, 2);
  EXPECT_EQ(image.rgb, (std::vector<float>{1, 3, 5, 2, 4, 6}));
}

TEST(ImageReader, TakesLuminanceSingleChannelsAndLayers) {
  EXPECT_EQ(written_and_read(exr_of({{"Y", {2}}, {"Z", {7}}}, 1, 1)).rgb,
            (std::vector<float>{2, 2, 2}));
  EXPECT_EQ(written_and_read(exr_of({{"mask", {3}}}, 1, 1)).rgb, (std::vector<float>{3, 3, 3}));
  EXPECT_EQ(written_and_read(exr_of({{"View.R", {1}}, {"View.G", {2}}, {"View.B", {3}}}, 1, 1)).rgb,
            (std::vector<float>{1, 2, 3}));
  const auto path = test::temporary_folder() / "normals.exr";
  write_exr(path, exr_of({{"N.X", {1}}, {"N.Y", {2}}}, 1, 1));
  EXPECT_THAT(error_of(path), AllOf(HasSubstr("normals.exr"), HasSubstr("R G B")));
}

TEST(ImageReader, KeepsKnownColorSpacesAndConvertsOthers) {
  LayeredImage image = exr_of({{"R", {1}}, {"G", {.5f}}, {"B", {.25f}}}, 1, 1);
  image.space = ColorSpace::rec2020;
  EXPECT_EQ(written_and_read(image).space, ColorSpace::rec2020);
  // Primaries of sRGB with the names of red and green exchanged: a colour space nobody knows, whose
  // conversion is plain.
  image.chromaticities = Chromaticities{{0.30, 0.60}, {0.64, 0.33}, {0.15, 0.06}, {0.3127, 0.3290}};
  const EnvironmentImage converted = written_and_read(image);
  EXPECT_EQ(converted.space, ColorSpace::srgb);
  // Chromaticities are single precision in the file: 2^-24 relative, times the condition of the
  // primaries' matrix (about 10).
  EXPECT_NEAR(converted.rgb[0], 0.5f, 1e-5);
  EXPECT_NEAR(converted.rgb[1], 1.0f, 1e-5);
  EXPECT_NEAR(converted.rgb[2], 0.25f, 1e-5);
}

TEST(ImageReader, RefusesNotFiniteAndClampsNegative) {
  const auto path = test::temporary_folder() / "nan.exr";
  write_exr(
      path,
      exr_of({{"R", {1, std::numeric_limits<float>::quiet_NaN()}}, {"G", {1, 1}}, {"B", {1, 1}}}, 2,
             1));
  EXPECT_THAT(error_of(path),
              AllOf(HasSubstr("nan.exr"), HasSubstr("(1, 0)"), HasSubstr("not finite")));
  EXPECT_EQ(written_and_read(exr_of({{"Y", {-1}}}, 1, 1)).rgb, (std::vector<float>{0, 0, 0}));
}

TEST(ImageLimits, AreCheckedAgainstTheFile) {
  EXPECT_NO_THROW(check_image_size("a", 4096, 4096, 12, 1 << 20));
  EXPECT_THROW(check_image_size("a", 16384, 16384, 12, 1000), InputError);
  EXPECT_NO_THROW(check_image_size("a", 1000, 1000, 12, 0));
  EXPECT_THROW(check_image_size("a", 0, 5, 12, 1 << 20), InputError);
  EXPECT_THROW(check_image_size("a", -1, -1, 12, 1 << 20), InputError);
  EXPECT_THROW(check_image_size("a", 1 << 20, 1 << 20, 12, ~std::uint64_t{0}), InputError);
}

#ifdef CAPLET_WITH_OIIO

TEST(ImageFiles, ConstantHdrEqualsConstantExr) {
  CAPLET_NEEDS_DATA();
  const EnvironmentImage exr =
      FileImageReader().read_rgb(test::data_folder() / "hdr/ignis/constant.exr");
  const EnvironmentImage hdr =
      FileImageReader().read_rgb(test::data_folder() / "hdr/ignis/constant.hdr");
  EXPECT_EQ(hdr.width, 60);
  EXPECT_EQ(hdr.height, 40);
  ASSERT_EQ(exr.rgb.size(), hdr.rgb.size());
  // RGBE has 8 bits of mantissa: half a step of 1/128 at most.
  for (std::size_t i = 0; i < exr.rgb.size(); ++i)
    ASSERT_NEAR(hdr.rgb[i], exr.rgb[i], exr.rgb[i] / 256) << i;
}

TEST(ImageFiles, StudioHdr) {
  CAPLET_NEEDS_DATA();
  const EnvironmentImage image = FileImageReader().read_rgb(test::data_folder() / "hdr/studio.hdr");
  EXPECT_EQ(image.width, 1024);
  EXPECT_EQ(image.height, 512);
  EXPECT_EQ(image.rgb.size(), 1024u * 512u * 3u);
  EXPECT_GT(*std::max_element(image.rgb.begin(), image.rgb.end()), 1.0f);
}

// A PPM is written by hand, byte by byte: header and samples.
TEST(ImageFiles, EightBitFilesAreSrgb) {
  const auto path = test::temporary_folder() / "three.ppm";
  test::write_bytes(
      path, std::string("P6\n3 1\n255\n") + std::string("\x00\xff\x80\x0a\x40\xc0\xff\xff\xff", 9));
  const EnvironmentImage image = FileImageReader().read_rgb(path);
  ASSERT_EQ(image.rgb.size(), 9u);
  // IEC 61966-2-1: 128 -> 0.2158605, 10 -> 10/255/12.92, 64 -> 0.0512695, 192 -> 0.5271151.
  const std::vector<double> expected{0, 1, 0.2158605, 10.0 / 255 / 12.92, 0.0512695, 0.5271151,
                                     1, 1, 1};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(image.rgb[i], expected[i], 1e-6) << i;
}

TEST(ImageFiles, GreyFilesAreGrey) {
  const auto path = test::temporary_folder() / "grey.pgm";
  test::write_bytes(path, std::string("P5\n2 1\n255\n") + std::string("\x80\xff", 2));
  const EnvironmentImage image = FileImageReader().read_rgb(path);
  ASSERT_EQ(image.rgb.size(), 6u);
  EXPECT_NEAR(image.rgb[0], 0.2158605, 1e-6);
  EXPECT_EQ(image.rgb[0], image.rgb[1]);
  EXPECT_EQ(image.rgb[0], image.rgb[2]);
  EXPECT_EQ(image.rgb[5], 1.0f);
}

/// An uncompressed 32-bit TGA: blue, green, red, alpha; 8 alpha bits declared.
std::string tga_of_one_pixel(const std::string& bgra) {
  std::string bytes(18, '\0');
  bytes[2] = 2;
  bytes[12] = bytes[14] = 1;
  bytes[16] = 32;
  bytes[17] = 0x28;
  return bytes + bgra;
}

TEST(ImageFiles, AlphaIsMultipliedIn) {
  const auto path = test::temporary_folder() / "alpha.tga";
  test::write_bytes(path, tga_of_one_pixel("\xff\x80\xff\x80"));
  const EnvironmentImage image = FileImageReader().read_rgb(path);
  ASSERT_EQ(image.rgb.size(), 3u);
  EXPECT_NEAR(image.rgb[0], 128 / 255.0, 1e-6);
  EXPECT_NEAR(image.rgb[1], 0.2158605 * 128 / 255, 1e-6);
  EXPECT_NEAR(image.rgb[2], 128 / 255.0, 1e-6);
}

// As textures take them: bytes as they are, with what they stand for.
TEST(ImageFiles, OfTexturesKeepTheirBytesAndTheirEncoding) {
  const auto path = test::temporary_folder() / "texture.ppm";
  test::write_bytes(path,
                    std::string("P6\n2 1\n255\n") + std::string("\x00\xff\x80\x0a\x40\xc0", 6));
  const TextureImage srgb = FileImageReader().read_texture(path, {});
  EXPECT_EQ(srgb.width, 2);
  EXPECT_EQ(srgb.channels, 3);
  EXPECT_EQ(srgb.bytes, (std::vector<std::uint8_t>{0, 255, 128, 10, 64, 192}));
  EXPECT_NEAR(srgb.decoded[128], 0.2158605, 1e-6);
  EXPECT_EQ(srgb.decoded[255], 1);
  const TextureImage linear =
      FileImageReader().read_texture(path, {ImageEncoding::Kind::linear, 1});
  EXPECT_FLOAT_EQ(linear.decoded[128], 128 / 255.f);
  const TextureImage gamma = FileImageReader().read_texture(path, {ImageEncoding::Kind::gamma, 2});
  EXPECT_NEAR(gamma.decoded[128], 128. * 128 / (255 * 255), 1e-6);
}

TEST(ImageFiles, OfTexturesHaveFloatsOfSixteenBits) {
  const auto path = test::temporary_folder() / "deep.pgm";
  test::write_bytes(path, std::string("P5\n2 1\n65535\n") + std::string("\x80\x00\xff\xff", 4));
  const TextureImage image = FileImageReader().read_texture(path, {ImageEncoding::Kind::linear, 1});
  EXPECT_EQ(image.channels, 1);
  ASSERT_EQ(image.floats.size(), 2u);
  EXPECT_NEAR(image.floats[0], 32768 / 65535.0, 2e-5);
  EXPECT_NEAR(image.floats[1], 1, 2e-5);
  // IEC 61966-2-1 at 0.5000076.
  EXPECT_NEAR(FileImageReader().read_texture(path, {}).floats[0], 0.2140482, 2e-5);
}

TEST(ImageFiles, OfTexturesKeepAlphaThatIsNotOne) {
  const auto path = test::temporary_folder() / "leaf.tga";
  test::write_bytes(path, tga_of_one_pixel("\xff\x80\x40\x20"));
  const TextureImage leaf = FileImageReader().read_texture(path, {});
  EXPECT_EQ(leaf.channels, 4);
  EXPECT_EQ(leaf.bytes, (std::vector<std::uint8_t>{0x40, 0x80, 0xff, 0x20}));
  test::write_bytes(path, tga_of_one_pixel("\xff\x80\x40\xff"));
  EXPECT_EQ(FileImageReader().read_texture(path, {}).channels, 3);
}

TEST(ImageFiles, BrokenFilesAreRefusedByName) {
  const auto folder = test::temporary_folder();
  EXPECT_THAT(error_of(folder / "none.png"),
              AllOf(HasSubstr("none.png"), HasSubstr("no such file")));
  for (const char* name :
       {"noise.png", "noise.hdr", "noise.jpg", "noise.tif", "noise.xyz", "noise"}) {
    test::write_bytes(folder / name, std::string(300, '\x5a'));
    EXPECT_THAT(error_of(folder / name), AllOf(HasSubstr(name), HasSubstr("not a readable image")))
        << name;
  }
  test::write_bytes(folder / "huge.hdr",
                    "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16000 +X 16000\n");
  EXPECT_THAT(error_of(folder / "huge.hdr"), HasSubstr("huge.hdr"));
  test::write_bytes(folder / "cut.hdr",
                    "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 64 +X 64\n\x02\x02");
  EXPECT_THAT(error_of(folder / "cut.hdr"), HasSubstr("cut.hdr"));
}

#else

TEST(ImageFiles, NameTheBuildOption) {
  const auto path = test::temporary_folder() / "sky.hdr";
  test::write_bytes(path, "x");
  EXPECT_THAT(error_of(path), AllOf(HasSubstr("sky.hdr"), HasSubstr("CAPLET_WITH_OIIO")));
  EXPECT_FALSE(has_image_io());
}

#endif

}  // namespace
}  // namespace caplet
