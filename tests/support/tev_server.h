// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// In tev's place: takes its packets on a port of this machine and puts the pictures together, as
// tev's README and its reader have them.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace caplet::test {

struct TevPicture {
  std::int32_t width = 0, height = 0;
  std::map<std::string, std::vector<float>> channels;
  int updates = 0;
};

class TevServer {
 public:
  /// `reads`: whether anything is taken from the connections that come.
  explicit TevServer(bool reads = true) : reads_(reads) {
    listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
        ::listen(listener_, 4) != 0)
      throw std::runtime_error("no port");
    socklen_t size = sizeof address;
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = std::to_string(ntohs(address.sin_port));
    thread_ = std::thread([this] { run(); });
  }
  ~TevServer() {
    stop();
    ::close(listener_);
  }
  TevServer(const TevServer&) = delete;
  TevServer& operator=(const TevServer&) = delete;

  const std::string& port() const { return port_; }
  /// Takes what has come to its end, and no more.
  void stop() {
    over_ = true;
    if (thread_.joinable()) thread_.join();
  }
  std::map<std::string, TevPicture> pictures() {
    const std::lock_guard lock(mutex_);
    return pictures_;
  }
  std::string problem() {
    const std::lock_guard lock(mutex_);
    return problem_;
  }

 private:
  /// Integers little-endian, strings up to a zero.
  struct Reader {
    const std::string& bytes;
    std::size_t at = 4;
    template <class Whole>
    Whole whole() {
      if (at + sizeof(Whole) > bytes.size()) throw std::runtime_error("a packet is too short");
      std::uint64_t value = 0;
      for (std::size_t i = 0; i < sizeof(Whole); ++i)
        value |= std::uint64_t{static_cast<unsigned char>(bytes[at++])} << (8 * i);
      return static_cast<Whole>(value);
    }
    float number() {
      const auto bits = whole<std::uint32_t>();
      float value = 0;
      std::memcpy(&value, &bits, 4);
      return value;
    }
    std::string text() {
      const std::size_t end = bytes.find('\0', at);
      if (end == std::string::npos) throw std::runtime_error("a string does not end");
      std::string out = bytes.substr(at, end - at);
      at = end + 1;
      return out;
    }
  };

  void take(const std::string& packet) {
    Reader in{packet};
    const auto kind = in.whole<std::uint8_t>();
    in.whole<std::uint8_t>();  // focus
    const std::string name = in.text();
    const std::lock_guard lock(mutex_);
    if (kind == 4) {  // CreateImage
      TevPicture picture;
      picture.width = in.whole<std::int32_t>();
      picture.height = in.whole<std::int32_t>();
      const auto count = in.whole<std::int32_t>();
      for (std::int32_t i = 0; i < count; ++i)
        picture.channels[in.text()].resize(static_cast<std::size_t>(picture.width) *
                                           static_cast<std::size_t>(picture.height));
      pictures_[name] = picture;
    } else if (kind == 6) {  // UpdateImageV3
      TevPicture& picture = pictures_.at(name);
      ++picture.updates;
      const auto count = static_cast<std::size_t>(in.whole<std::int32_t>());
      std::vector<std::string> names(count);
      for (std::string& one : names) one = in.text();
      const auto x = in.whole<std::int32_t>(), y = in.whole<std::int32_t>();
      const auto width = in.whole<std::int32_t>(), height = in.whole<std::int32_t>();
      std::vector<std::int64_t> offsets(count), strides(count);
      for (auto& one : offsets) one = in.whole<std::int64_t>();
      for (auto& one : strides) one = in.whole<std::int64_t>();
      std::vector<float> values;
      while (in.at < packet.size()) values.push_back(in.number());
      if (x < 0 || y < 0 || x + width > picture.width || y + height > picture.height)
        throw std::runtime_error("a tile lies outside");
      for (std::size_t c = 0; c < count; ++c)
        for (std::int32_t row = 0; row < height; ++row)
          for (std::int32_t column = 0; column < width; ++column)
            picture.channels.at(names[c]).at(
                static_cast<std::size_t>((y + row) * picture.width + x + column)) =
                values.at(static_cast<std::size_t>(
                    offsets[c] + (std::int64_t{row} * width + column) * strides[c]));
    } else {
      throw std::runtime_error("a packet of kind " + std::to_string(kind));
    }
    if (in.at != packet.size()) throw std::runtime_error("a packet is too long");
  }

  bool ready(int socket) const {
    pollfd one{socket, POLLIN, 0};
    return ::poll(&one, 1, 20) > 0;
  }

  void run() {
    for (;;) {
      const bool was_over = over_;  // before the look at what has come
      if (!ready(listener_)) {
        if (was_over) return;
        continue;
      }
      const int connection = ::accept(listener_, nullptr, nullptr);
      std::string bytes;
      char piece[65536];
      for (bool there = true; there && (!over_ || (reads_ && ready(connection)));) {
        if (!reads_ || !ready(connection)) {
          if (!reads_) std::this_thread::sleep_for(std::chrono::milliseconds(5));
          continue;
        }
        const ssize_t count = ::recv(connection, piece, sizeof piece, 0);
        there = count > 0;
        if (there) bytes.append(piece, static_cast<std::size_t>(count));
        try {
          while (bytes.size() >= 4) {
            const std::uint32_t length = Reader{bytes, 0}.whole<std::uint32_t>();
            if (bytes.size() < length) break;
            take(bytes.substr(0, length));
            bytes.erase(0, length);
          }
        } catch (const std::exception& error) {
          const std::lock_guard lock(mutex_);
          problem_ = error.what();
          there = false;
        }
      }
      ::close(connection);
    }
  }

  bool reads_;
  int listener_ = -1;
  std::string port_;
  std::atomic<bool> over_ = false;
  std::mutex mutex_;
  std::map<std::string, TevPicture> pictures_;
  std::string problem_;
  std::thread thread_;
};

}  // namespace caplet::test
