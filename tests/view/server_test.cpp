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
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>

#include "base/error.h"
#include "view/addresses.h"

namespace caplet::view {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::Not;
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
    events.message = [this](ClientId, const std::string& text) {
      note([&] { messages.push_back(text); });
    };
    events.picture = [this](ClientId id) -> std::shared_ptr<const std::string> {
      const std::lock_guard lock(mutex_);
      return std::exchange(shown_[id], version) == version ? nullptr : picture;
    };
    server.emplace(options, std::move(events));
  }
  /// Ends the server's thread first: its events use what is declared behind it.
  ~Served() { server.reset(); }
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
  std::map<ClientId, std::uint64_t> shown_;  // the version that each has had
};

/// What it answers to these bytes, until it closes or is silent for a while.
std::string answer(const Served& to, const std::string& bytes,
                   const std::string& address = "127.0.0.1") {
  asio::io_context context;
  beast::tcp_stream stream(context);
  stream.connect(tcp::endpoint(asio::ip::make_address(address), to.server->port()));
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

std::string get(const Served& from, const std::string& target, const std::string& host,
                const std::string& more = "", const std::string& address = "127.0.0.1") {
  return answer(
      from,
      fmt::format("GET {} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n{}\r\n", target, host, more),
      address);
}

class Socket {
 public:
  /// Throws boost::system::system_error when it is refused.
  explicit Socket(const Served& to, const std::string& origin = "", const std::string& path = "")
      : stream_(context_) {
    beast::get_lowest_layer(stream_).connect(
        tcp::endpoint(asio::ip::make_address("127.0.0.1"), to.server->port()));
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
  EXPECT_THAT(
      get(served, fmt::format("/{}/", token), fmt::format("localhost:{}", served.server->port())),
      StartsWith("HTTP/1.1 200"));
}

// A frame could be laid under another page's buttons, so only pages of this machine have it, when
// asked.
TEST(Server, IsInNobodysFrameUnlessItIsEmbedded) {
  ServerOptions options;
  options.is_embedded = true;
  const Served served, embedded(options);
  const std::string page = get(served, fmt::format("/{}/", token), served.authority()),
                    framed = get(embedded, fmt::format("/{}/", token), embedded.authority());
  EXPECT_THAT(page, HasSubstr("X-Frame-Options: DENY\r\n"));
  EXPECT_THAT(page, HasSubstr("frame-ancestors 'none'\r\n"));
  EXPECT_THAT(framed, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(framed, Not(HasSubstr("X-Frame-Options")));
  EXPECT_THAT(framed,
              HasSubstr("frame-ancestors http://localhost:* http://127.0.0.1:* vscode-webview:"));
  EXPECT_THAT(get(embedded, "/", embedded.authority()), StartsWith("HTTP/1.1 403"));
}

TEST(Server, RefusesOtherTokensHostsAndPaths) {
  const Served served;
  const std::string here = served.authority(), right = fmt::format("/{}/", token);
  for (const std::string& target :
       {std::string("/"), std::string("/x/"), std::string("/0123456789abcdef0123456789abcdee/"),
        std::string("//"), "/" + std::string(token), std::string("*")})
    EXPECT_THAT(get(served, target, here), StartsWith("HTTP/1.1 403")) << target;
  for (const std::string& host :
       {std::string("evil.example"), fmt::format("evil.example:{}", served.server->port()),
        std::string("127.0.0.1:1"), std::string("127.0.0.1"), std::string()})
    EXPECT_THAT(get(served, right, host), StartsWith("HTTP/1.1 403")) << host;
  for (const char* path :
       {"../../etc/passwd", "%2e%2e/%2e%2e/etc/passwd", "page/index.html", "socket/.."})
    EXPECT_THAT(get(served, right + path, here), StartsWith("HTTP/1.1 404")) << path;
  EXPECT_THAT(
      answer(served,
             fmt::format("POST {} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", right, here)),
      StartsWith("HTTP/1.1 405"));
}

TEST(Server, RefusesHostsThatAreNoneOrSeveral) {
  const Served served;
  const std::string right = fmt::format("/{}/", token), here = served.authority();
  const unsigned port = served.server->port();
  for (const std::string& host :
       {fmt::format("127.0.0.1:1:{}", port), fmt::format("127.0.0.1:{0}:{0}", port),
        fmt::format("evil.example:127.0.0.1:{}", port), fmt::format("127.0.0.1:{}x", port),
        fmt::format("127.0.0.1:+{}", port), fmt::format("127.0.0.1: {}", port),
        fmt::format("127.0.0.1:{}", port + 65536), fmt::format("[::1:{}", port),
        fmt::format("[::1]{}", port), fmt::format("[::1]x:{}", port), fmt::format("::1:{}", port),
        fmt::format(":{}", port), fmt::format("[]:{}", port), fmt::format("a@127.0.0.1:{}", port),
        fmt::format("127.0.0.1:{},evil.example", port), std::string("127.0.0.1:")})
    EXPECT_THAT(get(served, right, host), StartsWith("HTTP/1.1 403")) << host;
  EXPECT_THAT(get(served, right, fmt::format("[::1]:{}", port)), StartsWith("HTTP/1.1 200"));
  // RFC 9112, section 3.2: several are answered by 400.
  for (const std::string& other : {here, std::string("evil.example")})
    for (const auto& [first, second] : {std::pair(here, other), std::pair(other, here)})
      EXPECT_THAT(get(served, right, first, fmt::format("Host: {}\r\n", second)),
                  StartsWith("HTTP/1.1 400"))
          << other;
  EXPECT_THAT(answer(served, fmt::format("GET {} HTTP/1.0\r\n\r\n", right)),
              StartsWith("HTTP/1.1 403"));
  // A second Origin does not open a socket, whichever comes first.
  const auto opens = [&](const std::string& origins) {
    return answer(
        served,
        fmt::format(
            "GET {}socket HTTP/1.1\r\nHost: {}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
            "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n{}\r\n",
            right, here, origins));
  };
  const std::string own = fmt::format("Origin: http://{}\r\n", here),
                    evil = "Origin: http://evil.example\r\n";
  EXPECT_THAT(opens(own), StartsWith("HTTP/1.1 101"));
  for (const std::string& origins : {own + evil, evil + own, own + own, std::string()})
    EXPECT_THAT(opens(origins), StartsWith("HTTP/1.1 403")) << origins;
}

TEST(Server, EndsAConnectionThatDoesNotNameTheToken) {
  const Served served;
  // One request, whatever else waits behind it.
  const std::string wrong = fmt::format("GET /x/ HTTP/1.1\r\nHost: {}\r\n\r\n", served.authority());
  const std::string right =
      fmt::format("GET /{}/ HTTP/1.1\r\nHost: {}\r\n\r\n", token, served.authority());
  EXPECT_THAT(answer(served, wrong + right),
              testing::AllOf(StartsWith("HTTP/1.1 403"), testing::Not(HasSubstr("200 OK"))));
  EXPECT_THAT(answer(served, right + right), HasSubstr("the pageHTTP/1.1 200"));
}

TEST(Server, EndsWhatIsNoRequest) {
  const Served served;
  const std::string right =
      fmt::format("GET /{}/ HTTP/1.1\r\nHost: {}\r\n", token, served.authority());
  EXPECT_THAT(answer(served, "hello\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(answer(served, right + "X: " + std::string(20000, 'x') + "\r\n\r\n"),
              StartsWith("HTTP/1.1 431"));
  EXPECT_THAT(answer(served, right + "Content-Length: 1000000000\r\n\r\n" + std::string(1000, 'x')),
              StartsWith("HTTP/1.1 413"));
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
    for (int i = 0; i < 200; ++i)
      served.server->send(served.last, std::make_shared<const std::string>(100000, 'x'));
    EXPECT_TRUE(served.becomes([&] { return served.left == 5; }));
  }
  {
    Socket garbage(served);
    asio::write(garbage.raw(), asio::buffer(std::string(64, '\xff')));
    EXPECT_TRUE(served.becomes([&] { return served.left == 6; }));
  }
  Socket fine(served);
  fine.say("still here");
  EXPECT_TRUE(served.becomes(
      [&] { return !served.messages.empty() && served.messages.back() == "still here"; }));
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
    silent.back().connect(tcp::endpoint(asio::ip::make_address("127.0.0.1"), served.server->port()),
                          error);
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

/// Connections that hold their places: silent, or with a byte of a header now and then.
class Holders {
 public:
  Holders(const Served& of, int count) {
    for (int i = 0; i < count; ++i) {
      sockets_.emplace_back(context_);
      sockets_.back().connect(
          tcp::endpoint(asio::ip::make_address("127.0.0.1"), of.server->port()));
    }
  }
  void say(std::string_view bytes) {
    for (tcp::socket& each : sockets_) {
      beast::error_code ignored;
      asio::write(each, asio::buffer(bytes), ignored);
    }
  }
  /// Those that the server has not closed.
  int open() {
    int out = 0;
    for (tcp::socket& each : sockets_) {
      char byte = 0;
      beast::error_code error;
      each.non_blocking(true);
      each.read_some(asio::buffer(&byte, 1), error);
      out += error == asio::error::would_block;
    }
    return out;
  }

 private:
  asio::io_context context_;
  std::vector<tcp::socket> sockets_;
};

TEST(Server, GivesNobodysPlaceToThoseWithoutTheToken) {
  ServerOptions options;
  options.stranger_seconds = 600;  // it is not their patience that helps here
  Served served(options);
  Holders silent(served, 64), slow(served, 64);
  slow.say("GET / HTTP/1.1\r\nHost: ");
  Socket socket(served);  // throws where there is no place
  EXPECT_TRUE(served.becomes([&] { return served.joined == 1; }));
  EXPECT_THAT(get(served, fmt::format("/{}/", token), served.authority()),
              StartsWith("HTTP/1.1 200"));
  EXPECT_LE(silent.open() + slow.open(), static_cast<int>(options.most_strangers_an_address));
  // Nor do they put out who knows it.
  Holders more(served, 64);
  socket.say("still here");
  EXPECT_TRUE(served.becomes([&] { return served.messages.size() == 1; }));
  EXPECT_EQ(served.left, 0);
}

TEST(Server, WaitsForNoHeaderLongerThanItSays) {
  ServerOptions options;
  options.stranger_seconds = 0.5;
  const Served served(options);
  Holders silent(served, 4), slow(served, 4);
  EXPECT_EQ(silent.open() + slow.open(), 8);
  const auto start = std::chrono::steady_clock::now();
  int open = 8;
  while (open > 0 && std::chrono::steady_clock::now() - start < std::chrono::seconds(10)) {
    slow.say("x");  // which is no new beginning
    std::this_thread::sleep_for(milliseconds(20));
    open = silent.open() + slow.open();
  }
  EXPECT_EQ(open, 0);
  EXPECT_GT(std::chrono::steady_clock::now() - start, milliseconds(300));
}

TEST(Server, CountsThoseWhoKnowTheToken) {
  ServerOptions options;
  options.most_connections = 3;
  Served served(options);
  std::vector<std::unique_ptr<Socket>> clients;
  for (int i = 0; i < 3; ++i) clients.push_back(std::make_unique<Socket>(served));
  ASSERT_TRUE(served.becomes([&] { return served.joined == 3; }));
  EXPECT_THAT(get(served, fmt::format("/{}/", token), served.authority()),
              StartsWith("HTTP/1.1 503"));
  clients.pop_back();
  ASSERT_TRUE(served.becomes([&] { return served.left == 1; }));
  EXPECT_THAT(get(served, fmt::format("/{}/", token), served.authority()),
              StartsWith("HTTP/1.1 200"));
}

TEST(Server, KeepsAClientThatTakesWhatItIsSent) {
  ServerOptions options;
  options.most_waiting_bytes = 1000000;
  Served served(options);
  Socket socket(served);
  ASSERT_TRUE(served.becomes([&] { return served.joined == 1; }));
  const auto message = std::make_shared<const std::string>(400000, 'x');
  for (int i = 0; i < 20; ++i) {  // eight times what may wait, of which no more than one does
    served.server->send(served.last, message);
    ASSERT_EQ(socket.read().size(), message->size()) << i;
  }
  EXPECT_EQ(served.left, 0);
}

/// The address that this machine has towards others, as the kernel chooses it for a datagram; empty
/// where there is no way out.
std::string own_address() {
  asio::io_context context;
  asio::ip::udp::socket socket(context, asio::ip::udp::v4());
  beast::error_code error;
  socket.connect({asio::ip::make_address("198.51.100.1"), 9},
                 error);  // of an example network: nothing is sent
  return error ? std::string() : socket.local_endpoint().address().to_string();
}

TEST(Server, ThatIsOpenToAllSaysWhereItIs) {
  for (const std::string host : {"0.0.0.0", "::"}) {
    ServerOptions options;
    options.host = host;
    std::optional<Served> served;
    try {
      served.emplace(options);
    } catch (const RunError&) {
      EXPECT_EQ(host, "::");  // a machine without IPv6
      continue;
    }
    const std::vector<std::string> addresses = addresses_reached(host);
    ASSERT_FALSE(addresses.empty());
    EXPECT_EQ(
        served->server->address(),
        fmt::format("http://{}/{}/", authority_of(addresses[0], served->server->port()), token));
    const std::string own = own_address();
    if (!own.empty()) {
      EXPECT_THAT(addresses, testing::Contains(own));
      EXPECT_THAT(addresses, testing::Each(testing::Not(StartsWith("127."))));
    }
    for (const std::string& address : addresses) {
      const std::string page = get(*served, fmt::format("/{}/", token),
                                   authority_of(address, served->server->port()), "", address);
      EXPECT_THAT(page, StartsWith("HTTP/1.1 200")) << address;
    }
    EXPECT_THAT(get(*served, fmt::format("/{}/", token), "evil.example"),
                StartsWith("HTTP/1.1 403"));
  }
  EXPECT_THAT(addresses_reached("192.0.2.7"), testing::ElementsAre("192.0.2.7"));
  EXPECT_TRUE(is_this_machine_alone("127.0.0.1") && is_this_machine_alone("127.1.2.3") &&
              is_this_machine_alone("::1"));
  for (const char* open : {"0.0.0.0", "::", "192.0.2.7", "::ffff:127.0.0.1", "12.7.0.0"})
    EXPECT_FALSE(is_this_machine_alone(open));
}

TEST(Server, SaysWhyItCannotListen) {
  const Served served;
  ServerOptions taken;
  taken.port = served.server->port();
  EXPECT_THAT([&] { Server(taken, {}); },
              testing::ThrowsMessage<RunError>(HasSubstr("cannot listen at 127.0.0.1:")));
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
