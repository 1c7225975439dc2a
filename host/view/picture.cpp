// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/picture.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/error.h"

namespace caplet::view {

namespace {

constexpr std::uint32_t magic = 0x464c5043;  // "CPLF"
constexpr std::uint32_t flag_whole = 1, flag_ids = 2, flag_right = 4, flag_denoised = 8,
                        flag_alpha = 16;

void put(std::string& out, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<char>(value >> (8 * i) & 0xffu));
}

struct Tile {
  int x0, y0, x1, y1;
};

Tile tile_of(const Picture& picture, int number) {
  const int across = (picture.width - 1) / tile_size + 1;
  const int x = number % across * tile_size, y = number / across * tile_size;
  return {x, y, std::min(x + tile_size, picture.width), std::min(y + tile_size, picture.height)};
}

int tiles_of(const Picture& picture) {
  return ((picture.width - 1) / tile_size + 1) * ((picture.height - 1) / tile_size + 1);
}

bool differ(const Picture& a, const Picture& b, const Tile& tile) {
  for (int y = tile.y0; y < tile.y1; ++y) {
    const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) +
                              static_cast<std::size_t>(tile.x0),
                      count = static_cast<std::size_t>(tile.x1 - tile.x0);
    constexpr std::size_t bytes = sizeof a.color[0];
    if (std::memcmp(&a.color[3 * first], &b.color[3 * first], 3 * count * bytes) != 0) return true;
    if (!a.alpha.empty() && std::memcmp(&a.alpha[first], &b.alpha[first], count * bytes) != 0)
      return true;
  }
  return false;
}

std::string deflated(const std::string& data) {
  uLongf size = ::compressBound(data.size());
  std::string out(size, '\0');
  if (::compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                  reinterpret_cast<const Bytef*>(data.data()), data.size(), 1) != Z_OK)
    throw RunError("a picture could not be packed");
  out.resize(size);
  return out;
}

/// Splits words of `width` bytes into planes, most significant first; each word is stored as its
/// difference to the last.
template <class Word>
void add_planes(std::string& out, const std::vector<Word>& words) {
  const std::size_t first = out.size(), count = words.size();
  out.resize(first + count * sizeof(Word));
  Word before = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto step = static_cast<Word>(words[i] - before);
    before = words[i];
    for (std::size_t plane = 0; plane < sizeof(Word); ++plane)
      out[first + plane * count + i] =
          static_cast<char>(step >> (8 * (sizeof(Word) - 1 - plane)) & 0xff);
  }
}

}  // namespace

std::uint16_t to_half(float value) {
  if (!(value > 0)) return 0;  // no displayed value is below black
  constexpr std::uint32_t bias = (127 - 15) << 10;
  const auto bits = std::bit_cast<std::uint32_t>(std::min(value, 65000.0f));
  const std::uint32_t rounded = bits + (1u << 15);  // rounds to 16 of 32 bits: 7 of the fraction
  const std::uint32_t half = rounded >> 13 & ~7u;
  if (half < bias + (1u << 10)) return 0;  // below the least normal half float
  return static_cast<std::uint16_t>(half - bias);
}

std::string packed(const Picture& now, const Picture* before) {
  const bool same_size = before && before->width == now.width && before->height == now.height &&
                         before->scale == now.scale && before->alpha.size() == now.alpha.size();
  const bool ids =
      !now.objects.empty() && (!before || before->view != now.view || before->scale != 1);
  std::vector<std::uint32_t> tiles;
  for (int i = 0; i < tiles_of(now); ++i)
    if (!same_size || differ(now, *before, tile_of(now, i)))
      tiles.push_back(static_cast<std::uint32_t>(i));
  std::vector<std::uint16_t> color;
  for (std::size_t c = 0; c < (now.alpha.empty() ? 3U : 4U); ++c)
    for (const std::uint32_t number : tiles) {
      const Tile tile = tile_of(now, static_cast<int>(number));
      for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x) {
          const std::size_t pixel =
              static_cast<std::size_t>(y) * static_cast<std::size_t>(now.width) +
              static_cast<std::size_t>(x);
          color.push_back(c < 3 ? now.color[3 * pixel + c] : now.alpha[pixel]);
        }
    }
  std::string data;
  for (const std::uint32_t number : tiles) put(data, number);
  add_planes(data, color);
  if (ids) {
    add_planes(data, now.objects);
    add_planes(data, now.primitives);
  }
  std::string out;
  put(out, magic);
  put(out, now.view);
  put(out, static_cast<std::uint32_t>(now.width));
  put(out, static_cast<std::uint32_t>(now.height));
  put(out, static_cast<std::uint32_t>(now.scale));
  put(out, now.samples);
  put(out, std::bit_cast<std::uint32_t>(now.noise));
  put(out, (same_size ? 0u : flag_whole) | (ids ? flag_ids : 0u) |
               (now.eye == 1 ? flag_right : 0u) | (now.is_denoised ? flag_denoised : 0u) |
               (now.alpha.empty() ? 0u : flag_alpha));
  put(out, static_cast<std::uint32_t>(tiles.size()));
  put(out, static_cast<std::uint32_t>(data.size()));
  return out + deflated(data);
}

}  // namespace caplet::view
