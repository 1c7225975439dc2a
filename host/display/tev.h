// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Shows a picture in tev (https://github.com/Tom94/tev) while it is rendered. Packets over TCP have
// a length of 32 bits, a kind of 8 bits, and data, little-endian (tev's README, "Over the
// Network").
#pragma once

#include <memory>
#include <string>

#include "film/image.h"

namespace caplet {

/// The address at which tev listens.
struct TevAddress {
  std::string host, port;
};
/// Parses "HOST:PORT", "[::1]:PORT", or only a port of this machine. Throws InputError that names
/// `flag`.
TevAddress parse_tev_address(const std::string& text, const std::string& flag);

/// Sends pictures on its own thread. Only finish() waits for tev. If tev is too slow, only the
/// newest picture is kept; if it is missing or disconnects, there is one warning and nothing more
/// is sent.
class TevDisplay {
 public:
  /// `name`: the picture's name in tev. Throws InputError when the host does not exist.
  TevDisplay(const TevAddress& address, const std::string& name);
  /// Discards what was not sent.
  ~TevDisplay();
  TevDisplay(const TevDisplay&) = delete;
  TevDisplay& operator=(const TevDisplay&) = delete;

  /// Returns whether a picture would be sent now: none is waiting, and tev is connected as far as
  /// is known.
  bool is_idle() const;
  /// Shows the present picture by sending the tiles that have changed. All pictures have the same
  /// windows and channels.
  void show(LayeredImage image);
  /// Waits until all is sent, for at most so many seconds, and then warns.
  void finish(double seconds);

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace caplet
