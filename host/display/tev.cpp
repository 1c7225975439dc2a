// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "display/tev.h"

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "display/detail/packets.h"

namespace caplet {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int wait_milliseconds = 50;  // between checks of `given_up`
constexpr double most_connect_seconds = 5;

/// A connection that checks `given_up` regularly while it waits.
class Connection {
 public:
  Connection() = default;
  ~Connection() {
    if (socket_ >= 0) ::close(socket_);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Returns the error; empty on success.
  std::string open(const addrinfo* addresses, const std::atomic<bool>& given_up) {
    std::string problem = "no address";
    for (const addrinfo* one = addresses; one; one = one->ai_next) {
      if (socket_ >= 0) ::close(socket_);
      socket_ = ::socket(one->ai_family, one->ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK,
                         one->ai_protocol);
      if (socket_ < 0) {
        problem = std::strerror(errno);
        continue;
      }
      if (::connect(socket_, one->ai_addr, one->ai_addrlen) == 0) return {};
      if (errno != EINPROGRESS) {
        problem = std::strerror(errno);
        continue;
      }
      if (!wait(given_up, most_connect_seconds)) {
        problem = "no answer";
        continue;
      }
      int error = 0;
      socklen_t size = sizeof error;
      ::getsockopt(socket_, SOL_SOCKET, SO_ERROR, &error, &size);
      if (error == 0) return {};
      problem = std::strerror(error);
    }
    return problem;
  }

  /// Returns the error, also if it was given up; empty on success.
  std::string send(const std::string& bytes, const std::atomic<bool>& given_up) {
    std::size_t sent = 0;
    while (sent < bytes.size()) {
      const ssize_t count = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (count > 0)
        sent += static_cast<std::size_t>(count);
      else if (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)
        return std::strerror(errno);
      else if (!wait(given_up, {}))
        return "given up";
    }
    return {};
  }

 private:
  bool wait(const std::atomic<bool>& given_up, std::optional<double> seconds) const {
    const Clock::time_point start = Clock::now();
    while (!given_up) {
      pollfd one{socket_, POLLOUT, 0};
      if (::poll(&one, 1, wait_milliseconds) > 0) return true;
      if (seconds && std::chrono::duration<double>(Clock::now() - start).count() > *seconds)
        return false;
    }
    return false;
  }
  int socket_ = -1;
};

}  // namespace

struct TevDisplay::State {
  std::string name, where;
  addrinfo* addresses = nullptr;
  mutable std::mutex mutex;
  std::condition_variable changed;
  std::optional<LayeredImage> waiting;  // the newest picture
  bool is_busy = false, is_gone = false, is_over = false;
  std::atomic<bool> given_up = false;
  std::thread thread;

  ~State() {
    if (addresses) ::freeaddrinfo(addresses);
  }

  void fail(const std::string& problem) {
    if (!given_up) log::warn("tev at {}: {}; the picture is not shown there", where, problem);
    const std::lock_guard lock(mutex);
    is_gone = true;
    waiting.reset();
  }

  void run() {
    Connection connection;
    if (const std::string problem = connection.open(addresses, given_up); !problem.empty())
      return end(problem);
    LayeredImage shown;
    for (;;) {
      LayeredImage next;
      {
        std::unique_lock lock(mutex);
        is_busy = false;
        changed.notify_all();
        changed.wait(lock, [&] { return waiting || is_over; });
        if (!waiting) return;
        next = std::move(*waiting);
        waiting.reset();
        is_busy = true;
      }
      if (const std::string problem = update(connection, shown, next); !problem.empty())
        return end(problem);
      shown = std::move(next);
    }
  }
  void end(const std::string& problem) {
    fail(problem);
    changed.notify_all();
  }

  std::string update(Connection& connection, const LayeredImage& shown, const LayeredImage& next) {
    std::string problem;
    if (shown.channels.empty()) problem = connection.send(tev::create_packet(name, next), given_up);
    for (const tev::Tile& tile : tev::changed_tiles(shown, next)) {
      if (!problem.empty()) break;
      problem = connection.send(tev::update_packet(name, next, tile), given_up);
    }
    return problem;
  }
};

TevAddress parse_tev_address(const std::string& text, const std::string& flag) {
  const std::size_t colon = text.rfind(':');
  TevAddress out{"127.0.0.1", text};
  if (colon != std::string::npos) {
    out = {text.substr(0, colon), text.substr(colon + 1)};
    if (out.host.empty()) out.host = "127.0.0.1";
    if (out.host.size() > 2 && out.host.front() == '[' && out.host.back() == ']')
      out.host = out.host.substr(1, out.host.size() - 2);
  }
  const bool is_number = !out.port.empty() && out.port.size() <= 5 &&
                         out.port.find_first_not_of("0123456789") == std::string::npos;
  if (!is_number || std::stoi(out.port) < 1 || std::stoi(out.port) > 65535)
    throw InputError(SourceLocation{flag},
                     "'" + text + "' is no HOST:PORT, such as 127.0.0.1:14158");
  return out;
}

TevDisplay::TevDisplay(const TevAddress& address, const std::string& name)
    : state_(std::make_shared<State>()) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  if (const int error =
          ::getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &state_->addresses);
      error != 0)
    throw InputError("tev: there is no host '" + address.host + "' (" + ::gai_strerror(error) +
                     ")");
  state_->name = name;
  state_->where = address.host + ":" + address.port;
  state_->is_busy = true;  // until it is connected
  state_->thread = std::thread([state = state_] { state->run(); });
}

TevDisplay::~TevDisplay() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->given_up = true;
    state_->is_over = true;
    state_->waiting.reset();
  }
  state_->changed.notify_all();
  state_->thread.join();
}

bool TevDisplay::is_idle() const {
  const std::lock_guard lock(state_->mutex);
  return !state_->is_gone && !state_->waiting && !state_->is_busy;
}

void TevDisplay::show(LayeredImage image) {
  {
    const std::lock_guard lock(state_->mutex);
    if (state_->is_gone) return;
    state_->waiting = std::move(image);
  }
  state_->changed.notify_all();
}

void TevDisplay::finish(double seconds) {
  std::unique_lock lock(state_->mutex);
  const auto is_done = [&] { return state_->is_gone || (!state_->waiting && !state_->is_busy); };
  if (state_->changed.wait_for(lock, std::chrono::duration<double>(seconds), is_done)) return;
  log::warn("tev at {} is too slow: it does not show the whole picture", state_->where);
}

}  // namespace caplet
