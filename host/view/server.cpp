// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/server.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <boost/asio/bind_executor.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <charconv>
#include <chrono>
#include <deque>
#include <list>
#include <map>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "view/addresses.h"

namespace caplet::view {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using std::chrono::steady_clock;

namespace {

constexpr std::size_t most_header_bytes = 8192;
constexpr std::chrono::seconds request_patience{15}, handshake_patience{5};
constexpr std::size_t most_strangers = 48;

using Request = http::request<http::empty_body>;
using Parser = http::request_parser<http::empty_body>;

std::string_view view_of(boost::string_view text) { return {text.data(), text.size()}; }

/// The value of a Host header: "127.0.0.1:8080", "[::1]:80", "localhost".
struct Authority {
  std::string_view host;
  std::optional<std::uint16_t> port;
};

/// Parses a host with at most one port (RFC 3986, section 3.2); no value for anything else.
std::optional<Authority> authority_in(std::string_view text) {
  Authority out;
  const bool is_bracketed = text.starts_with('[');
  const std::size_t end = is_bracketed ? text.find(']') : std::min(text.find(':'), text.size());
  if (end == std::string_view::npos) return {};
  out.host = text.substr(is_bracketed ? 1 : 0, end - (is_bracketed ? 1 : 0));
  text.remove_prefix(end + (is_bracketed ? 1 : 0));
  if (out.host.empty()) return {};
  if (text.empty()) return out;
  std::uint16_t port = 0;
  const auto [stop, error] = std::from_chars(text.data() + 1, text.data() + text.size(), port);
  if (text[0] != ':' || error != std::errc() || stop != text.data() + text.size()) return {};
  out.port = port;
  return out;
}

/// Returns the only value of a header; none if it is missing or repeated.
std::optional<std::string_view> only(const Request& request, http::field name) {
  const auto [begin, end] = request.equal_range(name);
  if (begin == end || std::next(begin) != end) return {};
  return view_of(begin->value());
}

/// Returns the IPv4 address of a client that came through an IPv6 socket.
asio::ip::address plain(const asio::ip::address& address) {
  if (!address.is_v6() || !address.to_v6().is_v4_mapped()) return address;
  return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6());
}

/// Limits a client's messages: a rate per second and a burst.
class Allowance {
 public:
  Allowance(double rate, double burst) : rate_(rate), burst_(burst), left_(burst) {}
  bool take() {
    const steady_clock::time_point now = steady_clock::now();
    left_ = std::min(burst_, left_ + rate_ * std::chrono::duration<double>(now - last_).count());
    last_ = now;
    if (left_ < 1) return false;
    left_ -= 1;
    return true;
  }

 private:
  double rate_, burst_, left_;
  steady_clock::time_point last_ = steady_clock::now();
};

}  // namespace

class Server::State {
 public:
  class Client;
  class Connection;

  State(const ServerOptions& options, ServerEvents events)
      : options_(options), events_(std::move(events)), acceptor_(context_) {
    try {
      const tcp::endpoint at(asio::ip::make_address(options.host), options.port);
      acceptor_.open(at.protocol());
      acceptor_.set_option(asio::socket_base::reuse_address(true));
      if (at.protocol() == tcp::v6())
        acceptor_.set_option(asio::ip::v6_only(false));  // "::" accepts all of IPv4, too
      acceptor_.bind(at);
      acceptor_.listen();
      port_ = acceptor_.local_endpoint().port();
    } catch (const boost::system::system_error& error) {
      throw RunError(fmt::format("cannot listen at {}: {}",
                                 authority_of(options.host, options.port), error.code().message()));
    }
    accept();
    thread_ = std::thread([this] { context_.run(); });
  }

  ~State() {
    context_.stop();
    thread_.join();
  }

  std::uint16_t port() const { return port_; }
  std::string address() const {
    const std::vector<std::string> reached = addresses_reached(options_.host);
    return fmt::format("http://{}/{}/", authority_of(reached.front(), port_), options_.token);
  }

  asio::io_context& context() { return context_; }
  const ServerOptions& options() const { return options_; }
  const ServerEvents& events() const { return events_; }
  std::map<ClientId, std::weak_ptr<Client>>& clients() { return clients_; }
  std::size_t& connections() { return connections_; }
  std::chrono::milliseconds stranger_patience() const {
    return std::chrono::milliseconds(static_cast<int>(1e3 * options_.stranger_seconds));
  }
  ClientId next_client() { return ++last_client_; }

