// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "display/detail/packets.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

namespace caplet::tev {

namespace {

// These are kinds of packets.
constexpr std::uint8_t create_image = 4, update_image_v3 = 6;
constexpr int tile_side = 128;

/// A packet whose length is filled in at the end.
class Packet {
 public:
  explicit Packet(std::uint8_t kind) {
    whole(std::uint32_t{0});
    whole(kind);
    whole(std::uint8_t{0});  // does not grab the focus
  }
  template <class Whole>
  void whole(Whole value) {
    for (std::size_t i = 0; i < sizeof value; ++i)
      bytes_ += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i));
  }
  void text(const std::string& value) {
    bytes_.append(value.c_str(), std::strlen(value.c_str()) + 1);
  }
  void number(float value) { whole(std::bit_cast<std::uint32_t>(value)); }
  std::string take() {
    const auto length = static_cast<std::uint32_t>(bytes_.size());
    for (std::size_t i = 0; i < 4; ++i) bytes_[i] = static_cast<char>(length >> (8 * i));
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
};

void name_channels(Packet& packet, const LayeredImage& image) {
  for (const Channel& channel : image.channels) packet.text(channel.name);
}

bool same(const Channel& a, const Channel& b, std::size_t at, std::size_t count) {
  const auto equal = [&](const auto& x, const auto& y) {
    return x.empty() || std::memcmp(x.data() + at, y.data() + at, count * sizeof x[0]) == 0;
  };
  return equal(a.floats, b.floats) && equal(a.uints, b.uints);
}

std::size_t index_of(const LayeredImage& image, int x, int y) {
  return static_cast<std::size_t>(y - image.y) * static_cast<std::size_t>(image.data_width) +
         static_cast<std::size_t>(x - image.x);
}

}  // namespace

std::string create_packet(const std::string& name, const LayeredImage& image) {
  Packet packet(create_image);
  packet.text(name);
  packet.whole(image.width);
  packet.whole(image.height);
  packet.whole(static_cast<std::int32_t>(image.channels.size()));
  name_channels(packet, image);
  return packet.take();
}

std::string update_packet(const std::string& name, const LayeredImage& image, const Tile& tile) {
  Packet packet(update_image_v3);
  packet.text(name);
  packet.whole(static_cast<std::int32_t>(image.channels.size()));
  name_channels(packet, image);
  for (const int value : {tile.x, tile.y, tile.width, tile.height}) packet.whole(value);
  const std::int64_t pixels = std::int64_t{tile.width} * tile.height;
  for (std::size_t i = 0; i < image.channels.size(); ++i)
    packet.whole(static_cast<std::int64_t>(i) * pixels);
  for (std::size_t i = 0; i < image.channels.size(); ++i) packet.whole(std::int64_t{1});
  for (const Channel& channel : image.channels)
    for (int y = tile.y; y < tile.y + tile.height; ++y) {
      const std::size_t row = index_of(image, tile.x, y);
      for (std::size_t x = row; x < row + static_cast<std::size_t>(tile.width); ++x)
        packet.number(channel.uints.empty() ? channel.floats[x]
                                            : static_cast<float>(channel.uints[x]));
    }
  return packet.take();
}

std::vector<Tile> changed_tiles(const LayeredImage& before, const LayeredImage& now) {
  std::vector<Tile> out;
  for (int y = now.y; y < now.y + now.data_height; y += tile_side)
    for (int x = now.x; x < now.x + now.data_width; x += tile_side) {
      const Tile tile{x, y, std::min(tile_side, now.x + now.data_width - x),
                      std::min(tile_side, now.y + now.data_height - y)};
      bool is_same = before.channels.size() == now.channels.size();
      for (std::size_t c = 0; c < now.channels.size() && is_same; ++c)
        for (int row = 0; row < tile.height && is_same; ++row)
          is_same = same(before.channels[c], now.channels[c], index_of(now, x, y + row),
                         static_cast<std::size_t>(tile.width));
      if (!is_same) out.push_back(tile);
    }
  return out;
}

}  // namespace caplet::tev
