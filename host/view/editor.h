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
#include "view/hidden.h"
#include "view/messages.h"

namespace caplet::view {

/// Changes a scene, each time completely or not at all, and records an unlimited undo history. Camera moves are no changes; a new
/// film size is one, but of the document only.
class Editor {
 public:
  /// `live` must outlive this, and only this may change it (except for its view).
  explicit Editor(LiveScene& live) : live_(live), view_(view_of(live.scene())) {}

  /// Throws InputError when the thing does not exist or validate() would refuse the result. `goes_on`: merges the change with the
  /// one before if both affect the same things.
  void make(const Change& change, bool goes_on = false);
  /// Ends the merging of changes: undo can return to this state.
  void end_gesture() { ends_here_ = true; }
  /// Return false when there is nothing to undo, or to redo.
  bool undo() { return go(done_, undone_); }
  bool redo() { return go(undone_, done_); }
  /// Returns a number for the scene's state: 0 at first. Undoing later changes gives the same number
  /// again.
  std::uint64_t state() const { return done_.empty() ? 0 : done_.back().state; }
  /// Returns how to reach that state: by undo (false), by redo (true), or no value if it is lost.
  std::optional<bool> way_to(std::uint64_t state) const;
  bool can_undo() const { return !done_.empty(); }
  bool can_redo() const { return !undone_.empty(); }

  /// Returns the hidden things, listed as shapes, then instances.
  const Hidden& hidden() const { return *hidden_; }
  /// Returns the settings that the scene itself is rendered with, independent of the present view.
  const ViewEdit& view() const { return view_; }
  /// Returns the scene to save: with hidden things, and with its own view.
  Scene document() const;
  /// Returns what the last change made: numbers of things, or the index of a part.
  const std::vector<std::uint32_t>& made() const { return made_; }

  /// Count all changes so far, including undone ones: those that alter the described scene (rearrangements), and of these, those
  /// that renumber things (renumberings).
  std::uint64_t rearrangements() const { return rearrangements_; }
  std::uint64_t renumberings() const { return renumberings_; }

 private:
  /// A step is an edit in place or a change of the whole scene. Making it returns the step that undoes it.
  using InPlace = std::vector<SceneEdit>;
  struct Rearrange {
    std::function<Rearrange(Scene&, HiddenPointer&)> work;
    HiddenPointer hidden = {};  // for undo: the things that were hidden
  };
  using Step = std::variant<InPlace, Rearrange, ViewEdit>;

  struct Done {
    Step step;                // undoes or redoes the change
    std::uint64_t state = 0;  // after the change
  };

  Step step_of(const Change& change) const;
  std::optional<Step> step_of_part(const Change& change) const;
  Step set(const Set& set) const;
  Step add(const Add& add) const;
  Step hide(const Hide& hide) const;
  Step show(const Show& show) const;
  std::vector<std::uint32_t> made_by(const Change& change) const;
  Step take(const Step& step);
  static bool have_same_places(const Step& a, const Step& b);
  bool go(std::vector<Done>& from, std::vector<Done>& to);

  LiveScene& live_;
  HiddenPointer hidden_ = std::make_shared<const Hidden>();
  ViewEdit view_;
  std::vector<std::uint32_t> made_;
  std::vector<Done> done_, undone_;
  std::uint64_t states_ = 0, rearrangements_ = 0, renumberings_ = 0;
  bool ends_here_ = false;
};

/// Returns a shape of the world by number. Throws InputError if it does not exist or is an instance.
std::uint32_t world_shape(const Scene& scene, std::uint32_t id);

}  // namespace caplet::view
