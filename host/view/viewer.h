// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet view`: serves a live scene to pages.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "device/device.h"
#include "lower/live_scene.h"
#include "view/keep.h"
#include "view/viewer_options.h"

namespace caplet::view {

/// Renders the latest requested view on its own thread: coarsely at first, then in full, then with
/// more samples until it is done or no page is visible. Queries are answered between batches of
/// paths. A new view ends the picture in progress.
class Viewer {
 public:
  /// `keeper` belongs to the scene's file, and `scene` was read from its base(); null: nothing is
  /// saved or kept. Changes that it has from an earlier session are replayed. Throws RunError when
  /// the device or the address cannot be used.
  Viewer(LiveScene scene, const Device& device, const ViewerOptions& options,
         std::unique_ptr<Keeper> keeper = {});
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  std::string address() const;
  std::uint16_t port() const;
  /// Waits a short time, and throws the error that has ended rendering, if any.
  void wait(double seconds);
  /// Ends the session. Returns the journal if there are unsaved changes.
  std::optional<std::filesystem::path> end();

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace caplet::view
