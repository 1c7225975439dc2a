// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/server.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "base/error.h"

namespace caplet::view {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* token = "0123456789abcdef0123456789abcdef";

/// A server that notes what it is told.
class Served {
 public:
  explicit Served(ServerOptions options = {}) {
    options.token = token;
    ServerEvents events;
    events.file = [](std::string_view path) {
      return path.empty() ? std::optional(PageFile{"text/html", "the page"}) : std::nullopt;
    };
    events.joined = [this](ClientId id) { note([&] { last = id, ++joined; }); };
    events.left = [this](ClientId) { note([&] { ++left; }); };
    events.message = [this](ClientId, const std::string& text) { note([&] { messages.push_back(text); }); };
    events.picture = [this](ClientId, std::uint64_t& shown) -> std::shared_ptr<const std::string> {
      const std::lock_guard lock(mutex_);
      if (shown == version) return {};
      shown = version;
      return picture;
    };
    server.emplace(options, std::move(events));
  }
  /// Waits until it holds, at most ten seconds.
  template <class What>
  bool becomes(const What& what) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(10), what);
  }
  void show(std::string bytes) {
    {
      const std::lock_guard lock(mutex_);
      picture = std::make_shared<const std::string>(std::move(bytes));
      ++version;
    }
    server->picture_changed();
  }
  std::string authority() const { return fmt::format("127.0.0.1:{}", server->port()); }

  ClientId last = 0;
  int joined = 0, left = 0;
  std::vector<std::string> messages;
  std::uint64_t version = 0;
  std::shared_ptr<const std::string> picture;
  std::optional<Server> server;

 private:
  template <class What>
  void note(const What& what) {
    {
      const std::lock_guard lock(mutex_);
      what();
    }
    changed_.notify_all();
  }
  std::mutex mutex_;
  std::condition_variable changed_;
};

/// What it answers to these bytes, until it closes or is silent for a while.
std::string answer(const Served& to, const std::string& bytes) {
  asio::io_context context;
  beast::tcp_stream stream(context);
  stream.connect(tcp::endpoint(asio::ip::make_address("127.0.0.1"), to.server->port()));
  beast::error_code error;
  asio::write(stream.socket(), asio::buffer(bytes), error);
  std::string out;
  char buffer[4096];
  stream.expires_after(milliseconds(1500));
  const std::function<void()> read = [&] {
    stream.async_read_some(asio::buffer(buffer), [&](beast::error_code end, std::size_t count) {
      out.append(buffer, count);
      if (!end) read();
    });
  };
  read();
  context.run();
  return out;
}

std::string get(const Served& from, const std::string& target, const std::string& host, const std::string& more = "") {
  return answer(from, fmt::format("GET {} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n{}\r\n", target, host, more));
}

class Socket {
 public:
  /// Throws boost::system::system_error when it is refused.
  explicit Socket(const Served& to, const std::string& origin = "", const std::string& path = "") : stream_(context_) {
    beast::get_lowest_layer(stream_).connect(tcp::endpoint(asio::ip::make_address("127.0.0.1"), to.server->port()));
    stream_.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
      request.set(beast::http::field::origin, origin.empty() ? "http://" + to.authority() : origin);
    }));
    stream_.read_message_max(0);
    stream_.handshake(to.authority(), path.empty() ? fmt::format("/{}/socket", token) : path);
  }
  void say(const std::string& text) { stream_.write(asio::buffer(text)); }
  std::string read() {
    beast::flat_buffer buffer;
    stream_.read(buffer);
    return beast::buffers_to_string(buffer.data());
  }
  tcp::socket& raw() { return beast::get_lowest_layer(stream_).socket(); }
  websocket::stream<beast::tcp_stream>& stream() { return stream_; }

 private:
  asio::io_context context_;
  websocket::stream<beast::tcp_stream> stream_;
};

