// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Undoable changes of a live scene.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "lower/live_scene.h"
#include "scene/edit_log.h"
#include "view/hidden.h"
#include "view/messages.h"
#include "view/parts.h"
#include "view/redraw.h"

namespace caplet::view {

/// Changes a scene, each time completely or not at all, and records an unlimited undo history.
/// Moves of the camera that shows it are no changes; a new film size or camera of the document is
/// one, but of the document only.
class Editor {
 public:
  /// `live` must outlive this, and only this may change it (except for its view). It was read from
  /// `files`.
  explicit Editor(LiveScene& live, SceneFiles files = {})
      : live_(live), view_(live.scene().view), files_(std::move(files)) {}

  /// Throws InputError when the thing does not exist or validate() would refuse the result.
  /// `goes_on`: merges the change with the one before if both affect the same things.
  void make(const Change& change, bool goes_on = false);
  /// Ends the merging of changes: undo can return to this state.
  void end_gesture() { log_.end_gesture(); }
  /// Return false when there is nothing to undo, or to redo.
  bool undo() {
    return log_.undo([this](const Step& step) { return take(step); });
  }
  bool redo() {
    return log_.redo([this](const Step& step) { return take(step); });
  }
  bool can_undo() const { return log_.can_undo(); }
  bool can_redo() const { return log_.can_redo(); }

  /// Returns a number for the scene's state: 0 at first. Undoing later changes gives the same
  /// number again.
  std::uint64_t state() const { return log_.state(); }
  /// Notes that the present state is saved. Later changes do not merge with earlier ones.
  void mark_saved() {
    log_.mark_saved();
    log_.end_gesture();
  }
  bool has_unsaved() const { return log_.has_unsaved(); }
  /// Returns how to reach the saved state: by undo (false), by redo (true), or no value if it is
  /// lost.
  std::optional<bool> way_to_saved() const { return log_.way_to_saved(); }

  /// Returns the files that the scene was read from, with the options that it is drawn with now.
  const SceneFiles& files() const { return files_; }
  /// Returns the hidden things, listed as shapes, then instances.
  const Hidden& hidden() const { return *hidden_; }
  /// Returns the settings that the scene itself is rendered with, independent of the present view.
  const View& view() const { return view_; }
  /// Makes the camera and the clipping plane of a view that is saved the document's. That is no
  /// change, and undoing others leaves them.
  void adopt_camera(const View& saved) {
    view_.camera = saved.camera;
    view_.clip = saved.clip;
  }
  /// Returns the scene to save: with hidden things, and with its own view.
  Scene document() const;
  /// Returns what the last change made: numbers of things, or the index of a part.
  const std::vector<std::uint32_t>& made() const { return made_; }

  /// Count all changes so far, including undone ones: those that alter the described scene
  /// (rearrangements), and of these, those that renumber things (renumberings).
  std::uint64_t rearrangements() const { return rearrangements_; }
  std::uint64_t renumberings() const { return renumberings_; }
  /// Counts the changes of the document's camera.
  std::uint64_t camera_changes() const { return camera_changes_; }

 private:
  /// A step is an edit in place or a change of the whole scene. Making it returns the step that
  /// undoes it.
  using InPlace = std::vector<SceneEdit>;
  struct Rearrange {
    std::function<Rearrange(Scene&, HiddenPointer&)> work;
    HiddenPointer hidden = {};                // for undo: the things that were hidden
    std::optional<FileOptions> options = {};  // that the files are then drawn with
  };
  /// Changes one part of the document's settings.
  struct Setting {
    FormSubject::Kind part = FormSubject::Kind::film;
    View to;
  };
  using Step = std::variant<InPlace, Rearrange, Setting>;

  Step step_of(const Change& change) const;
  std::optional<Step> step_of_part(const Change& change) const;
  Step redraw(const Redraw& redraw) const;
  Step set(const Set& set) const;
  Step add(const Add& add) const;
  Step hide(const Hide& hide) const;
  Step show(const Show& show) const;
  std::vector<std::uint32_t> made_by(const Change& change) const;
  Step take(const Step& step);
  Step take_setting(const Setting& setting);
  static bool have_same_places(const Step& a, const Step& b);

  LiveScene& live_;
  HiddenPointer hidden_ = std::make_shared<const Hidden>();
  View view_;
  SceneFiles files_;
  std::vector<std::uint32_t> made_;
  EditLog<Step> log_;
  std::uint64_t states_ = 0, rearrangements_ = 0, renumberings_ = 0, camera_changes_ = 0;
};

/// Returns a shape of the world by number. Throws InputError if it does not exist or is an
/// instance.
std::uint32_t world_shape(const Scene& scene, std::uint32_t id);

}  // namespace caplet::view
