// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Who renders what: the samples of a picture, handed out in parts to workers of different speeds. Knows no device and no thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "film/film.h"

namespace caplet {

/// Paths a second of a worker, of which the last parts say most.
class Speed {
 public:
  /// 0: not known.
  double paths_a_second() const { return seconds_ > 0 ? paths_ / seconds_ : 0; }
  void measured(double paths, double seconds);

 private:
  double paths_ = 0, seconds_ = 0;
};

/// A part takes about half of what would be left for its worker, were all that is open shared by speed: the nearer the end, the
/// smaller the parts, so that all are done at the same time. It takes so many seconds at least, since smaller ones cost more than
/// they level, and at most, since films tell of finished parts alone.
inline constexpr double least_part_seconds = 0.02, most_part_seconds = 1;

/// For a worker with `speed` of `all_speed` when `open` paths are left.
double part_paths(double open, double speed, double all_speed);

/// Cuts some `paths` paths off the front of `from`, in samples of the whole window or in rows of its first sample, and returns
/// them; `rest`: what is left. `most_samples`: of a pixel, in what is cut off.
FilmPart cut_part(const FilmPart& from, double paths, std::uint32_t most_samples, std::vector<FilmPart>& rest);

class Shares {
 public:
  struct Worker {
    Speed speed;
    std::size_t batch_paths = 1;     // what it takes as long as its speed is not known
    std::uint32_t most_samples = 1;  // of a pixel in one part
    bool there = true;               // not lost
    std::optional<FilmPart> under_way{};
  };

  /// Samples [begin, begin + count) of every pixel of `window`, after what is to be done `again`.
  Shares(const Window& window, std::uint32_t begin, std::uint32_t count, std::vector<FilmPart> again,
         std::vector<Worker> workers);

  /// The next part for a worker, which has none under way. Nothing: there is none for it now; there may be when others are lost.
  std::optional<FilmPart> take(std::size_t worker);
  /// It has finished its part, in so many seconds.
  void done(std::size_t worker, double seconds);
  /// The worker is gone, with its part and all that it has done: `had`, the latter, is to be done again.
  void lose(std::size_t worker, std::span<const FilmPart> had);
  /// No sample is begun any more: what is still to be done is the rest of those that are.
  void close();

  /// Whether nothing is open or under way.
  bool complete() const;
  std::size_t workers_there() const;
  const Speed& speed(std::size_t worker) const { return workers_[worker].speed; }
  /// What is neither done nor under way.
  const std::deque<FilmPart>& open() const { return open_; }
  /// Of every pixel, that are done once this is complete.
  std::uint32_t samples() const { return end_ - begin_; }
  /// Whether any sample of this picture has been handed out.
  bool begun() const { return begun_end_ > begin_; }
  /// Finished paths of samples from `begin` on.
  double paths_done() const { return paths_done_; }

 private:
  double open_paths() const;
  double new_paths(const FilmPart& part) const;  // those from `begin` on
  std::uint32_t begin_, end_, begun_end_;
  std::deque<FilmPart> open_;  // by sample
  std::vector<Worker> workers_;
  double paths_done_ = 0;
};

}  // namespace caplet