  /// Accepts only names that a page of this machine uses, and so no name that an attacker's DNS
  /// resolves to it.
  bool is_own(std::string_view text, const tcp::endpoint& here) const {
    const std::optional<Authority> authority = authority_in(text);
    if (!authority || authority->port.value_or(80) != port_) return false;
    const std::string_view host = authority->host;
    if (host == options_.host || host == "localhost" || host == "127.0.0.1" || host == "::1")
      return true;
    return host == plain(here.address()).to_string();
  }

  // Strangers are connections that have not sent the token yet, in the order of arrival.
  void add_stranger(const std::shared_ptr<Connection>& one) { strangers_.push_back(one); }
  void forget_stranger(const Connection* one);

 private:
  void accept();
  void make_room_for(const asio::ip::address& from);

  ServerOptions options_;
  ServerEvents events_;
  std::map<ClientId, std::weak_ptr<Client>> clients_;
  std::list<std::weak_ptr<Connection>> strangers_;
  std::size_t connections_ = 0;  // those that have sent the token, including sockets
  ClientId last_client_ = 0;
  asio::io_context context_{1};  // it is destroyed before the objects that its handlers refer to
  tcp::acceptor acceptor_;
  std::uint16_t port_ = 0;
  std::thread thread_;
};

// --- Clients: WebSockets ---

class Server::State::Client : public std::enable_shared_from_this<Client> {
 public:
  Client(State& server, beast::tcp_stream&& stream)
      : server_(server),
        socket_(std::move(stream)),
        id_(server.next_client()),
        allowance_(server.options().messages_a_second, server.options().burst) {
    ++server_.connections();
  }
  ~Client() {
    --server_.connections();
    if (!joined_) return;
    server_.clients().erase(id_);
    server_.events().left(id_);
  }

  void run(const Request& request) {
    socket_.set_option(websocket::stream_base::timeout{
        handshake_patience,
        std::chrono::milliseconds(static_cast<int>(1e3 * server_.options().silence_seconds)),
        true});
    socket_.read_message_max(server_.options().most_message_bytes);
    socket_.auto_fragment(false);
    socket_.async_accept(request, [self = shared_from_this()](beast::error_code error) {
      if (error) return;
      self->joined_ = true;
      self->server_.clients()[self->id_] = self;
      self->server_.events().joined(self->id_);
      self->read();
      self->go_on();
    });
  }

  void send(std::shared_ptr<const std::string> message, bool binary) {
    waiting_bytes_ += message->size();
    if (waiting_bytes_ > server_.options().most_waiting_bytes)
      return drop();  // it reads nothing, not even a reason
    waiting_.push_back({std::move(message), binary});
    go_on();
  }

  /// Writes waiting messages, or else the newest picture.
  void go_on() {
    if (writing_ || ended_ || !joined_) return;
    bool binary = true;
    if (waiting_.empty()) {
      now_ = server_.events().picture(id_);
    } else {
      now_ = std::move(waiting_.front().first);
      binary = waiting_.front().second;
      waiting_bytes_ -= now_->size();
      waiting_.pop_front();
    }
    if (!now_) return;
    writing_ = true;
    socket_.binary(binary);
    socket_.async_write(asio::buffer(*now_),
                        [self = shared_from_this()](beast::error_code error, std::size_t) {
                          self->writing_ = false;
                          if (error) return self->drop();
                          self->go_on();
                        });
  }

 private:
  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (error) return self->drop();
      if (!self->socket_.got_text()) return self->end(websocket::close_code::unknown_data);
      if (!self->allowance_.take()) return self->end(websocket::close_code::policy_error);
      self->server_.events().message(self->id_, beast::buffers_to_string(self->buffer_.data()));
      self->buffer_.consume(self->buffer_.size());
      self->read();
    });
  }

  /// Closes with a reason. Data that the client does not read within the timeout are dropped.
  void end(websocket::close_code why) {
    if (std::exchange(ended_, true)) return;
    waiting_.clear();
    socket_.async_close(why, [self = shared_from_this()](beast::error_code) { self->drop(); });
  }

  void drop() {
    ended_ = true;
    beast::get_lowest_layer(socket_).cancel();
  }

  State& server_;
  websocket::stream<beast::tcp_stream> socket_;
  ClientId id_;
  Allowance allowance_;
  beast::flat_buffer buffer_;
  std::deque<std::pair<std::shared_ptr<const std::string>, bool>> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::shared_ptr<const std::string> now_;
  bool joined_ = false, writing_ = false, ended_ = false;
};

