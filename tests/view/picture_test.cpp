// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/picture.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>
#include <cmath>
#include <cstring>

namespace caplet::view {
namespace {

/// What a client has, by docs/viewer.md.
struct Shown {
  int width = 0, height = 0;
  std::vector<std::uint16_t> color, alpha;
  std::vector<std::uint32_t> objects, primitives;
  std::size_t tiles = 0;
};

std::uint32_t word(const std::string& data, std::size_t number) {
  std::uint32_t out = 0;
  std::memcpy(&out, data.data() + 4 * number, 4);
  return out;
}

void take(Shown& shown, const std::string& message) {
  ASSERT_EQ(word(message, 0), 0x464c5043u);
  const int width = static_cast<int>(word(message, 2)), height = static_cast<int>(word(message, 3));
  const std::uint32_t flags = word(message, 7), tiles = word(message, 8);
  std::string data(word(message, 9), '\0');
  uLongf size = data.size();
  ASSERT_EQ(::uncompress(reinterpret_cast<Bytef*>(data.data()), &size,
                         reinterpret_cast<const Bytef*>(message.data()) + 40, message.size() - 40),
            Z_OK);
  ASSERT_EQ(size, data.size());
  if (flags & 1u) {
    shown.width = width;
    shown.height = height;
    shown.color.assign(static_cast<std::size_t>(3 * width * height), 0xffff);
    shown.alpha.assign(flags & 16u ? static_cast<std::size_t>(width * height) : 0, 0xffff);
  }
  shown.tiles = tiles;
  std::vector<std::size_t> pixels;
  const int across = (width + 63) / 64;
  for (std::uint32_t i = 0; i < tiles; ++i) {
    const int x0 = static_cast<int>(word(data, i)) % across * 64,
              y0 = static_cast<int>(word(data, i)) / across * 64;
    for (int y = y0; y < std::min(y0 + 64, height); ++y)
      for (int x = x0; x < std::min(x0 + 64, width); ++x)
        pixels.push_back(static_cast<std::size_t>(y * width + x));
  }
  const auto byte = [&data](std::size_t at) {
    return static_cast<unsigned>(static_cast<unsigned char>(data[at]));
  };
  std::size_t at = 4 * tiles;
  unsigned value = 0;
  const std::size_t words = (flags & 16u ? 4 : 3) * pixels.size();
  for (std::size_t k = 0; k < words; ++k) {
    value = (value + (byte(at + k) << 8 | byte(at + words + k))) & 0xffffu;
    const std::size_t pixel = pixels[k % pixels.size()], channel = k / pixels.size();
    (channel < 3 ? shown.color[3 * pixel + channel] : shown.alpha[pixel]) =
        static_cast<std::uint16_t>(value);
  }
  at += 2 * words;
  if (!(flags & 2u)) {
    EXPECT_EQ(at, data.size());
    return;
  }
  const auto n = static_cast<std::size_t>(width * height);
  for (std::vector<std::uint32_t>* ids : {&shown.objects, &shown.primitives}) {
    ids->clear();
    std::uint32_t id = 0;
    for (std::size_t i = 0; i < n; ++i) {
      id += byte(at + i) << 24 | byte(at + n + i) << 16 | byte(at + 2 * n + i) << 8 |
            byte(at + 3 * n + i);
      ids->push_back(id);
    }
    at += 4 * n;
  }
  EXPECT_EQ(at, data.size());
}

Picture some(int width, int height, std::uint32_t seed) {
  Picture out;
  out.width = width;
  out.height = height;
  out.view = 1;
  for (int i = 0; i < 3 * width * height; ++i)
    out.color.push_back(
        static_cast<std::uint16_t>((seed = seed * 1664525u + 1013904223u) >> 17 & ~7u));
  return out;
}

void add_ids(Picture& picture) {
  for (std::size_t i = 0; i < picture.color.size() / 3; ++i) {
    picture.objects.push_back(i % 7 == 0 ? 0xffffffffu : static_cast<std::uint32_t>(i / 5));
    picture.primitives.push_back(static_cast<std::uint32_t>(i * 2654435761u));
  }
}

TEST(Packed, IsWhatItWas) {
  for (const auto& [width, height] : {std::pair(1, 1), {64, 64}, {65, 63}, {200, 130}}) {
    Picture picture = some(width, height, 7);
    add_ids(picture);
    Shown shown;
    take(shown, packed(picture, nullptr));
    EXPECT_EQ(shown.width, width);
    EXPECT_EQ(shown.height, height);
    EXPECT_EQ(shown.color, picture.color);
    EXPECT_EQ(shown.objects, picture.objects);
    EXPECT_EQ(shown.primitives, picture.primitives);
  }
}

void add_alpha(Picture& picture) {
  for (std::size_t i = 0; i < picture.color.size() / 3; ++i)
    picture.alpha.push_back(to_half(static_cast<float>(i % 5) / 4));
}

TEST(Packed, HasCoverageWhereThereIsSome) {
  const Picture bare = some(200, 130, 7);
  Picture covered = bare;
  add_alpha(covered);
  Shown shown;
  take(shown, packed(bare, nullptr));
  EXPECT_TRUE(shown.alpha.empty());
  take(shown, packed(covered, &bare));
  EXPECT_EQ(shown.tiles, 12u);
  EXPECT_EQ(shown.color, covered.color);
  EXPECT_EQ(shown.alpha, covered.alpha);
  Picture now = covered;
  now.alpha[199] ^= 8u;
  take(shown, packed(now, &covered));
  EXPECT_EQ(shown.tiles, 1u);
  EXPECT_EQ(shown.color, now.color);
  EXPECT_EQ(shown.alpha, now.alpha);
  take(shown, packed(bare, &now));
  EXPECT_EQ(shown.tiles, 12u);
  EXPECT_TRUE(shown.alpha.empty());
}

TEST(Packed, HasTheTilesThatDifferAlone) {
  const Picture before = some(200, 130, 7);
  Picture now = before;
  now.color[3 * (70 * 200 + 199) + 2] ^= 8u;  // the last of four tiles in the second row
  Shown shown;
  take(shown, packed(before, nullptr));
  EXPECT_EQ(shown.tiles, 12u);
  take(shown, packed(now, &before));
  EXPECT_EQ(shown.tiles, 1u);
  EXPECT_EQ(shown.color, now.color);
  take(shown, packed(now, &now));
  EXPECT_EQ(shown.tiles, 0u);
  EXPECT_EQ(shown.color, now.color);
}

TEST(Packed, IsWholeAfterAnotherSizeOrScale) {
  const Picture before = some(200, 130, 7);
  const Picture smaller = some(50, 33, 8);
  Shown shown;
  take(shown, packed(before, nullptr));
  take(shown, packed(smaller, &before));
  EXPECT_EQ(shown.width, 50);
  EXPECT_EQ(shown.color, smaller.color);
  Picture coarse = before;
  coarse.scale = 2;
  take(shown, packed(coarse, &before));
  EXPECT_EQ(shown.tiles, 12u);
}

TEST(Packed, HasIdsOnceAView) {
  Picture picture = some(64, 64, 7);
  const Picture coarse = some(16, 16, 3);
  add_ids(picture);
  Shown shown;
  take(shown, packed(picture, nullptr));
  EXPECT_EQ(shown.objects.size(), 4096u);
  const std::size_t with = packed(picture, nullptr).size(),
                    without = packed(picture, &picture).size();
  EXPECT_LT(without, with / 10);
  Picture next = picture;
  next.view = 2;
  shown.objects.clear();
  take(shown, packed(next, &picture));
  EXPECT_EQ(shown.objects, picture.objects);
  Picture half = picture;
  half.scale = 2;
  half.objects.clear();
  half.primitives.clear();
  shown.objects.clear();
  take(shown, packed(picture, &half));
  EXPECT_EQ(shown.objects, picture.objects);
}

float of_half(std::uint16_t half) {
  const int exponent = half >> 10 & 31;
  const float fraction = static_cast<float>(half & 1023) / 1024;
  return exponent ? std::ldexp(1 + fraction, exponent - 15) : std::ldexp(fraction, -14);
}

TEST(ToHalf, IsWithinAStepOf128) {
  for (float value = 1e-4f; value < 6e4f; value *= 1.0173f)
    EXPECT_NEAR(of_half(to_half(value)), value, value / 256 * 1.0001f) << value;
  EXPECT_EQ(of_half(to_half(1)), 1);
  EXPECT_EQ(of_half(to_half(0.5f)), 0.5f);
}

TEST(ToHalf, OfAllElseIsShown) {
  for (const float none : {0.0f, -1.0f, -INFINITY, NAN, 1e-9f}) EXPECT_EQ(to_half(none), 0) << none;
  for (const float much : {1e6f, 3e38f, INFINITY}) {
    EXPECT_TRUE(std::isfinite(of_half(to_half(much))));
    EXPECT_GT(of_half(to_half(much)), 6e4f);
    EXPECT_LT(to_half(much), 31 << 10);
  }
}

}  // namespace
}  // namespace caplet::view
