// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Changes with what is kept of them: made, saved, taken back, made again at the next start.
#pragma once

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
  /// Makes again what `keeper` has of an earlier session. Both scenes outlive this. Without a keeper nothing is kept, nor saved.
  Keeping(LiveScene& live, Editor& editor, std::unique_ptr<Keeper> keeper);

  /// Makes an Edit, an Undo, a Discard or what a Kept asks for; `text`: as it was said. Whether the scene is another one now.
  /// Throws InputError.
  bool make(const Message& message, const std::string& text);
  /// Saves with the scene's own camera and film, or with that camera. A message: `saved`, or `save_asks` when the file holds what
  /// would be lost. Throws InputError and RunError.
  nlohmann::ordered_json save(const Save& save, const Look& look, const std::function<bool()>& cancelled);
  /// A picture is there: the processor may do other things for a moment.
  void pause() {
    if (keeper_) keeper_->look_at_contents();
  }
  /// What the page is told: whether there are unsaved changes, whether they are kept, what was there from an earlier session.
  nlohmann::ordered_json text() const;
  /// The camera and the size that the scene is saved with.
  const Look& own_look() const { return own_; }
  bool has_unsaved() const { return editor_.state() != saved_; }
  /// The journal, when changes stay in it.
  std::optional<std::filesystem::path> end();

 private:
  bool change(const Message& message);
  bool make_line(const std::string& line);
  std::size_t make_lines(const std::vector<std::string>& lines);

  Editor& editor_;
  std::unique_ptr<Keeper> keeper_;
  Look own_;
  bool own_is_new_ = false;   // it was saved with another camera than it came with
  std::uint64_t saved_ = 0;   // state of the editor
  std::size_t restored_ = 0;  // changes of an earlier session
};

}  // namespace caplet::view
