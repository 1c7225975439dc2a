// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "display/tev.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "base/error.h"
#include "display/detail/packets.h"
#include "support/tev_server.h"

namespace caplet {
namespace {

using test::TevServer;
using testing::HasSubstr;

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A crop of 300 x 200 in a picture of 400 x 250.
LayeredImage picture(float seed) {
  LayeredImage image;
  image.width = 400;
  image.height = 250;
  image.x = 50;
  image.y = 20;
  image.data_width = 300;
  image.data_height = 200;
  image.channels.resize(3);
  image.channels[0].name = "R";
  image.channels[1].name = "albedo.R";
  image.channels[2].name = "object.id";
  for (std::uint32_t i = 0; i < 300 * 200; ++i) {
    image.channels[0].floats.push_back(seed + static_cast<float>(i));
    image.channels[1].floats.push_back(seed * static_cast<float>(i % 71));
    image.channels[2].uints.push_back(i % 13);
  }
  return image;
}

void expect_shown(const test::TevPicture& shown, const LayeredImage& image) {
  ASSERT_EQ(shown.width, image.width);
  ASSERT_EQ(shown.height, image.height);
  ASSERT_EQ(shown.channels.size(), image.channels.size());
  for (const Channel& channel : image.channels) {
    const std::vector<float>& values = shown.channels.at(channel.name);
    std::size_t wrong = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const bool inside = x >= image.x && x < image.x + image.data_width && y >= image.y &&
                            y < image.y + image.data_height;
        const auto i = static_cast<std::size_t>((y - image.y) * image.data_width + x - image.x);
        const float expected = !inside                 ? 0
                               : channel.uints.empty() ? channel.floats[i]
                                                       : static_cast<float>(channel.uints[i]);
        wrong += values[static_cast<std::size_t>(y * image.width + x)] != expected;
      }
    EXPECT_EQ(wrong, 0u) << channel.name;
  }
}

TEST(Tev, PacketsAreLittleEndianWithTheirLengthFirst) {
  LayeredImage image;
  image.width = 258;
  image.height = 1;
  image.data_width = image.data_height = 1;
  image.channels = {{"R", {1.0f}, {}}};
  // 4 of length, kind 4, no focus, "a", 258, 1, 1 channel, "R"
  EXPECT_EQ(tev::create_packet("a", image),
            std::string("\x16\0\0\0\x04\0a\0\x02\x01\0\0\x01\0\0\0\x01\0\0\0R\0", 22));
  // kind 6, "a", 1 channel, "R", the tile, offset 0, stride 1, 1.0f
  EXPECT_EQ(tev::update_packet("a", image, {0, 0, 1, 1}),
            std::string("\x32\0\0\0\x06\0a\0\x01\0\0\0R\0\0\0\0\0\0\0\0\0\x01\0\0\0\x01\0\0\0\0\0\0"
                        "\0\0\0\0\0\x01\0\0\0\0\0\0\0\0\0\x80\x3f",
                        50));
}

TEST(Tev, OnlyTilesThatChangeAreSent) {
  const LayeredImage before = picture(1);
  LayeredImage now = before;
  EXPECT_EQ(tev::changed_tiles({}, now).size(), 6u);
  EXPECT_EQ(tev::changed_tiles(before, now).size(), 0u);
  now.channels[1].floats[300 * 199 + 299] += 1;
  now.channels[2].uints[0] += 1;
  const std::vector<tev::Tile> tiles = tev::changed_tiles(before, now);
  ASSERT_EQ(tiles.size(), 2u);
  EXPECT_EQ(tiles[0].x, 50);
  EXPECT_EQ(tiles[0].y, 20);
  EXPECT_EQ(tiles[0].width, 128);
  EXPECT_EQ(tiles[1].x, 50 + 256);
  EXPECT_EQ(tiles[1].width, 300 - 256);
  EXPECT_EQ(tiles[1].height, 200 - 128);
}

TEST(Tev, ShowsThePictureAsItNowIs) {
  TevServer server;
  LayeredImage last = picture(2);
  {
    TevDisplay display({"127.0.0.1", server.port()}, "a picture");
    display.show(picture(1));
    display.finish(20);
    EXPECT_TRUE(display.is_idle());
    display.show(last);
    display.finish(20);
    last.channels[0].floats[5] = -1;
    display.show(last);
    display.finish(20);
  }
  server.stop();
  EXPECT_EQ(server.problem(), "");
  ASSERT_EQ(server.pictures().count("a picture"), 1u);
  expect_shown(server.pictures()["a picture"], last);
  EXPECT_EQ(server.pictures()["a picture"].updates, 6 + 6 + 1);
}

TEST(Tev, ThatIsNotThereIsSaidOnce) {
  std::string port;
  {
    const TevServer gone;
    port = gone.port();
  }
  testing::internal::CaptureStderr();
  EXPECT_LT(seconds_of([&] {
              TevDisplay display({"127.0.0.1", port}, "a");
              for (int i = 0; i < 5; ++i) {
                display.show(picture(1));
                display.finish(20);
              }
              EXPECT_FALSE(display.is_idle());
            }),
            10);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_THAT(said, HasSubstr("tev at 127.0.0.1:" + port));
  EXPECT_EQ(said.find("tev at"), said.rfind("tev at"));
}

TEST(Tev, ThatIsSlowStallsNothing) {
  TevServer server(false);
  testing::internal::CaptureStderr();
  LayeredImage large = picture(1);
  large.width = large.data_width = large.height = large.data_height = 2000;
  large.x = large.y = 0;
  for (Channel& channel : large.channels)
    channel = {channel.name, std::vector<float>(4'000'000, 1), {}};
  EXPECT_LT(seconds_of([&] {
              TevDisplay display({"127.0.0.1", server.port()}, "a");
              for (int i = 0; i < 20; ++i) {
                large.channels[0].floats[0] = static_cast<float>(i);
                display.show(large);
              }
              EXPECT_FALSE(display.is_idle());
              display.finish(0.2);
            }),
            20);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("too slow"));
}

TEST(Tev, AddressesAreHostAndPort) {
  const auto both = [](const std::string& text) {
    const TevAddress out = parse_tev_address(text, "--display");
    return out.host + " " + out.port;
  };
  EXPECT_EQ(both("127.0.0.1:14158"), "127.0.0.1 14158");
  EXPECT_EQ(both("14158"), "127.0.0.1 14158");
  EXPECT_EQ(both(":1"), "127.0.0.1 1");
  EXPECT_EQ(both("[::1]:65535"), "::1 65535");
  EXPECT_EQ(both("here:80"), "here 80");
  for (const char* wrong : {"", "here", "here:", "here:0", "here:65536", "here:8x", "here:123456"})
    EXPECT_THROW(parse_tev_address(wrong, "--display"), InputError) << wrong;
}

}  // namespace
}  // namespace caplet
