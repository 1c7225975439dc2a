// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet view`: a scene, live, for the pages of a server.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "device/device.h"
#include "lower/live_scene.h"
#include "view/keep.h"
#include "view/server.h"

namespace caplet::view {

struct ViewerOptions {
  ServerOptions server;
  bool read_only = false;                          // changes are refused
  int samples = 0;                                 // of every pixel, at which the picture is done; 0: the scene's own
  double coarse_seconds = 0.08;                    // of the first picture of a view, about
  double step_seconds = 0.5;                       // between two pictures, about
  std::size_t batch_paths = std::size_t{1} << 15;  // questions are answered between batches
};

/// Renders on a thread of its own: the view that was asked for last, coarsely at first, then in full, then sample by sample until
/// it is done or nobody sees it. What pixels show is answered between batches of paths. A new view ends the picture under way.
class Viewer {
 public:
  /// `keeper`: of the scene's file, from whose base() the scene is; null: nothing is saved or kept. Changes that it has of an
  /// earlier session are made again. Throws RunError when the device or the address is of no use.
  Viewer(LiveScene scene, const Device& device, const ViewerOptions& options, std::unique_ptr<Keeper> keeper = {});
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  std::string address() const;
  std::uint16_t port() const;
  /// Waits a little, and throws what ended the rendering, if anything has.
  void wait(double seconds);
  /// Ends the session. Where changes stay that are not saved: the file in which they are kept.
  std::optional<std::filesystem::path> end();

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace caplet::view
