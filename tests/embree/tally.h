// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Counts of verdicts on two answers to each ray, and the worst cases of the second.
#pragma once

#include <array>
#include <mutex>
#include <string>

#include "judge.h"

namespace caplet::test {

/// What a case's errors are told in.
struct CaseFacts {
  double size = 1;          // the larger radius; of a triangle, its ball's
  bool along_axis = false;  // the ray runs along the (tapered) capsule's axis or side
  double world_bound =
      0;  // what an answer worked out in world coordinates may be off by, for comparison
};

/// How often one side was wrong.
struct Errors {
  std::uint64_t missed = 0, false_hits = 0, displaced = 0;
  std::uint64_t missed_deep = 0,
                missed_along = 0;  // of the missed: deeper than 1 % of the size; along the axis
  std::uint64_t off_1e2 = 0, t_beyond_1e3 = 0,
                t_beyond_1e2 = 0;  // of the displaced: 1 % of the size off; t off by 1e-3, 1e-2
  std::uint64_t later = 0, grazing = 0;  // of the displaced: as Judgement's
  std::uint64_t beyond_world = 0;        // of all wrong: by more than the world_bound
  std::uint64_t touching = 0;            // not wrong
  std::uint64_t wrong() const { return missed + false_hits + displaced; }
  void add(const Judgement& judgement, const CaseFacts& facts);
};

class Tally {
 public:
  /// Safe to call from many threads. `where` describes the case; it is called for cases that are
  /// kept.
  template <class Describe>
  void add(const Judge& judge, const Judgement& ours, const Judgement& embree,
           const CaseFacts& facts, const Describe& where) {
    const std::lock_guard lock(mutex_);
    ++rays;
    hits += judge.hit();
    hits_along += judge.hit() && facts.along_axis;
    our_errors.add(ours, facts);
    embree_errors.add(embree, facts);
    if (ours.wrong() && ++failures_ <= 5) report(ours, facts.size, where());
    if (!embree.wrong()) return;
    Worst& worst = worst_[static_cast<std::size_t>(embree.verdict)];
    const double error = error_of(embree, facts.size);
    if (error <= worst.error) return;
    worst = {error, text_of(embree, facts.size) + "\n" + where()};
  }
  /// A row of counts a side and the worst of each kind, to stdout.
  void print(const std::string& name) const;
  /// Share of rays on which Embree is not wrong.
  double embree_agrees() const {
    return rays == 0 ? 1
                     : 1 - static_cast<double>(embree_errors.wrong()) / static_cast<double>(rays);
  }

  std::uint64_t rays = 0, hits = 0, hits_along = 0;
  std::uint64_t left_out = 0;  // begin at a surface
  Errors our_errors, embree_errors;

 private:
  struct Worst {
    double error = 0;
    std::string text;
  };
  static double error_of(const Judgement& judgement, double size);
  static std::string text_of(const Judgement& judgement, double size);
  static void report(const Judgement& judgement, double size, const std::string& where);

  std::mutex mutex_;
  std::array<Worst, 5> worst_;
  int failures_ = 0;
};

/// To the last bit.
std::string described(const RayRecord& ray);
std::string described(const FlatPrimitive& primitive, const RayRecord& ray);

}  // namespace caplet::test