// --- Connections: requests for files, until one asks for a WebSocket ---

class Server::State::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(State& server, tcp::socket&& socket) : server_(server), stream_(std::move(socket)) {
    beast::error_code ignored;
    here_ = stream_.socket().local_endpoint(ignored);
    from_ = plain(stream_.socket().remote_endpoint(ignored).address());
  }
  ~Connection() {
    if (is_known_)
      --server_.connections();
    else
      server_.forget_stranger(this);
  }
  const asio::ip::address& from() const { return from_; }
  void drop() { stream_.close(); }

  void read() {
    parser_.emplace();
    parser_->header_limit(most_header_bytes);
    parser_->body_limit(0);
    stream_.expires_after(is_known_ ? request_patience : server_.stranger_patience());
    http::async_read(
        stream_, buffer_, *parser_,
        [self = shared_from_this()](beast::error_code error, std::size_t) {
          if (error == http::error::end_of_stream) return self->close();
          if (error == http::error::header_limit)
            return self->answer(http::status::request_header_fields_too_large, {}, false);
          if (error == http::error::body_limit)
            return self->answer(http::status::payload_too_large, {}, false);
          if (error.category() == http::make_error_code(http::error::end_of_stream).category())
            return self->answer(http::status::bad_request, {}, false);
          if (!error) self->respond();
        });
  }

 private:
  void respond() {
    const Request& request = parser_->get();
    const bool keep = request.keep_alive();
    if (request.count(http::field::host) > 1) return answer(http::status::bad_request, {}, false);
    const std::string_view host = only(request, http::field::host).value_or("");
    if (!server_.is_own(host, here_)) return answer(http::status::forbidden, {}, false);
    // The path is "/TOKEN/path".
    std::string_view path = view_of(request.target());
    path = path.substr(0, path.find('?'));
    const std::size_t slash = path.find('/', 1);
    const std::string_view token = path.substr(std::min<std::size_t>(1, path.size()),
                                               slash == std::string_view::npos ? slash : slash - 1);
    if (!path.starts_with('/') || slash == std::string_view::npos ||
        !equal_in_constant_time(token, server_.options().token))
      return answer(http::status::forbidden, {}, false);
    if (!become_known()) return answer(http::status::service_unavailable, {}, false);
    path.remove_prefix(slash + 1);
    if (request.method() != http::verb::get && request.method() != http::verb::head)
      return answer(http::status::method_not_allowed, {}, keep);
    if (websocket::is_upgrade(request)) return upgrade(path, host);
    const std::optional<PageFile> file = server_.events().file(path);
    answer(file ? http::status::ok : http::status::not_found, file.value_or(PageFile{}), keep,
           request.method() == http::verb::head);
  }

  /// Returns false if there are too many connections.
  bool become_known() {
    if (is_known_) return true;
    if (server_.connections() >= server_.options().most_connections) return false;
    server_.forget_stranger(this);
    ++server_.connections();
    return is_known_ = true;
  }

  void upgrade(std::string_view path, std::string_view host) {
    const Request& request = parser_->get();
    if (path != "socket") return answer(http::status::not_found, {}, false);
    // Pages of other sites can open sockets here; the browser sends the site in Origin.
    if (only(request, http::field::origin).value_or("") != fmt::format("http://{}", host))
      return answer(http::status::forbidden, {}, false);
    const auto joined = static_cast<std::size_t>(std::ranges::count_if(
        server_.clients(), [](const auto& client) { return !client.second.expired(); }));
    if (joined >= server_.options().most_clients)
      return answer(http::status::service_unavailable, {}, false);
    const Request asked = parser_->release();
    stream_.expires_never();
    std::make_shared<Client>(server_, std::move(stream_))->run(asked);
  }

  void answer(http::status status, const PageFile& file, bool keep, bool head = false) {
    response_.emplace();
    response_->result(status);
    response_->version(11);
    response_->keep_alive(keep);
    response_->set(http::field::content_type, status == http::status::ok
                                                  ? std::string(file.type)
                                                  : "text/plain; charset=utf-8");
    response_->set(http::field::cache_control, "no-store");
    response_->set("X-Content-Type-Options", "nosniff");
    if (!server_.options().is_embedded) response_->set("X-Frame-Options", "DENY");
    response_->set("Referrer-Policy", "no-referrer");
    response_->set("Cross-Origin-Resource-Policy", "same-origin");
    // Notebooks are pages of this machine, or of an editor on it.
    response_->set(
        "Content-Security-Policy",
        fmt::format("default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: "
                    "blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
                    "frame-ancestors {}",
                    server_.options().is_embedded
                        ? "http://localhost:* http://127.0.0.1:* vscode-webview:"
                        : "'none'"));
    response_->body() = status == http::status::ok
                            ? std::string(file.text)
                            : std::string(view_of(http::obsolete_reason(status))) + "\n";
    response_->prepare_payload();
    if (head) response_->body().clear();
    stream_.expires_after(request_patience);
    http::async_write(stream_, *response_,
                      [self = shared_from_this(), keep](beast::error_code error, std::size_t) {
                        if (error || !keep) return self->close();
                        self->read();
                      });
  }

  void close() {
    beast::error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  }

  State& server_;
  beast::tcp_stream stream_;
  tcp::endpoint here_;
  asio::ip::address from_;
  bool is_known_ = false;  // it has sent the token
  beast::flat_buffer buffer_{most_header_bytes + 4096};
  std::optional<Parser> parser_;
  std::optional<http::response<http::string_body>> response_;
};

