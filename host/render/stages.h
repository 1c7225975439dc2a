// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The device side of a render: every buffer of buffers.def and a compiled kernel for every stage of stages.def.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "device/device.h"
#include "lower/lower.h"
#include "shared/records.h"

namespace caplet {

enum class Stage {
#define STAGE(name) name,
#include "shared/stages.def"
#undef STAGE
  count
};

/// Sizes of what a render allocates besides the scene.
struct WavefrontSize {
  std::size_t paths = 0, pixels = 0, sort_bins = 0;
};

class Stages {
 public:
  /// Uploads the scene, allocates the state and compiles all stages. `options` are compiler options common to all.
  Stages(const Device& device, const FlatScene& scene, const WavefrontSize& size, const std::string& options, bool cpu);

  void set_params(const ParamsRecord& params);
  /// Enqueues a stage over `count` work-items. With timing on, waits for it and adds its seconds.
  void run(Stage stage, std::size_t count);
  /// Sets a counter (blocking).
  void set_counters(const std::array<uint, 4>& values);
  std::array<uint, 4> counters() const;
  void clear_sort_bins(std::size_t bins);
  /// What was queue_next becomes queue, unsorted.
  void swap_queues();
  std::vector<FilmRecord> read_film() const;

  void time_stages(bool on) { timed_ = on; }
  /// Seconds each stage took so far, when timing is on.
  std::vector<std::pair<std::string, double>> seconds_by_stage() const;

  double compile_seconds() const { return compile_seconds_; }
  const std::vector<std::pair<std::string, double>>& compile_seconds_by_stage() const { return by_stage_; }

 private:
  std::size_t local_size_of(const std::string& stage) const;

  Device device_;
#define BUFFER(name, type, access) Buffer<type> name##_;
#include "shared/buffers.def"
#undef BUFFER
  std::vector<Program> programs_;
  std::vector<cl::Kernel> kernels_;
  std::vector<double> seconds_;
  bool timed_ = false;
  std::size_t local_size_ = 1;
  bool swapped_ = false;
  double compile_seconds_ = 0;
  std::vector<std::pair<std::string, double>> by_stage_;
};

}  // namespace caplet
