// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Distributes the samples of a picture in parts to workers of different speeds. It does not depend
// on devices or threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "film/film.h"
#include "film/sample_plan.h"

namespace caplet {

/// Speed is the paths a second of a worker; the last parts have the most weight.
class Speed {
 public:
  /// Returns 0 if it is not known.
  double paths_a_second() const { return seconds_ > 0 ? paths_ / seconds_ : 0; }
  void measured(double paths, double seconds);

 private:
  double paths_ = 0, seconds_ = 0;
};

/// A part takes about half of the time that its worker would need if all that is open were shared
/// by speed: parts get smaller towards the end, so that all workers finish at the same time. A part
/// takes at least the first number of seconds, since smaller ones cost more than they gain, and at
/// most the second, since films only contain finished parts.
inline constexpr double least_part_seconds = 0.02, most_part_seconds = 1;

/// Work is samples of a window, or, where there are `samples`, the next ones of `count` of their
/// pixels from number `first` on.
struct Work {
  FilmPart part;
  std::shared_ptr<const PixelSamples> samples;
  std::size_t first = 0, count = 0;
  bool again = false;  // a lost worker had done it: it is done even if no more is begun

  double paths() const;
};

/// Returns the paths for a worker with `speed` of `all_speed` when `open` paths are left.
double part_paths(double open, double speed, double all_speed);

/// Cuts some `paths` paths off the front of `from`, in samples of the whole window or in rows of
/// its first sample, and returns them; `rest`: what is left. `most_samples`: of a pixel, in the
/// returned part. Of listed pixels the first ones are cut off, with all of their samples.
FilmPart cut_part(const FilmPart& from, double paths, std::uint32_t most_samples,
                  std::vector<FilmPart>& rest);

Work cut_work(const Work& from, double paths, std::uint32_t most_samples, std::vector<Work>& rest);

class WorkQueue {
 public:
  struct Worker {
    Speed speed;
    std::size_t batch_paths = 1;     // what it takes as long as its speed is not known
    std::uint32_t most_samples = 1;  // of a pixel in one part
    bool there = true;               // not lost
    std::optional<Work> under_way{};
  };

  /// Distributes samples [begin, begin + count) of every pixel of `window`, after the parts that
  /// must be done `again`.
  WorkQueue(const Window& window, std::uint32_t begin, std::uint32_t count, std::vector<Work> again,
            std::vector<Worker> workers);
  /// Distributes these samples likewise.
  WorkQueue(std::vector<PixelSamples> samples, std::vector<Work> again,
            std::vector<Worker> workers);

  /// Returns the next part for a worker, which has none under way. Returns nothing if there is none
  /// for it now; there may be one when others are lost.
  std::optional<Work> take(std::size_t worker);
  /// Records that the worker has finished its part, in so many seconds.
  void done(std::size_t worker, double seconds);
  /// Records that the worker is gone, with its part and everything that it has done: `had`, the
  /// latter, must be done again.
  void lose(std::size_t worker, std::span<const Work> had);
  /// Begins no more samples: only the rest of those that are begun remains to be done, and of
  /// listed pixels nothing.
  void close();

  /// Returns whether nothing is open or under way.
  bool complete() const;
  std::size_t workers_there() const;
  const Speed& speed(std::size_t worker) const { return workers_[worker].speed; }
  /// Returns what is neither done nor under way.
  const std::deque<Work>& open() const { return open_; }
  /// Returns the samples of every pixel of the window that are done once this is complete.
  std::uint32_t samples() const { return end_ - begin_; }
  /// Returns whether any sample of this picture has been handed out.
  bool begun() const { return list_begun_ || begun_end_ > begin_; }
  /// Returns the finished paths, without those of earlier samples.
  double paths_done() const { return paths_done_; }

 private:
  double open_paths() const;
  void open_again(std::vector<Work> again);
  double new_paths(const Work& work) const;  // those that are not of earlier samples
  std::uint32_t begin_, end_, begun_end_;
  std::vector<std::shared_ptr<const PixelSamples>> lists_;  // of these samples
  bool list_begun_ = false;
  std::deque<Work> open_;  // by sample
  std::vector<Worker> workers_;
  double paths_done_ = 0;
};

}  // namespace caplet
