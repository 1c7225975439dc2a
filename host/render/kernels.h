// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Makes kernels of a device from the stages of stages.def and queries.def.
#pragma once

#include <array>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/compilers.h"
#include "device/device.h"
#include "render/buffers.h"

namespace caplet {

enum class Stage {
#define STAGE(name, launch, is_used, groups) name,
#include "shared/queries.def"
#include "shared/stages.def"
#undef STAGE
  count
};

/// StageNeeds are the properties of a render that decide which stages it needs.
struct StageNeeds {
  bool camera_stage = false;  // camera rays have a traversal of their own
  bool alpha = false;         // shapes let rays through
  bool media = false;
  bool clip = false;              // a clipping plane cuts the scene
  bool counts_on_device = false;  // rounds are launched without asking how many paths are left
};

/// Returns the stages that a render needs, in the order of stages.def.
std::vector<Stage> render_stages(const StageNeeds& needs);
/// Returns the first of these stages that a render needs. There must be one.
Stage first_needed(std::initializer_list<Stage> stages, const StageNeeds& needs);

/// Returns the number of buffers that the stage's kernel takes.
std::size_t buffer_count(Stage stage);

/// StageOptions is what stages are built for.
struct StageOptions {
  std::string compiler;  // its options: how traversal is shaped (Device::encoding)
  RowMasks rows;         // the kinds of shapes, materials, textures and lights that there are
  bool clip = false;     // views may have a clipping plane
  std::size_t part_distance = 0;  // of the scene's arrays (SceneBuffers::part_distance)

  bool operator==(const StageOptions&) const = default;
  /// Returns options for these and `others`: kernels that were built for more kinds than there are
  /// also work.
  StageOptions together_with(const StageOptions& others) const;
};

/// Returns those of the options, words like "-DNAME=1", whose macro the source names: scenes that
/// differ in nothing that a stage knows share its program.
std::string options_of(std::string_view source, std::string_view options);

/// Returns the options for a scene, or those for all rows of the lists (for_all_rows): pictures are
/// the same. Throws InputError as for_all_rows does.
StageOptions stage_options(const FlatScene& scene, const Device& device);
/// Does the same for arrays that were divided so (SceneBuffers::part_distance).
StageOptions stage_options(const FlatScene& scene, const Device& device, std::size_t part_distance);

/// Returns the OpenCL C of a stage, without `#include`s.
std::string stage_source(Stage stage, const RowMasks& rows = {});

class Kernels {
 public:
  /// Takes `options` as stage_options returns them.
  Kernels(const Device& device, StageOptions options);

  /// Returns what has to be compiled for these stages.
  std::vector<CompileJob> jobs(std::span<const Stage> stages) const;
  /// Compiles the stages that are not compiled yet, in several processes at a time (compilers.h).
  /// Throws RunError.
  void compile(std::span<const Stage> stages);
  /// Enqueues a stage, which is compiled, over items `first` to `first` + `count`; if `counter` is
  /// the number of a counter (limits.h), only over as many of these as it says. With timing on,
  /// waits for it and adds its seconds.
  void run(Stage stage, const Bindings& bindings, std::size_t count, std::size_t first = 0,
           cl_uint counter = ~cl_uint{0});
  /// Limits the work-items of one launch, for stages that take one item each; 0: any number.
  void set_chunk(std::size_t chunk) { chunk_ = chunk; }

  void time_stages(bool on) { timed_ = on; }
  /// Returns the seconds that each stage took so far, when timing is on.
  std::vector<std::pair<std::string, double>> seconds_by_stage() const;
  /// Returns the seconds that this process waited for compiled stages.
  double compile_seconds() const { return compile_seconds_; }
  /// Returns the seconds that some process took to compile each stage.
  const std::vector<std::pair<std::string, double>>& compile_seconds_by_stage() const {
    return compile_seconds_by_stage_;
  }

 private:
  bool takes_shares(Stage stage) const;  // its work-items do several items each
  CompileJob job_of(Stage stage) const;

  struct Compiled : CompiledKernel {
    double seconds = 0;  // of its launches
  };
  Device device_;
  StageOptions options_;
  std::array<std::optional<Compiled>, static_cast<std::size_t>(Stage::count)> compiled_;
  bool timed_ = false;
  std::size_t local_size_ = 1, chunk_ = 0;
  double compile_seconds_ = 0;
  std::vector<std::pair<std::string, double>> compile_seconds_by_stage_;
};

}  // namespace caplet
