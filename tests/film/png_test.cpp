// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// PNG files of every kind by our use of libpng, beside OpenImageIO's reader.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <fstream>
#include <random>

#include "base/error.h"
#include "film/detail/image_module.h"
#include "film/detail/image_png.h"
#include "film/image.h"
#include "support/data.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using namespace image_files;

struct Kind {
  int type, depth;
  bool key = false;  // tRNS
  bool interlaced = false;
  double gamma = 0;   // gAMA; 0: none
  bool srgb = false;  // sRGB, which counts for more than gAMA
};

constexpr int width = 13, height = 9;

int channels_of(int type) {
  if (type == PNG_COLOR_TYPE_RGB) return 3;
  if (type == PNG_COLOR_TYPE_RGB_ALPHA) return 4;
  return type == PNG_COLOR_TYPE_GRAY_ALPHA ? 2 : 1;
}

/// Random pixels.
fs::path write(const Kind& kind) {
  const fs::path path = test::temporary_folder() / "kind.png";
  std::FILE* file = std::fopen(path.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, width, height, kind.depth, kind.type,
               kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  std::mt19937 random(7);
  const auto byte = [&] { return static_cast<png_byte>(random() & 255); };
  if (kind.type == PNG_COLOR_TYPE_PALETTE) {
    std::vector<png_color> palette(std::size_t{1} << kind.depth);
    for (png_color& color : palette) color = {byte(), byte(), byte()};
    png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
    const png_byte alphas[] = {0, 100};
    if (kind.key) png_set_tRNS(png, info, alphas, 2, nullptr);
  } else if (kind.key) {
    const png_color_16 key = {0, 3, 3, 3, 1};
    png_set_tRNS(png, info, nullptr, 0, &key);
  }
  if (kind.gamma > 0) png_set_gAMA(png, info, kind.gamma);
  if (kind.srgb) png_set_sRGB(png, info, PNG_sRGB_INTENT_RELATIVE);
  png_write_info(png, info);
  const int bits = width * channels_of(kind.type) * kind.depth;
  std::vector<std::vector<png_byte>> rows(
      height, std::vector<png_byte>(static_cast<std::size_t>((bits + 7) / 8)));
  for (auto& row : rows)
    for (png_byte& value : row) value = byte();
  std::vector<png_bytep> pointers;
  for (auto& row : rows) pointers.push_back(row.data());
  png_write_image(png, pointers.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
  return path;
}

const SizeCheck any_size = [](int, int, std::uint64_t) {};

#ifdef CAPLET_WITH_OIIO
std::string name_of(const Kind& kind) {
  return "type " + std::to_string(kind.type) + " depth " + std::to_string(kind.depth) +
         (kind.key ? " key" : "") + (kind.interlaced ? " interlaced" : "") + " gamma " +
         std::to_string(kind.gamma) + (kind.srgb ? " srgb" : "");
}

std::vector<Kind> kinds() {
  std::vector<Kind> out;
  for (const bool interlaced : {false, true})
    for (const bool key : {false, true}) {
      for (const int depth : {1, 2, 4, 8})
        out.push_back({PNG_COLOR_TYPE_PALETTE, depth, key, interlaced});
      for (const int depth : {1, 2, 4, 8, 16})
        out.push_back({PNG_COLOR_TYPE_GRAY, depth, key, interlaced});
      for (const int depth : {8, 16}) out.push_back({PNG_COLOR_TYPE_RGB, depth, key, interlaced});
      if (key) continue;
      for (const int depth : {8, 16})
        out.push_back({PNG_COLOR_TYPE_GRAY_ALPHA, depth, false, interlaced});
      for (const int depth : {8, 16})
        out.push_back({PNG_COLOR_TYPE_RGB_ALPHA, depth, false, interlaced});
    }
  for (const double gamma : {1 / 2.2, 1.0, 1 / 1.8, 0.3}) {
    out.push_back({PNG_COLOR_TYPE_RGB, 8, false, false, gamma});
    out.push_back({PNG_COLOR_TYPE_RGB_ALPHA, 16, false, false, gamma});
  }
  out.push_back({PNG_COLOR_TYPE_GRAY, 8, false, false, 1 / 2.2, true});
  return out;
}

TEST(Png, IsReadAsOpenImageIoReadsIt) {
  for (const Kind& kind : kinds()) {
    SCOPED_TRACE(name_of(kind));
    const fs::path path = write(kind);
    const Module& module = module_for(path);
    StoredPixels stored, expected;
    ASSERT_EQ(read_png_stored(path, any_size, stored), "");
    ASSERT_EQ(module.read_stored(path, any_size, expected), "");
    EXPECT_EQ(stored.width, width);
    EXPECT_EQ(stored.height, height);
    EXPECT_EQ(stored.channels, expected.channels);
    EXPECT_EQ(stored.alpha, expected.alpha);
    EXPECT_EQ(stored.is_whole, expected.is_whole);
    EXPECT_EQ(stored.bytes, expected.bytes);
    EXPECT_EQ(stored.floats, expected.floats);

    Pixels pixels, linear;
    ASSERT_EQ(read_png_linear(path, any_size, pixels), "");
    ASSERT_EQ(module.read_linear(path, any_size, linear), "");
    EXPECT_EQ(pixels.channels, linear.channels);
    EXPECT_EQ(pixels.alpha, linear.alpha);
    ASSERT_EQ(pixels.values.size(), linear.values.size());
    // One rounding of a whole number's share of 255 or 65,535, which the power of a gamma makes up
    // to three of.
    for (std::size_t i = 0; i < pixels.values.size(); ++i)
      EXPECT_NEAR(pixels.values[i], linear.values[i], 3e-7) << i;
  }
}

TEST(Png, WrittenIsReadByOpenImageIoToTheByte) {
  const fs::path path = test::temporary_folder() / "written.png";
  for (const int channels : {3, 4}) {
    std::vector<std::uint8_t> values(static_cast<std::size_t>(width * height * channels));
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = static_cast<std::uint8_t>(37 * i + i * i / 11);
    std::string bytes;
    ASSERT_EQ(encode_png(width, height, channels, values, bytes), "");
    std::ofstream(path, std::ios::binary) << bytes;
    StoredPixels found;
    ASSERT_EQ(module_for(path).read_stored(path, any_size, found), "");
    EXPECT_EQ(found.width, width);
    EXPECT_EQ(found.channels, channels);
    EXPECT_EQ(found.alpha, channels == 4 ? 3 : -1);
    EXPECT_EQ(found.bytes, values);
  }
}
#endif

// A gamma of 1 / 2.2 in the file means a power of 2.2; without, the sRGB curve; whole numbers in
// 255ths.
TEST(Png, IsLinearisedByWhatItSays) {
  for (const auto& [gamma, exponent] : {std::pair{1 / 2.2, 2.2}, {1.0, 1.0}, {0.0, 0.0}}) {
    const fs::path path = write({PNG_COLOR_TYPE_RGB, 8, false, false, gamma});
    StoredPixels stored;
    Pixels pixels;
    ASSERT_EQ(read_png_stored(path, any_size, stored), "");
    ASSERT_EQ(read_png_linear(path, any_size, pixels), "");
    ASSERT_EQ(stored.bytes.size(), pixels.values.size());
    for (std::size_t i = 0; i < stored.bytes.size(); ++i) {
      const double v = stored.bytes[i] / 255.0;
      const double expected = exponent > 0   ? std::pow(v, exponent)
                              : v <= 0.04045 ? v / 12.92
                                             : std::pow((v + 0.055) / 1.055, 2.4);
      EXPECT_NEAR(pixels.values[i], expected, 3e-7);
    }
  }
}

TEST(Png, BrokenIsRefusedWithItsName) {
  const fs::path path = write({PNG_COLOR_TYPE_RGB, 8});
  std::string bytes;
  {
    std::ifstream file(path, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(file), {});
  }
  for (const std::size_t length :
       {std::size_t{8}, std::size_t{20}, std::size_t{40}, bytes.size() / 2}) {
    std::ofstream(path, std::ios::binary) << bytes.substr(0, length);
    try {
      FileImageReader().read_texture(path, {});
      ADD_FAILURE() << length;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("kind.png"));
    }
  }
  for (std::size_t at = 8; at < bytes.size(); ++at) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 0x41);
    std::ofstream(path, std::ios::binary) << changed;
    try {
      FileImageReader().read_texture(path, {});
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace caplet
