// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The history of a scene that changes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace caplet {

/// Records the steps that lead from one state of a scene to the next. A state is a number: no two
/// states of a log share one.
template <class Step>
class EditLog {
 public:
  struct Entry {
    Step step;
    std::uint64_t state = 0;  // after the step
  };

  /// `origin`: the state before all steps.
  explicit EditLog(std::uint64_t origin = 0) : origin_(origin), saved_(origin) {}

  std::uint64_t origin() const { return origin_; }
  /// Returns the present state. Undoing later steps gives the same number again.
  std::uint64_t state() const { return done_.empty() ? origin_ : done_.back().state; }
  std::size_t size() const { return done_.size(); }

  /// Records a step that has led to a new state. Undone steps are forgotten.
  void add(Step step, std::uint64_t state) {
    undone_.clear();
    ends_here_ = false;
    done_.push_back({std::move(step), state});
  }
  /// Returns the step that a step of the same gesture may be merged with; null if there is none.
  const Step* open() const { return ends_here_ || done_.empty() ? nullptr : &done_.back().step; }
  /// Records that the last step now also undoes what has led to `state`.
  void merge(std::uint64_t state) {
    undone_.clear();
    done_.back().state = state;  // the existing entry undoes both
  }
  /// Ends the merging of steps: undo can return to this state.
  void end_gesture() { ends_here_ = true; }
  /// Forgets all steps. `origin`: the present state.
  void restart(std::uint64_t origin) { *this = EditLog(origin); }

  bool can_undo() const { return !done_.empty(); }
  bool can_redo() const { return !undone_.empty(); }
  // `take` makes a step and returns the one that reverts it. Return false when there is nothing to
  // undo, or to redo.
  template <class Take>
  bool undo(Take&& take) {
    return go(done_, undone_, take);
  }
  template <class Take>
  bool redo(Take&& take) {
    return go(undone_, done_, take);
  }

  /// Notes that the present state is saved.
  void mark_saved() { saved_ = state(); }
  bool has_unsaved() const { return state() != saved_; }
  /// Returns how to reach the saved state: by undo (false), by redo (true), or no value if it is
  /// lost.
  std::optional<bool> way_to_saved() const {
    if (saved_ == origin_ || after(done_, saved_) != done_.end()) return false;
    return after(undone_, saved_) != undone_.end() ? std::optional(true) : std::nullopt;
  }

  /// Returns the steps that have led from that state to the present one; no value if they are not
  /// known.
  std::optional<std::span<const Entry>> since(std::uint64_t state) const {
    if (state == origin_) return std::span(done_);
    const auto found = after(done_, state);
    if (found == done_.end()) return std::nullopt;
    return std::span(found + 1, done_.end());
  }

 private:
  using Entries = std::vector<Entry>;

  static typename Entries::const_iterator after(const Entries& of, std::uint64_t state) {
    return std::ranges::find(of, state, &Entry::state);
  }
  template <class Take>
  static bool go(Entries& from, Entries& to, Take& take) {
    if (from.empty()) return false;
    Entry back{take(from.back().step), from.back().state};
    from.pop_back();
    to.push_back(std::move(back));
    return true;
  }

  std::uint64_t origin_, saved_;
  Entries done_, undone_;
  bool ends_here_ = false;
};

}  // namespace caplet
