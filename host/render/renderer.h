// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is the host side of the wavefront path tracer: it renders passes over windows and samples of
// a view into a film on the device.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "device/device.h"
#include "film/film.h"
#include "lower/flat_scene.h"
#include "render/buffers.h"
#include "render/device_scene.h"
#include "render/kernels.h"

namespace caplet {

/// RayCounts counts what a renderer has done so far.
struct RayCounts {
  std::uint64_t camera = 0, bounce = 0, shadow = 0;
  std::uint64_t not_finite = 0;  // samples that count as black, as their radiance was not a number
};

/// DeviceFilm is a film in a device's memory, which copies share: in one buffer, or in several of
/// so many rows each where the device allows none of its size.
struct DeviceFilm {
  std::vector<Buffer<ulong>> words;
  int rows_of_buffer = 0;
  FilmLayout layout;
  std::vector<FilmPart> parts;

  /// Returns all of it, or `rows` of its rows from `first` on. Throws RunError.
  Film read() const { return read(0, layout.window.height); }
  Film read(int first, int rows) const;
};

struct RendererOptions {
  Layers layers = Layers::usual();    // of the film: each takes memory and time
  std::size_t batch_paths = 0;        // most paths under way at a time; 0: chosen for the device
  std::size_t most_paths = SIZE_MAX;  // that a pass will have, for small renders
};

class Renderer {
 public:
  /// Renders `scene`, which must outlive this, as `view` shows it. Compiles the stages that are not
  /// compiled yet. Throws RunError.
  Renderer(DeviceScene& scene, const FlatView& view, const RendererOptions& options = {});

  /// Switches to another view of the scene as it now is (DeviceScene::update); the film is empty
  /// again. Compiles the stages that are not compiled yet.
  void reset(const FlatView& view);

  /// Adds samples [sample_begin, sample_begin + sample_count) of every pixel of `window`, which
  /// lies within the film's. `batch_done`, when there is one, is told the number of the window's
  /// pixels that are finished. Throws RunError, and InputError when some of these samples are in
  /// the film already.
  void pass(const Window& window, std::uint32_t sample_begin, std::uint32_t sample_count,
            const std::function<void(std::size_t)>& batch_done = {});

  /// Adds the next `sample_count` samples of each of these records (PixelSamples), which lie within
  /// the film's window. The film's parts do not tell of them. Throws RunError.
  void pass(std::span<const PixelRecord> pixels, std::uint32_t sample_count,
            const std::function<void(std::size_t)>& batch_done = {});

  /// Returns the film so far. It is valid until the next pass or reset.
  const DeviceFilm& film() const;
  const FilmLayout& layout() const { return film_.layout; }
  std::size_t batch_paths() const { return batch_paths_; }
  const RayCounts& rays() const { return rays_; }
  /// Returns a number that grows whenever the device has answered in a pass. It may be called from
  /// any thread.
  std::uint64_t beats() const { return beats_; }

 private:
  /// Returns a batch of `count` pixels with so many samples each, of no window.
  BatchRecord batch_of(std::size_t count, std::uint32_t sample_count) const;
  /// Makes the film of this layout, whose contents do not matter.
  void provide_film(const FilmLayout& layout);
  void batch(BatchRecord record, std::size_t film_buffer);
  /// These render the rounds of a batch until no path is left: the host queries the number in each
  /// round, or launches several rounds at a time for the most paths there may be.
  void rounds_by_host(Bindings& bindings, std::size_t paths);
  void rounds_on_device(Bindings& bindings, std::size_t paths);
  /// Launched is how many work-items a stage has: `count`, or fewer where the counter says so.
  struct Launched {
    std::size_t count;
    cl_uint counter = CAPLET_NONE;
  };
  void trace_and_shade(Bindings& bindings, Stage extend, std::size_t paths, cl_uint counter);
  void connect_and_sort(Bindings& bindings, Launched shadows, Launched next);
  void sort(const Bindings& bindings, Launched paths);
  void clear_film() const;
  /// Returns the number of the film's buffer that has a row of the picture.
  std::size_t film_buffer(int row) const {
    return static_cast<std::size_t>((row - film_.layout.window.y) / film_.rows_of_buffer);
  }

  DeviceScene& scene_;
  std::size_t batch_paths_;
  Layers layers_;
  PathBuffers paths_;
  std::uint32_t sort_bits_;
  bool origins_differ_ = false;  // of camera rays
  bool has_clip_ = false;
  struct {
    Stage extend_camera, extend, shade, connect;
  } stages_{};         // those of a round, of this scene
  std::size_t chunk_;  // Kernels::set_chunk
  SensorBuffers sensor_;
  mutable DeviceFilm film_;
  mutable bool is_old_ = true;  // the film's words are those of before a reset: they count as zeros
  RayCounts rays_;
  std::atomic<std::uint64_t> beats_{0};
};

/// Returns the bytes of the state of the smallest batch of paths, with all layers, that a render
/// takes on a device without room for more.
std::uint64_t least_batch_bytes();

}  // namespace caplet
