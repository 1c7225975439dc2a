// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A picture that grows, shown by tev (https://github.com/Tom94/tev) while it is rendered: packets over TCP, each its length of 32
// bits, its kind of 8, and what the kind has, little-endian (tev's README, "Over the Network").
#pragma once

#include <memory>
#include <string>

#include "film/image.h"

namespace caplet {

/// Where tev listens.
struct TevAddress {
  std::string host, port;
};
/// "HOST:PORT", "[::1]:PORT", or a port alone, of this machine. Throws InputError naming `flag`.
TevAddress parse_tev_address(const std::string& text, const std::string& flag);

/// Sends pictures on a thread of its own. Nothing here waits for tev but finish(): of pictures that it is too slow for the newest
/// alone is kept, and where it is not there, or goes, a warning says so once and nothing more is sent.
class TevDisplay {
 public:
  /// `name`: what tev calls the picture. Throws InputError when there is no such host.
  TevDisplay(const TevAddress& address, const std::string& name);
  /// Gives up what is not sent.
  ~TevDisplay();
  TevDisplay(const TevDisplay&) = delete;
  TevDisplay& operator=(const TevDisplay&) = delete;

  /// Whether a picture would be sent now: none waits, and tev is there as far as is known.
  bool is_idle() const;
  /// The picture as it now is: of it, the tiles that have changed are sent. All have the same windows and channels.
  void show(LayeredImage image);
  /// Waits until all is sent, for so many seconds at most; a warning tells when it is not.
  void finish(double seconds);

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace caplet
