// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Makes and undoes changes, saves them, and replays them at the next start.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "view/editor.h"
#include "view/keep.h"
#include "view/messages.h"

namespace caplet::view {

class Keeping {
 public:
  /// Replays the changes of an earlier session that `keeper` has. Both scenes outlive this. Without
  /// a keeper nothing is kept.
  Keeping(LiveScene& live, Editor& editor, std::unique_ptr<Keeper> keeper);

  /// Handles an Edit, Undo, Discard or Kept; `text` is the message as received. Returns whether the
  /// scene has changed. Throws InputError.
  bool make(const Message& message, const std::string& text);
  /// Saves with the scene's own camera and film, or with that camera. Returns the message `saved`,
  /// or `save_asks` when data in the file would be lost. Throws InputError and RunError.
  nlohmann::ordered_json save(const Save& save, const ShowView& look,
                              const std::function<bool()>& cancelled);
  /// Uses the pause after a picture for other work.
  void pause() {
    if (keeper_) keeper_->look_at_contents();
  }
  /// Returns the message on unsaved changes: whether there are any, whether they are kept, and what
  /// an earlier session left.
  nlohmann::ordered_json text() const;
  /// Returns the camera and the size that the scene is saved with.
  const ShowView& own_look() const { return own_; }
  bool has_unsaved() const { return editor_.has_unsaved(); }
  /// Returns the journal if changes remain in it.
  std::optional<std::filesystem::path> end();

 private:
  bool change(const Message& message);
  bool go(bool again);
  void follow_camera();
  void set_own(ShowView look);
  View view_of(ShowView own) const;
  bool make_line(const std::string& line);
  std::size_t make_lines(const std::vector<std::string>& lines);

  Editor& editor_;
  std::unique_ptr<Keeper> keeper_;
  ShowView own_;
  bool own_is_new_ = false;  // it was saved with a different camera
  std::uint64_t camera_changes_ = 0;
  std::size_t restored_ = 0;  // changes of an earlier session
};

}  // namespace caplet::view
