// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pages of a viewer, as a test speaks for them.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "scene/scene.h"
#include "view/viewer.h"

namespace caplet::test {

inline constexpr int width = 96, height = 64;

struct Place {
  explicit Place(const std::string& address)
      : authority(address.substr(7, address.find('/', 7) - 7)),
        path(address.substr(address.find('/', 7))) {}
  boost::asio::ip::tcp::endpoint endpoint() const {
    return {boost::asio::ip::make_address("127.0.0.1"),
            static_cast<std::uint16_t>(std::stoi(authority.substr(authority.find(':') + 1)))};
  }
  std::string authority, path;
};

/// A picture's first words (docs/viewer.md).
struct Shown {
  std::uint32_t view = 0, width = 0, scale = 0, samples = 0;
  bool is_denoised = false, is_right = false;
};

class Guest {
 public:
  explicit Guest(const Place& place) : stream_(context_) {
    boost::beast::get_lowest_layer(stream_).connect(place.endpoint());
    stream_.set_option(boost::beast::websocket::stream_base::decorator(
        [&](boost::beast::websocket::request_type& request) {
          request.set(boost::beast::http::field::origin, "http://" + place.authority);
        }));
    stream_.read_message_max(0);
    stream_.handshake(place.authority, place.path + "socket");
  }
  void say(const nlohmann::json& message) { stream_.write(boost::asio::buffer(message.dump())); }
  void look(const Scene& scene, double by = 0, double separation = 0) {
    nlohmann::json rows = nlohmann::json::array();
    glm::dmat4 at = scene.view.camera.world_from_camera;
    at[3].x += by;
    for (int i = 0; i < 16; ++i) rows.push_back(at[i % 4][i / 4]);
    say({{"type", "look"},
         {"width", width},
         {"height", height},
         {"world_from_camera", rows},
         {"fov", fov_of(scene.view.camera)},
         {"lens_radius", scene.view.camera.lens_radius},
         {"focal_distance", scene.view.camera.focal_distance},
         {"separation", separation}});
  }
  /// The next message that is text of that type; or, for "", bytes that are no picture.
  std::string until(const std::string& type) {
    for (;;) {
      std::string got = next();
      if (type.empty() ? !stream_.got_text() && got.compare(0, 4, "CPLF") != 0
                       : stream_.got_text() && nlohmann::json::parse(got).value("type", "") == type)
        return got;
    }
  }
  /// The first picture in full, of so many samples, of a view after `after`; denoised or not, if
  /// that matters.
  Shown until_samples(std::uint32_t samples, std::uint32_t after = 0,
                      std::optional<bool> is_denoised = {}) {
    for (;;) {
      const std::string got = next();
      if (stream_.got_text() || got.compare(0, 4, "CPLF") != 0) continue;
      std::uint32_t words[10];
      std::memcpy(words, got.data(), sizeof words);
      const bool has_less = (words[7] & 8) != 0;
      if (words[4] == 1 && words[5] >= samples && words[2] == width && words[1] > after &&
          is_denoised.value_or(has_less) == has_less)
        return {words[1], words[2], words[4], words[5], has_less, (words[7] & 4) != 0};
    }
  }
  boost::beast::websocket::stream<boost::beast::tcp_stream>& stream() { return stream_; }
  boost::asio::ip::tcp::socket& raw() { return boost::beast::get_lowest_layer(stream_).socket(); }

 private:
  std::string next() {
    boost::beast::flat_buffer buffer;
    stream_.read(buffer);
    return boost::beast::buffers_to_string(buffer.data());
  }
  boost::asio::io_context context_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
};

inline view::ViewerOptions options_of(int samples) {
  view::ViewerOptions out;
  out.server.token = view::random_token();
  out.samples = samples;
  return out;
}

}  // namespace caplet::test
