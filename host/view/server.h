// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A small server for a page of our own: HTTP for its files, a WebSocket for what it says and is told. It knows nothing of scenes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace caplet::view {

/// Numbers clients in the order in which they came, from 1.
using ClientId = std::uint64_t;

struct ServerOptions {
  std::string host = "127.0.0.1";                        // an address of this machine
  std::uint16_t port = 0;                                // 0: any that is free
  std::string token;                                     // first part of every path; whoever does not know it is refused
  std::size_t most_clients = 16, most_connections = 64;  // that know the token
  std::size_t most_strangers_an_address = 16;            // connections that have not named it yet: the oldest one goes
  double stranger_seconds = 5;                           // after which such a one is gone
  double silence_seconds = 8;                            // after which a client that answers no ping is gone
  std::size_t most_message_bytes = std::size_t{1} << 16;
  double messages_a_second = 300, burst = 600;             // of a client
  std::size_t most_waiting_bytes = std::size_t{32} << 20;  // of messages that a client has not taken
};

/// A file of the page.
struct PageFile {
  std::string_view type, text;
};

/// What a server asks and tells, on its own thread. None of them may block or throw.
struct ServerEvents {
  std::function<std::optional<PageFile>(std::string_view path)> file;  // below the token; "" is the page itself
  std::function<void(ClientId)> joined, left;
  std::function<void(ClientId, std::string)> message;
  /// The next picture for a client that has taken all that was sent to it, or null: `shown` is what it was given last (0: none),
  /// and becomes what it is given.
  std::function<std::shared_ptr<const std::string>(ClientId, std::uint64_t& shown)> picture;
};

/// Serves on a thread of its own from its making to its end. What is not asked for by the page's own address is refused: another
/// token, another Host than this machine's, another Origin than the page's. Messages, rates, connections and waiting bytes have
/// limits; a client beyond them is closed, and one that is slow gets fewer pictures. Who has not named the token has few places,
/// for seconds, and none of those of others.
class Server {
 public:
  /// Throws RunError when it cannot listen there.
  Server(const ServerOptions& options, ServerEvents events);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::uint16_t port() const;
  /// Returns the address of the page, with the token.
  std::string address() const;

  // From any thread:
  void send(ClientId to, std::shared_ptr<const std::string> message, bool binary = false);
  void send_to_all(std::shared_ptr<const std::string> message);
  /// There is a picture that clients do not have.
  void picture_changed();

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// 128 bits that nobody can guess, as 32 hexadecimal digits. Throws RunError when the machine has none.
std::string random_token();

/// Whether they are equal, in a time that depends on their lengths alone.
bool equal_in_constant_time(std::string_view a, std::string_view b);

}  // namespace caplet::view
