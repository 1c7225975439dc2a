// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A small server for our own page: HTTP for its files, a WebSocket for messages. It does not depend
// on scenes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace caplet::view {

/// Clients are numbered in the order of arrival, from 1.
using ClientId = std::uint64_t;

struct ServerOptions {
  std::string host = "127.0.0.1";  // an address of this machine
  std::uint16_t port = 0;          // 0: any free port
  std::string token;               // first part of every path; requests without it are refused
  bool is_embedded = false;        // pages of this machine may show the page in a frame
  std::size_t most_clients = 16,
              most_connections = 64;  // limits for clients that have sent the token
  std::size_t most_strangers_an_address =
      16;  // limit of connections per address without token; the oldest is dropped
  double stranger_seconds = 5;  // time limit for sending the token
  double silence_seconds = 8;   // time limit for answering a ping
  std::size_t most_message_bytes = std::size_t{1} << 16;
  double messages_a_second = 300, burst = 600;             // limits per client
  std::size_t most_waiting_bytes = std::size_t{32} << 20;  // of messages that a client has not read
};

/// A file of the page.
struct PageFile {
  std::string_view type, text;
};

/// Callbacks of a server, called on its own thread. None of them may block or throw.
struct ServerEvents {
  std::function<std::optional<PageFile>(std::string_view path)>
      file;  // `path` comes after the token; "" is the page itself
  std::function<void(ClientId)> joined, left;
  std::function<void(ClientId, std::string)> message;
  /// Returns the next picture for a client that has read all earlier messages, or null when it has
  /// had the last one.
  std::function<std::shared_ptr<const std::string>(ClientId)> picture;
};

/// Serves on its own thread for the lifetime of the object. It refuses requests with another token,
/// another Host than this machine's, or another Origin than the page's. Messages, rates,
/// connections and waiting bytes are limited; a client that exceeds a limit is closed, and a slow
/// one gets fewer pictures. Connections without the token have few places, for seconds, and cannot
/// take those of clients.
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

  // These may be called from any thread:
  void send(ClientId to, std::shared_ptr<const std::string> message, bool binary = false);
  void send_to_all(std::shared_ptr<const std::string> message);
  /// Announces a picture that clients do not have yet.
  void picture_changed();

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// Returns 128 random bits as 32 hexadecimal digits. Throws RunError when the machine has no random
/// source.
std::string random_token();

/// Compares in a time that depends only on the lengths.
bool equal_in_constant_time(std::string_view a, std::string_view b);

}  // namespace caplet::view
