// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A session renders one film on one or several devices, of a scene that may change.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "device/device.h"
#include "film/film.h"
#include "film/sample_plan.h"
#include "lower/changes.h"
#include "lower/flat_scene.h"
#include "render/device_scene.h"
#include "render/renderer.h"

namespace caplet {

struct Work;

struct SessionOptions {
  std::uint32_t sample_begin = 0;  // the first that is rendered of every pixel
  Layers layers = Layers::usual();
  std::uint32_t pass_samples =
      0;  // of every pixel, that a device takes at a time at most; 0: by its speed
  std::size_t batch_paths = 0;  // 0: chosen for each device
  std::uint32_t most_samples =
      0;  // of every pixel that will be rendered, for small batches of small renders; 0: unknown
  bool time_stages = false;  // wait for each stage and add up its seconds
  double patience = 60;      // seconds that a device may take for an answer, where there are others
  std::size_t look_bytes = 8 << 20;  // of a film, that look_at_film reads at a time
};

struct SessionProgress {
  std::uint32_t samples_done = 0;  // of every pixel, by all devices; the mean of listed pixels
  std::uint32_t sample_count = 0;  // asked for; 0 for listed pixels
  double fraction = 0;             // of all paths, those of batches that are done counted
  double samples_per_second = 0;   // of all pixels
};

/// DeviceWork is what a device of a session has done.
struct DeviceWork {
  std::string name, driver, platform;
  double paths = 0, paths_a_second = 0;  // in the film; lately
  bool lost = false;                     // failed or hung: others have its work
};

/// Returns the names of a device that has done nothing yet.
DeviceWork work_of(const DeviceInfo& info);

using StageSeconds = std::vector<std::pair<std::string, double>>;

/// Devices take samples from a common list until there are no more, by their measured speed, so
/// that all finish at the same time. The result does not depend on which device did what, on their
/// number or on their speed, as long as they compute alike (devices of one kind do). A device that
/// fails, or gives no answer for `patience` seconds, is left out with a warning. Its work, which is
/// lost with its film, is done again by the others; the last one's failure is the session's.
class Session {
 public:
  /// Sends the scene to every device and compiles. Throws RunError when no device can do it.
  Session(const FlatScene& scene, const FlatView& view, const std::vector<Device>& devices,
          const SessionOptions& options);
  /// Does the same, and gives back the memory of the scene's nodes and leaves, which are empty
  /// then.
  Session(FlatScene&& scene, const FlatView& view, const std::vector<Device>& devices,
          const SessionOptions& options);
  ~Session();

  /// Switches to the scene as it now is, which differs from the last one in `changes`, and to a
  /// view of it. The film is empty again, and begins at the first sample. Throws RunError.
  void update(const FlatScene& scene, const SceneChanges& changes, const FlatView& view);

  /// Empties the film, whose first sample will be `sample`.
  void begin_at(std::uint32_t sample);

  /// Begins with the samples of `film`, and goes on after the last of them. Throws InputError when
  /// it is not of this scene's layout.
  void resume(Film film);

  /// Adds the next `sample_count` samples of every pixel (of pixels with different numbers: the
  /// next of each, all of them or as when lists are stopped, which returns 0), on a thread a device
  /// (a device alone: on this one), and returns how many of them were finished: fewer when it is
  /// cancelled, or its time limit (seconds) is over, which some are always begun before. Samples
  /// that are begun are finished for every pixel. `progress`, when there is one, is called from
  /// these threads, one at a time, after each batch; what it throws ends the render after the
  /// batches under way, and is thrown. Throws RunError when the last device fails. After either the
  /// film is empty.
  std::uint32_t render(std::uint32_t sample_count,
                       const std::function<void(const SessionProgress&)>& progress = {},
                       std::optional<double> time_limit = {});

  /// Adds these samples, which the pixels do not have yet, likewise, and returns whether all of
  /// them were finished. When it is stopped, parts that are begun are finished, and other pixels
  /// have none of their samples. The film is that of samples up to the last of any pixel.
  bool render(std::vector<PixelSamples> samples,
              const std::function<void(const SessionProgress&)>& progress = {},
              std::optional<double> time_limit = {});

  /// Returns the sum of all films. A device that fails now is left out as well, and its work is
  /// rendered again. Throws RunError.
  Film film();
  /// Calls `look` with all of its rows, some at a time where it lies on one device: that takes less
  /// time and memory. Where a device fails, it is called again. Throws RunError.
  void look_at_film(const std::function<void(const Film& rows)>& look);
  /// Returns the samples that are in it; where pixels have different numbers, up to the last of
  /// any.
  std::vector<FilmPart> parts() const;
  /// Returns the same if it lies on one device as a whole: nothing when there are others, or
  /// samples that it was resumed with.
  std::optional<DeviceFilm> film_on_device() const;
  FilmLayout layout() const;
  /// Returns how many samples of every pixel its film has, those before its own among them; where
  /// pixels have different numbers, the largest that any may have.
  std::uint32_t samples() const { return next_ - options_.sample_begin; }
  /// Returns whether all pixels have as many.
  bool is_even() const { return !has_lists_; }

  /// Stops the render under way after the samples that are begun; if there is none, stops the next
  /// one. It may be called from any thread, and from a progress function.
  void cancel() { *cancelled_ = true; }

  /// Returns the work of all devices that were there in the beginning; the functions below count
  /// only those that are there now.
  std::vector<DeviceWork> work() const;
  RayCounts rays() const;
  double compile_seconds() const;
  StageSeconds compile_seconds_by_stage() const, seconds_by_stage() const;

  /// These are the devices that are there now, and the scene on them, for queries while nothing is
  /// rendered.
  std::size_t device_count() const { return workers_.size(); }
  const Device& device(std::size_t number) const;
  std::shared_ptr<DeviceScene> scene_on(std::size_t device) const;

 private:
  struct Worker;
  struct Run;
  Session(const FlatView& view, const std::vector<Device>& devices, const SessionOptions& options,
          const std::function<std::shared_ptr<DeviceScene>(const Device&)>& scene_for);
  using Workers = std::vector<std::shared_ptr<Worker>>;
  void clear();
  void part_with(const Workers& gone, const std::exception_ptr& last_failure);
  /// Asked is samples of every pixel, or those of lists.
  struct Asked {
    std::uint32_t samples = 0;
    std::vector<PixelSamples> lists{};
  };
  std::shared_ptr<Run> run(Asked asked, const std::function<void(const SessionProgress&)>& progress,
                           std::optional<double> time_limit);
  /// Calls `read` with each worker's number and film. Returns false when one of them failed.
  bool read_films(const std::function<void(std::size_t, const DeviceFilm&)>& read);
  std::optional<Film> gather();

  SessionOptions options_;
  Workers workers_;
  std::vector<DeviceWork> lost_;
  std::vector<Work> again_;     // what was lost with devices and is in no film now
  std::optional<Film> before_;  // what it was resumed with
  std::uint32_t first_,
      next_;  // the samples that its devices have rendered: up to, and without, the latter
  bool has_lists_ = false;  // pixels may have different numbers of samples
  std::shared_ptr<std::atomic<bool>> cancelled_ = std::make_shared<std::atomic<bool>>(false);
};

/// Returns whether a thread of a session that hangs in a driver was abandoned, and has not come
/// back: a program then ends without the destructors of static objects, which such a thread may
/// still use.
bool any_thread_given_up();

}  // namespace caplet
