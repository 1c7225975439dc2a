// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Changes of a live scene that can be taken back.
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

/// Makes changes of a scene, each as a whole or not at all, and keeps what takes them back, without a limit. The camera is no
/// change; the film's size is one, and of the document alone.
class Editor {
 public:
  /// `live` must outlive this, and be changed (but for its view) by this alone.
  explicit Editor(LiveScene& live) : live_(live), view_(view_of(live.scene())) {}

  /// Throws InputError when there is no such thing, or when validate() would refuse what is to stand there.
  /// `goes_on`: with the change before, as one, where that is of the same places.
  void make(const Change& change, bool goes_on = false);
  /// What goes on from here is a change of its own: this state can be come back to.
  void end_gesture() { ends_here_ = true; }
  /// False when there is nothing to take back, or to make again.
  bool undo() { return go(done_, undone_); }
  bool redo() { return go(undone_, done_); }
  /// Names the state that the scene is in: 0 in the beginning, and again the same number when what was changed since is taken
  /// back.
  std::uint64_t state() const { return done_.empty() ? 0 : done_.back().state; }
  /// How that state is got to: by undo (false), by redo (true), or not any more.
  std::optional<bool> way_to(std::uint64_t state) const;
  bool can_undo() const { return !done_.empty(); }
  bool can_redo() const { return !undone_.empty(); }

  /// What is hidden: shapes, then instances, are its list.
  const Hidden& hidden() const { return *hidden_; }
  /// How the scene itself is rendered, whatever is looked at now.
  const ViewEdit& view() const { return view_; }
  /// The scene as it is to be kept: with what is hidden, and its own view.
  Scene document() const;
  /// What the last change made: things by their numbers, or a part by its index.
  const std::vector<std::uint32_t>& made() const { return made_; }

  /// Changes so far, those taken back included, of what is told of the scene (rearrangements), and of those such that give things
  /// other numbers (renumberings).
  std::uint64_t rearrangements() const { return rearrangements_; }
  std::uint64_t renumberings() const { return renumberings_; }

 private:
  /// In place, or of the scene as a whole. Doing it gives what takes it back.
  using InPlace = std::vector<SceneEdit>;
  struct Rearrange {
    std::function<Rearrange(Scene&, HiddenPointer&)> work;
    HiddenPointer hidden = {};  // of what takes back: what was hidden
  };
  using Step = std::variant<InPlace, Rearrange, ViewEdit>;

  struct Done {
    Step step;                // what takes back, or makes again
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

/// A shape of the world by its number. Throws InputError when it is none, or an instance.
std::uint32_t world_shape(const Scene& scene, std::uint32_t id);

}  // namespace caplet::view
