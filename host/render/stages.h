// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The device side of renders and queries: every buffer of buffers.def, and the stages of stages.def and queries.def that are
// asked for.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "device/device.h"
#include "lower/lower.h"
#include "shared/records.h"

namespace caplet {

enum class Stage {
#define STAGE(name) name,
#include "shared/queries.def"
#include "shared/stages.def"
#undef STAGE
  count
};

/// The stages of a render: those of stages.def.
std::span<const Stage> render_stages();

/// Compiler options of all stages: how traversal is shaped (Device::encoding), and which shapes it must know.
std::string stage_options(const FlatScene& scene, const Device& device);

/// Sizes of what is allocated besides the scene.
struct StateSize {
  std::size_t paths = 0, pixels = 0, sort_bins = 0;
  std::size_t query_rays = 0, query_hits = 0, picks = 0;
};

/// What `extend` and `connect` say of rays.
struct TracedPaths {
  std::vector<HitRecord> hits;  // of each ray
  std::vector<bool> free;       // each shadow ray
};

class Stages {
 public:
  /// Uploads the scene and allocates the state. `options`: see stage_options.
  Stages(const Device& device, const FlatScene& scene, const StateSize& size, const std::string& options);

  /// Compiles those that are not compiled yet, for launches of at most `most` work-items.
  void compile(std::span<const Stage> stages, std::size_t most);
  /// Makes room for a query of so many rays, hits and records; what is too small loses its contents.
  void reserve_query(std::size_t rays, std::size_t hits, std::size_t picks);
  void set_query_rays(std::span<const RayRecord> rays) { query_rays_.write(rays); }
  void set_query_begin(std::span<const uint> begin) { query_begin_.write(begin); }
  /// The first of them (blocking).
  void read_query_counts(std::span<uint> out) const { query_counts_.RawBuffer::read(out.data(), 0, out.size_bytes()); }
  void read_picks(std::span<PickRecord> out) const { picks_.RawBuffer::read(out.data(), 0, out.size_bytes()); }

  /// Runs `extend` over rays and `connect` over shadow rays, at most as many of each as there are paths. Both are compiled.
  TracedPaths trace(std::span<const RayRecord> rays, std::span<const RayRecord> shadows);

  void set_params(const ParamsRecord& params);
  /// Enqueues a stage over `count` work-items. With timing on, waits for it and adds its seconds.
  void run(Stage stage, std::size_t count);
  /// Sets a counter (blocking).
  void set_counters(const std::array<uint, 4>& values);
  std::array<uint, 4> counters() const;
  void clear_sort_bins(std::size_t bins);
  /// What was queue_next becomes queue, unsorted.
  void swap_queues();
  const Buffer<FilmRecord>& film() const { return film_; }

  void time_stages(bool on) { timed_ = on; }
  /// Seconds each stage took so far, when timing is on.
  std::vector<std::pair<std::string, double>> seconds_by_stage() const;

  double compile_seconds() const { return compile_seconds_; }
  const std::vector<std::pair<std::string, double>>& compile_seconds_by_stage() const { return by_stage_; }

 private:
  std::size_t local_size_of(Stage stage) const;
  void set_buffers(cl::Kernel& kernel) const;

  Device device_;
  std::string options_;
#define BUFFER(name, type, access) Buffer<type> name##_;
#include "shared/buffers.def"
#undef BUFFER
  struct Compiled {
    Program program;
    cl::Kernel kernel;
    double seconds = 0;  // it ran
  };
  std::array<std::optional<Compiled>, static_cast<std::size_t>(Stage::count)> compiled_;
  bool timed_ = false;
  std::size_t local_size_ = 1;
  bool swapped_ = false;
  double compile_seconds_ = 0;
  std::vector<std::pair<std::string, double>> by_stage_;
};

}  // namespace caplet