TEST(Server, GivesItsPageToWhoeverHasTheToken) {
  const Served served;
  EXPECT_EQ(served.server->address(), fmt::format("http://{}/{}/", served.authority(), token));
  const std::string page = get(served, fmt::format("/{}/", token), served.authority());
  EXPECT_THAT(page, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(page, HasSubstr("\r\n\r\nthe page"));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_THAT(get(served, fmt::format("/{}/", token), fmt::format("localhost:{}", served.server->port())),
              StartsWith("HTTP/1.1 200"));
}

TEST(Server, RefusesOtherTokensHostsAndPaths) {
  const Served served;
  const std::string here = served.authority(), right = fmt::format("/{}/", token);
  for (const std::string& target : {std::string("/"), std::string("/x/"), std::string("/0123456789abcdef0123456789abcdee/"),
                                    std::string("//"), "/" + std::string(token), std::string("*")})
    EXPECT_THAT(get(served, target, here), StartsWith("HTTP/1.1 403")) << target;
  for (const std::string& host : {std::string("evil.example"), fmt::format("evil.example:{}", served.server->port()),
                                  std::string("127.0.0.1:1"), std::string("127.0.0.1"), std::string()})
    EXPECT_THAT(get(served, right, host), StartsWith("HTTP/1.1 403")) << host;
  for (const char* path : {"../../etc/passwd", "%2e%2e/%2e%2e/etc/passwd", "page/index.html", "socket/.."})
    EXPECT_THAT(get(served, right + path, here), StartsWith("HTTP/1.1 404")) << path;
  EXPECT_THAT(answer(served, fmt::format("POST {} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", right, here)),
              StartsWith("HTTP/1.1 405"));
}

TEST(Server, EndsWhatIsNoRequest) {
  const Served served;
  const std::string right = fmt::format("GET /{}/ HTTP/1.1\r\nHost: {}\r\n", token, served.authority());
  EXPECT_THAT(answer(served, "hello\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(answer(served, right + "X: " + std::string(20000, 'x') + "\r\n\r\n"), StartsWith("HTTP/1.1 431"));
  EXPECT_THAT(answer(served, right + "Content-Length: 1000000000\r\n\r\n" + std::string(1000, 'x')), StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(answer(served, std::string(100000, '\0')), testing::Not(HasSubstr("200")));
}

TEST(Server, PassesMessagesBothWays) {
  Served served;
  Socket socket(served);
  ASSERT_TRUE(served.becomes([&] { return served.joined == 1; }));
  socket.say("one");
  socket.say("two");
  ASSERT_TRUE(served.becomes([&] { return served.messages.size() == 2; }));
  EXPECT_THAT(served.messages, testing::ElementsAre("one", "two"));
  served.server->send(served.last, std::make_shared<const std::string>("to you"));
  EXPECT_EQ(socket.read(), "to you");
  EXPECT_TRUE(socket.stream().got_text());
  Socket other(served);
  ASSERT_TRUE(served.becomes([&] { return served.joined == 2; }));
  served.server->send_to_all(std::make_shared<const std::string>("to all"));
  EXPECT_EQ(socket.read(), "to all");
  EXPECT_EQ(other.read(), "to all");
  socket.stream().close(websocket::close_code::normal);
  EXPECT_TRUE(served.becomes([&] { return served.left == 1; }));
}

TEST(Server, RefusesSocketsOfOtherPages) {
  Served served;
  for (const char* origin : {"http://evil.example", "null", "https://127.0.0.1"})
    EXPECT_ANY_THROW(Socket(served, origin)) << origin;
  EXPECT_ANY_THROW(Socket(served, "", "/wrong/socket"));
  EXPECT_ANY_THROW(Socket(served, "", fmt::format("/{}/other", token)));
  Socket still(served);
  EXPECT_TRUE(served.becomes([&] { return served.joined == 1; }));
}

TEST(Server, GivesASlowClientTheNewestPictureAlone) {
  Served served;
  Socket socket(served);
  ASSERT_TRUE(served.becomes([&] { return served.joined == 1; }));
  for (int i = 0; i < 200; ++i) {
    served.show(fmt::format("{:>1000000}", i));
    std::this_thread::sleep_for(milliseconds(2));
  }
  int count = 0;
  std::string last;
  do {
    const std::string got = socket.read();
    EXPECT_LT(last, got);
    last = got;
    ++count;
  } while (last.substr(last.size() - 4) != " 199");
  EXPECT_LT(count, 100);  // the system's buffers hold some
}

TEST(Server, EndsClientsBeyondTheirLimits) {
  ServerOptions options;
  options.silence_seconds = 1;
  options.most_message_bytes = 1000;
  options.messages_a_second = 1;
  options.burst = 100;
  options.most_waiting_bytes = 1000000;
  Served served(options);
  {
    Socket large(served);
    large.say(std::string(1000, 'x'));
    ASSERT_TRUE(served.becomes([&] { return served.messages.size() == 1; }));
    large.say(std::string(1001, 'x'));
    EXPECT_TRUE(served.becomes([&] { return served.left == 1; }));
  }
  {
    Socket announced(served);  // 1 GB, of which a few bytes come
    const unsigned char head[] = {0x81, 0xff, 0, 0, 0, 0, 0x40, 0, 0, 0, 1, 2, 3, 4, 'x', 'x'};
    asio::write(announced.raw(), asio::buffer(head));
    EXPECT_TRUE(served.becomes([&] { return served.left == 2; }));
  }
  {
    Socket binary(served);
    binary.stream().binary(true);
    binary.say("bytes");
    EXPECT_TRUE(served.becomes([&] { return served.left == 3; }));
  }
  {
    Socket many(served);
    const std::size_t before = served.messages.size();
    beast::error_code error;
    for (int i = 0; i < 100000 && !error; ++i) many.stream().write(asio::buffer("x", 1), error);
    EXPECT_TRUE(served.becomes([&] { return served.left == 4; }));
    EXPECT_LT(served.messages.size() - before, 120u);
  }
  {
    Socket deaf(served);
    ASSERT_TRUE(served.becomes([&] { return served.joined == 5; }));
    for (int i = 0; i < 200; ++i) served.server->send(served.last, std::make_shared<const std::string>(100000, 'x'));
    EXPECT_TRUE(served.becomes([&] { return served.left == 5; }));
  }
  {
    Socket garbage(served);
    asio::write(garbage.raw(), asio::buffer(std::string(64, '\xff')));
    EXPECT_TRUE(served.becomes([&] { return served.left == 6; }));
  }
  Socket fine(served);
  fine.say("still here");
  EXPECT_TRUE(served.becomes([&] { return !served.messages.empty() && served.messages.back() == "still here"; }));
}

TEST(Server, HoldsAHundredConnections) {
  ServerOptions options;
  options.most_clients = 3;
  options.most_connections = 20;
  Served served(options);
  std::vector<std::unique_ptr<Socket>> clients;
  for (int i = 0; i < 3; ++i) clients.push_back(std::make_unique<Socket>(served));
  ASSERT_TRUE(served.becomes([&] { return served.joined == 3; }));
  EXPECT_ANY_THROW(Socket{served});
  asio::io_context context;
  std::vector<tcp::socket> silent;
  for (int i = 0; i < 100; ++i) {
    silent.emplace_back(context);
    beast::error_code error;
    silent.back().connect(tcp::endpoint(asio::ip::make_address("127.0.0.1"), served.server->port()), error);
  }
  clients[0]->say("still here");
  EXPECT_TRUE(served.becomes([&] { return served.messages.size() == 1; }));
  silent.clear();
  clients.pop_back();
  ASSERT_TRUE(served.becomes([&] { return served.left == 1; }));
  for (int tries = 0; served.joined < 4 && tries < 100; ++tries) try {
      clients.push_back(std::make_unique<Socket>(served));
      EXPECT_TRUE(served.becomes([&] { return served.joined == 4; }));
    } catch (const boost::system::system_error&) {  // the silent ones are being closed
      std::this_thread::sleep_for(milliseconds(20));
    }
  EXPECT_EQ(served.joined, 4);
}

TEST(Server, SaysWhyItCannotListen) {
  const Served served;
  ServerOptions taken;
  taken.port = served.server->port();
  EXPECT_THAT([&] { Server(taken, {}); }, testing::ThrowsMessage<RunError>(HasSubstr("cannot listen at 127.0.0.1:")));
  ServerOptions name;
  name.host = "no address";
  EXPECT_THAT([&] { Server(name, {}); }, testing::ThrowsMessage<RunError>(HasSubstr("no address")));
}

TEST(Tokens, AreRandomAndCompared) {
  EXPECT_EQ(random_token().size(), 32u);
  EXPECT_NE(random_token(), random_token());
  EXPECT_TRUE(equal_in_constant_time("abc", "abc"));
  EXPECT_FALSE(equal_in_constant_time("abc", "abd"));
  EXPECT_FALSE(equal_in_constant_time("xbc", "abc"));
  EXPECT_FALSE(equal_in_constant_time("abc", "abcd"));
  EXPECT_FALSE(equal_in_constant_time("", "a"));
}

}  // namespace
}  // namespace caplet::view