void Server::State::forget_stranger(const Connection* one) {
  std::erase_if(strangers_,
                [&](const auto& other) { return other.expired() || other.lock().get() == one; });
}

/// Drops the oldest silent connection when a new one needs its place: a browser sends its request
/// at once. So nobody can keep others out by waiting, not even those from the same address.
void Server::State::make_room_for(const asio::ip::address& from) {
  std::shared_ptr<Connection> oldest, oldest_from_there;
  std::size_t all = 0, from_there = 0;
  for (const auto& each : strangers_) {
    const auto one = each.lock();
    if (!one) continue;
    if (all++ == 0) oldest = one;
    if (one->from() == from && from_there++ == 0) oldest_from_there = one;
  }
  const std::shared_ptr<Connection> goes = from_there >= options_.most_strangers_an_address
                                               ? oldest_from_there
                                           : all >= most_strangers ? oldest
                                                                   : nullptr;
  if (!goes) return;
  forget_stranger(goes.get());
  goes->drop();
}

void Server::State::accept() {
  acceptor_.async_accept([this](beast::error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error) {
      beast::error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      const auto connection = std::make_shared<Connection>(*this, std::move(socket));
      make_room_for(connection->from());
      add_stranger(connection);
      connection->read();
    }
    accept();
  });
}

// --- The public interface ---

Server::Server(const ServerOptions& options, ServerEvents events)
    : state_(std::make_unique<State>(options, std::move(events))) {}
Server::~Server() = default;
std::uint16_t Server::port() const { return state_->port(); }
std::string Server::address() const { return state_->address(); }

void Server::send(ClientId to, std::shared_ptr<const std::string> message, bool binary) {
  asio::post(state_->context(), [state = state_.get(), to, message = std::move(message), binary] {
    const auto found = state->clients().find(to);
    if (found == state->clients().end()) return;
    if (const auto client = found->second.lock()) client->send(message, binary);
  });
}

void Server::send_to_all(std::shared_ptr<const std::string> message) {
  asio::post(state_->context(), [state = state_.get(), message = std::move(message)] {
    for (const auto& [id, each] : std::map(state->clients()))
      if (const auto client = each.lock()) client->send(message, false);
  });
}

void Server::picture_changed() {
  asio::post(state_->context(), [state = state_.get()] {
    for (const auto& [id, each] : std::map(state->clients()))
      if (const auto client = each.lock()) client->go_on();
  });
}

std::string random_token() {
  unsigned char bytes[16];
  if (::getrandom(bytes, sizeof bytes, 0) != static_cast<ssize_t>(sizeof bytes))
    throw RunError("the system has no random numbers");
  std::string out;
  for (const unsigned char byte : bytes) out += fmt::format("{:02x}", byte);
  return out;
}

bool equal_in_constant_time(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned char differ = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    differ = static_cast<unsigned char>(
        differ | (static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i])));
  return differ == 0;
}

}  // namespace caplet::view
